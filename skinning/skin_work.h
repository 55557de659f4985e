#pragma once

#include "skinning/blocks.h"
#include "skinning/palette_data.h"

namespace sunder::skinning {

/// The inputs of a kernel for one call.
struct SkinWork {
  const Blocks* mesh = nullptr;
  const PaletteData* palette = nullptr;
  const float* morph_weights = nullptr;  ///< Those of the mesh.
  VertexTarget target;  ///< Its strides are not 0; no data for attributes that are not wanted.
  std::uint32_t attribute_floats = 0;  ///< Of the mesh.
  bool is_common = false;              ///< Linear blending, and no tangents are wanted.
  /// The outputs are so large that they are written around the caches.
  bool is_beyond_cache = false;
};

/// Poses blocks [first, end) with the best vectors of the CPU, or with scalar code in builds
/// without Highway.
void skin_blocks(const SkinWork& work, std::uint32_t first, std::uint32_t end);

}  // namespace sunder::skinning
