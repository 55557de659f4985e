#pragma once

#include <memory>
#include <vector>

#include "tools/messages/exit_code.h"
#include "tools/tear/tear_run.h"

namespace sunder::tools {

/// With --tissue-field, samples the fields of the tissue.
/// @return ok, or the exit code of the failure, which was reported.
[[nodiscard]] ExitCode author_tissue_of_run(TearRun& run);

/// With --open, measures how the lips gape. Warns, as a finding, if nothing does.
/// @return ok, or the exit code of the failure, which was reported.
[[nodiscard]] ExitCode open_lips_of_run(TearRun& run);

/// The character that is written: with certified weights, open lips and walls between them, as far
/// as they are asked for.
struct WrittenModel {
  std::shared_ptr<const Character> character;  ///< Valid as long as the run.
  std::vector<AppendedMaterial> materials;     ///< SaveOptions::materials.
};
[[nodiscard]] Result<WrittenModel> written_model(const TearRun& run);

/// The object `open` of the report; only with --open.
[[nodiscard]] Json open_lips_json(const TearRun& run);

}  // namespace sunder::tools
