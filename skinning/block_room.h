#pragma once

#include <sunder/skinning/vertex_arrays.h>

#include "skinning/blocks.h"

namespace sunder::skinning {

/// Makes room for any blocks that vertices [first, end) may make in their own order, so that
/// BlockBuilder appends them without memory. O(end - first).
/// @throws std::bad_alloc; the blocks are unchanged then
void make_room(const VertexSource& source, std::uint32_t first, std::uint32_t end, Blocks& blocks);

}  // namespace sunder::skinning
