#pragma once

#include <string>

#include "tools/messages/lines.h"
#include "tools/tear/tear_run.h"

namespace sunder::tools {

/// Describes for people what `sunder tear` did: operations, faces, pieces, weights, files. Lines
/// with ends.
[[nodiscard]] Lines tear_summary(const TearRun& run);

/// "loading 0.1 s, operations 0.3 s, saving 0.1 s, other 0.02 s (96 % …)".
[[nodiscard]] std::string times_line(const RunTimes& times, double seconds_in_all);

}  // namespace sunder::tools
