#pragma once

#include <sunder/core/status.h>

#include <string>
#include <string_view>

namespace sunder::assimp_import {

/// Refuses a PLY file whose header has no end, which assimp 5.2 reads for ever, or announces more
/// than the rest of the file can hold.
/// @return malformed_file, limit_exceeded (the header).
[[nodiscard]] Status check_ply(std::string_view content, const std::string& file_name);

}  // namespace sunder::assimp_import
