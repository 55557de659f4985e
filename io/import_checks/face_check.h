#pragma once

#include <cstdint>
#include <vector>

#include <assimp/scene.h>

#include "io/import_checks/text_indices.h"

namespace sunder::assimp_import {

/// Removes faces of every mesh that name a vertex that does not exist, before anything reads it.
/// @param scene  as the importer made it, before any post-processing.
/// @param in_text  faces that the importer has changed already.
/// @return the number of removed faces, one per mesh.
[[nodiscard]] std::vector<std::uint32_t> remove_faces_out_of_range(aiScene& scene,
                                                                   const TextIndices& in_text);

}  // namespace sunder::assimp_import
