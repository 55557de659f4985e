#pragma once

#include <sunder/core/status.h>

#include <filesystem>

#include "tools/view_page/view_input.h"

namespace sunder::tools {

/// Writes one HTML file that holds the viewer and all data, and opens offline.
///
/// @return the failures of view_data() and write_page(). Nothing is written then.
/// docs/view_page.md describes the page.
[[nodiscard]] Status write_view_page(const std::filesystem::path& file, const ViewInput& input);

}  // namespace sunder::tools
