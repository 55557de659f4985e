#pragma once

#include <sunder/core/status.h>

#include <cstddef>
#include <vector>

#include "tools/validation_page/page_input.h"

namespace sunder::tools {

/// The data of the page, as page_bytes() joins it; docs/validation_page.md describes it.
///
/// @return size_mismatch, index_out_of_range or non_finite_value if an array does not fit its
/// model; limit_exceeded beyond 65,535 slots or 255 influences per vertex.
[[nodiscard]] Result<std::vector<std::byte>> page_data(const PageInput& input);

}  // namespace sunder::tools
