#pragma once

#include <sunder/core/status.h>
#include <sunder/validation/transfer.h>

#include <filesystem>
#include <vector>

namespace sunder::tools {

/// Reads the pairs of bones whose names differ: {"bone of the target": "bone of the source"}.
/// @return the failures of read_json_object(); malformed_file for a value that is not a name.
[[nodiscard]] Result<std::vector<BoneNames>> read_bone_names(const std::filesystem::path& file);

}  // namespace sunder::tools
