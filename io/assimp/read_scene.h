#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <assimp/Importer.hpp>
#include <assimp/scene.h>

#include "io/assimp/asset_folder.h"

namespace sunder::assimp_import {

/// The file's extension, lower case, without the dot.
[[nodiscard]] std::string lower_extension(const std::filesystem::path& file);

struct ReadScene {
  const aiScene* scene = nullptr;  ///< The importer's.
  /// One a mesh: every corner has its own vertex. The loader took the file's sharing apart, so
  /// welding may restore it; in other meshes vertices that coincide do so because the file says so,
  /// as the two lips of a tear do, and stay apart.
  std::vector<bool> is_de_indexed;
};

/// Reads `file` with the one loader that its extension names; nothing is sniffed, and no step but
/// triangulation runs. Throws ImportFailure: unsupported_format, malformed_file with assimp's text,
/// path_not_allowed, limit_exceeded.
[[nodiscard]] ReadScene read_scene(Assimp::Importer& importer, const std::filesystem::path& file,
                                   AssetFolder& folder);

}  // namespace sunder::assimp_import
