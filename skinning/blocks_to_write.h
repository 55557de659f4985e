#pragma once

#include <span>
#include <vector>

#include "skinning/blocks.h"
#include "skinning/palette_data.h"

namespace sunder::skinning {

// Sets of blocks: a bit a block, in so many words as all blocks take.

/// Marks blocks.
void mark(const IndexRange& blocks, std::vector<std::uint64_t>& marks);

/// Marks blocks that a mover moves which changed after `palette_revision`, and those that became
/// what they are after `mesh_revision`.
void mark_changed(const Blocks& blocks, const PaletteData& palette, std::uint64_t palette_revision,
                  std::uint64_t mesh_revision, std::vector<std::uint64_t>& marks);

/// Marks blocks that were displaced and those that are now. O(blocks / 64 + blocks displaced);
/// where vertices are gathered, a window of which any is displaced is looked through.
/// @param moved      vertices: ascending, none twice.
/// @param displaced  those of the last call, or empty; written: the blocks that hold vertices of
/// `moved`, empty without any. What it
///                   says of blocks that the mesh got since then does not count: these are to be
///                   written in any case.
void mark_displaced(const Blocks& blocks, std::span<const IndexRange> moved,
                    std::vector<std::uint64_t>& displaced, std::vector<std::uint64_t>& marks);

/// Runs of marked blocks. @param ranges  written: ascending, apart. Grown to the mesh, and not
/// again.
void list_runs(const Blocks& blocks, const std::vector<std::uint64_t>& marks,
               std::vector<IndexRange>& ranges);

}  // namespace sunder::skinning
