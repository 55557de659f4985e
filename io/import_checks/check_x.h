#pragma once

#include <sunder/core/status.h>

#include <string>
#include <string_view>

namespace sunder::assimp_import {

/// Refuses an X text with weights of vertices that its mesh does not have: assimp 5.2 writes
/// outside of its arrays. Also more than 1,024 levels of braces.
/// @return index_out_of_range, limit_exceeded.
[[nodiscard]] Status check_x(std::string_view content, const std::string& file_name);

}  // namespace sunder::assimp_import
