#pragma once

#include "skinning/blocks.h"
#include "skinning/palette_data.h"

namespace sunder::skinning {

/// One call's work on some blocks: everything that a kernel reads.
struct SkinWork {
  const Blocks* mesh = nullptr;
  const PaletteData* palette = nullptr;
  const float* morph_weights = nullptr;  ///< The mesh's own.
  VertexTarget target;                   ///< Strides filled in; no data for what is not wanted.
  std::uint32_t attribute_floats = 0;    ///< Of the mesh.
  bool is_common = false;                ///< Matrices are blended, and no tangents are wanted.
  bool is_beyond_cache = false;  ///< So much memory that results are written around the caches.
};

/// Poses blocks [first, end). By the best vectors that the CPU has, or one number after another
/// where the build has no Highway.
void skin_blocks(const SkinWork& work, std::uint32_t first, std::uint32_t end);

}  // namespace sunder::skinning
