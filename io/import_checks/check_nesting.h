#pragma once

#include <sunder/core/status.h>

#include <string>
#include <string_view>

namespace sunder::assimp_import {

// assimp's parsers call themselves for each level. Each function returns limit_exceeded if there
// are more than 1,024.

/// Braces of an FBX text, without those in strings and comments.
[[nodiscard]] Status check_fbx_depth(std::string_view content, const std::string& file_name);
/// Braces of an X text.
[[nodiscard]] Status check_x_depth(std::string_view content, const std::string& file_name);
/// Elements of an XML text.
[[nodiscard]] Status check_xml_depth(std::string_view content, const std::string& file_name);

}  // namespace sunder::assimp_import
