#pragma once

#include <sunder/core/status.h>

#include <cstddef>
#include <vector>

#include "tools/view_page/view_input.h"

namespace sunder::tools {

/// The data of the page, as page_bytes() joins it; docs/view_page.md describes it.
///
/// @return invalid_argument if no bone of the torn model has the name of a bone of the model;
/// limit_exceeded beyond 65,535 slots or 255 influences per vertex; the failures of rest_pose().
[[nodiscard]] Result<std::vector<std::byte>> view_data(const ViewInput& input);

}  // namespace sunder::tools
