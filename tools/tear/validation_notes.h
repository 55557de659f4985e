#pragma once

#include <string>
#include <vector>

#include "tools/tear/tear_run.h"

namespace sunder::tools {

/// Why `sunder validate` may warn of the file that a run writes, one line per option that was asked
/// for: a file without any of them passes without warnings.
[[nodiscard]] std::vector<std::string> validation_notes(const TearRun& run);

}  // namespace sunder::tools
