#pragma once

#include <sunder/core/status.h>

#include <filesystem>

#include "tools/validation_page/page_input.h"

namespace sunder::tools {

/// Writes one HTML file that holds the viewer and all data, and opens offline.
///
/// @return the failures of page_data() and write_page(). Nothing is written then.
/// docs/validation_page.md describes the page.
[[nodiscard]] Status write_validation_page(const std::filesystem::path& file,
                                           const PageInput& input);

}  // namespace sunder::tools
