#pragma once

#include <sunder/core/character.h>

#include <vector>

namespace sunder {

/// For each mesh where its elements came from: old_from_new[new] = old. Ascending: order is kept.
struct CompactMaps {
  struct OfMesh {
    std::vector<std::uint32_t> vertex_old_from_new;
    std::vector<std::uint32_t> triangle_old_from_new;
  };
  std::vector<OfMesh> meshes;
};

/// Removes retired triangles and the vertices that no triangle uses. Numbers change; everything else is bit-identical.
/// @return where each element came from. O(size of the character).
SUNDER_API CompactMaps compact(Character& character);

}  // namespace sunder
