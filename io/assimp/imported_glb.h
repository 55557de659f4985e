#pragma once

#include <sunder/io/character_file.h>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace sunder::assimp_import {

struct ImportedGlb {
  std::vector<std::byte> glb;  ///< Valid glTF 2.0 binary: the whole scene with meshes, skins,
                               ///< clips, morph targets, materials.
  LoadReport report;
  /// For reading the GLB, as LoadOptions::maximum_memory; 0: by the GLB's size. That of a helper
  /// process, which a model may have taken over, must not set its own limit.
  std::uint64_t maximum_memory = 0;
};

}  // namespace sunder::assimp_import
