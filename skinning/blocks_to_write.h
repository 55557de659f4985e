#pragma once

#include <vector>

#include "skinning/blocks.h"
#include "skinning/palette_data.h"

namespace sunder::skinning {

/// Blocks that a mover moves which changed after `palette_revision`, and those that became what they are after `mesh_revision`.
/// @param marks   scratch, a bit a block.
/// @param ranges  written: ascending, apart. Both are grown to the mesh, and not again.
void find_blocks_to_write(const Blocks& blocks, const PaletteData& palette, std::uint64_t palette_revision,
                          std::uint64_t mesh_revision, std::vector<std::uint64_t>& marks, std::vector<Range>& ranges);

}  // namespace sunder::skinning
