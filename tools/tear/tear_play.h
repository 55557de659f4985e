#pragma once

#include <sunder/operation/aimed_operation.h>

#include <optional>
#include <string>
#include <vector>

#include "tools/messages/progress_bar.h"
#include "tools/tear/tear_run.h"

namespace sunder::tools {

/// An operation to apply, and where it is wanted: "/operations/3", or an option.
struct WantedOperation {
  LoggedOperation operation;
  std::string place;
  std::string file;                               ///< The log, for errors; empty for an option.
  std::optional<TearRequest::Aimed> option = {};  ///< Of the command line that it is.
};

/// Applies operations, those that are aimed to the model as it is torn by then, and then the fit of
/// --weights refit. Says for each what it did and warns of what looks wrong; collects reports and
/// totals. With --keep-going, reports an operation that fails as a finding and leaves it out.
/// @return ok, or the exit code of the failure, which was reported.
[[nodiscard]] ExitCode play_operations(const std::vector<WantedOperation>& operations, TearRun& run,
                                       ProgressBar& progress);

}  // namespace sunder::tools
