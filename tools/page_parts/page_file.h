#pragma once

#include <sunder/core/status.h>

#include <cstddef>
#include <filesystem>
#include <span>
#include <vector>

#include "tools/page_parts/data_arrays.h"
#include "tools/page_parts/page_template.h"

namespace sunder::tools {

/// Whether this build can write pages.
/// @return unsupported_feature, and how to get a build that can.
[[nodiscard]] Status has_pages();

/// The data of a page: "SNDP", version, the JSON object, and the arrays that it refers to, all
/// little-endian. decode.js reads it; docs/validation_page.md describes it.
[[nodiscard]] std::vector<std::byte> page_bytes(const Json& json, const DataArrays& arrays);

/// Writes one HTML file that holds a page and its data, and opens offline.
/// @return the failures of has_pages(); file_unreadable if the file cannot be written. Nothing is
/// written then.
[[nodiscard]] Status write_page(const std::filesystem::path& file, PageTemplate page,
                                std::span<const std::byte> data);

}  // namespace sunder::tools
