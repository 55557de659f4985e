#pragma once

#include <vector>

#include "tools/progress_bar.h"
#include "tools/tear_run.h"

namespace sunder::tools {

/// Applies operations, then the fit of --weights refit. Says for each what it did and warns of what
/// looks wrong; collects reports and totals.
/// @return ok, or the exit code of the failure, which was reported.
[[nodiscard]] ExitCode play_operations(const std::vector<Operation>& operations, TearRun& run,
                                       ProgressBar& progress);

}  // namespace sunder::tools
