#pragma once

#include <sunder/core/status.h>

#include <span>
#include <string>
#include <string_view>

namespace sunder::assimp_import {

/// A format that is documented, tested, and read by assimp.
struct Format {
  std::string_view extension;  ///< Lower case, without the dot.
  std::string_view name;       ///< As in load reports.
  std::string_view begins;     ///< First bytes of each file; empty if the format prescribes none.
  std::string_view contains;   ///< Or a text within the first kilobyte.
};

[[nodiscard]] std::span<const Format> formats();

/// The format of a file by its extension alone.
/// @return unsupported_format, with the list of formats.
[[nodiscard]] Result<Format> format_of(std::string_view file_name);

/// Refuses (malformed_file) a file whose first kilobyte is not that of its format.
[[nodiscard]] Status check_start(const Format& format, std::string_view first_kilobyte,
                                 const std::string& file_name);

}  // namespace sunder::assimp_import
