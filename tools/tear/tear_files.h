#pragma once

#include <string>

#include "tools/tear/tear_run.h"

namespace sunder::tools {

/// Refuses outputs that would overwrite an input or each other.
/// @return ok, or usage, which was reported.
[[nodiscard]] ExitCode check_outputs(const TearRequest& request);

/// Writes the model, its report and its log: all of them, or none.
/// @param report  JSON; only written with --report to a file.
/// @param log     only written with --save-log.
/// @return ok, or the exit code of the failure, which was reported.
[[nodiscard]] ExitCode write_files(const TearRun& run, const std::string& report,
                                   const std::string& log);

/// Refuses files of --pieces that are inputs or other outputs, before anything is written.
/// @return ok, or the exit code of the failure, which was reported.
[[nodiscard]] ExitCode check_piece_files(const TearRun& run);

/// Writes the detached pieces, with --pieces. If one cannot be written, those before it stay.
/// @return ok, or the exit code of the failure, which was reported.
[[nodiscard]] ExitCode write_pieces(TearRun& run);

/// Whether the report goes to stdout.
[[nodiscard]] bool reports_to_stdout(const TearRequest& request);

}  // namespace sunder::tools
