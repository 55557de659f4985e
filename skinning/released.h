#pragma once

#include <sunder/skinning/skinned_mesh.h>

#include <span>

#include "skinning/blocks.h"

namespace sunder::skinning {

/// Releases vertices of a mesh, or takes them back. @throws std::bad_alloc before anything changes.
/// O(vertices of the mesh).
void set_released(std::span<const std::uint32_t> vertices, bool is_released, const Blocks& blocks,
                  ReleasedVertices& released);

/// Unmarks the blocks that hold released vertices only, and marks those that were taken back.
/// @param is_known  whether the buffer was last written by this mesh.
/// @throws std::bad_alloc. O(vertices of the mesh) after the mesh changed.
void mark_released(const Blocks& blocks, bool is_known, ReleasedVertices& released,
                   std::vector<std::uint64_t>& marks);

}  // namespace sunder::skinning
