#pragma once

#include "tools/tear/tear_run.h"

namespace sunder::tools {

/// The JSON report of a run; docs/command/tear_report.md. Takes the reports of its operations.
[[nodiscard]] Result<Json> report_json(TearRun& run);

}  // namespace sunder::tools
