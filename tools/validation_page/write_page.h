#pragma once

#include <sunder/core/status.h>

#include <filesystem>

#include "tools/validation_page/page_input.h"

namespace sunder::tools {

/// Whether this build can write pages.
/// @return unsupported_feature, and how to get a build that can.
[[nodiscard]] Status has_page();

/// Writes one HTML file that holds the viewer and all data, and opens offline.
///
/// @return the failures of has_page() and page_data(); file_unreadable if the file cannot be
/// written. Nothing is written then. docs/validation_page.md describes the page.
[[nodiscard]] Status write_validation_page(const std::filesystem::path& file,
                                           const PageInput& input);

}  // namespace sunder::tools
