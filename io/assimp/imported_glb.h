#pragma once

#include <sunder/io/character_file.h>

#include <cstddef>
#include <vector>

namespace sunder::assimp_import {

struct ImportedGlb {
  std::vector<std::byte> glb;  ///< Valid glTF 2.0 binary: the whole scene with meshes, skins,
                               ///< clips, morph targets, materials.
  LoadReport report;
};

}  // namespace sunder::assimp_import
