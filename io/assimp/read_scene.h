#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <assimp/Importer.hpp>
#include <assimp/scene.h>

#include "io/assimp/asset_io_system.h"
#include "io/import_checks/formats.h"
#include "io/import_checks/text_indices.h"

namespace sunder::assimp_import {

struct ReadScene {
  const aiScene* scene = nullptr;  ///< The importer's.
  /// One flag per mesh: every corner has its own vertex. Then the importer lost the sharing of
  /// vertices in the file, so welding may restore it. In other meshes vertices coincide because the
  /// file says so, like the two lips of a tear, and stay separate.
  std::vector<bool> is_de_indexed;
  /// One number per mesh: faces that named vertices that do not exist, and were removed.
  std::vector<std::uint32_t> faces_out_of_range;
  TextIndices in_text;
  std::vector<std::string> messages;  ///< As ImporterLog::messages().
};

/// Reads `model` with the importer of its format; the content does not choose it, and the only
/// post-processing step is triangulation. Throws ImportFailure: malformed_file, also with assimp's
/// text, path_not_allowed, limit_exceeded.
[[nodiscard]] ReadScene read_scene(Assimp::Importer& importer, const ModelFile& model,
                                   const Format& format, AssetFiles& assets);

}  // namespace sunder::assimp_import
