#pragma once

#include <span>
#include <vector>

#include "skinning/blocks.h"
#include "skinning/palette_data.h"

namespace sunder::skinning {

// A set of blocks is a bit array with one bit per block.

/// Marks a range of blocks.
void mark(const IndexRange& blocks, std::vector<std::uint64_t>& marks);

/// Marks the blocks that hold vertices of some ranges: ascending, disjoint, below the vertex count.
void mark_blocks_of(const Blocks& blocks, std::span<const IndexRange> vertices,
                    std::vector<std::uint64_t>& marks);

/// Marks the blocks moved by a bone or morph target that changed after `palette_revision`, and the
/// blocks made after `mesh_revision`.
void mark_changed(const Blocks& blocks, const PaletteData& palette, std::uint64_t palette_revision,
                  std::uint64_t mesh_revision, std::vector<std::uint64_t>& marks);

/// Marks the blocks that were displaced in the last call and those that are displaced now. O(blocks
/// / 64 + displaced blocks); a window of gathered vertices is searched if any of them is displaced.
/// @param moved      vertices: ascending, no duplicates.
/// @param displaced  in: the displaced blocks of the last call, or empty. Out: the blocks that hold
///         vertices of `moved`; empty if there are none. Entries of blocks made since then are
///         ignored: these are written anyway.
void mark_displaced(const Blocks& blocks, std::span<const IndexRange> moved,
                    std::vector<std::uint64_t>& displaced, std::vector<std::uint64_t>& marks);

/// Lists the runs of marked blocks. @param ranges  written: ascending, disjoint. Allocates only
/// when the mesh has grown.
void list_runs(const Blocks& blocks, const std::vector<std::uint64_t>& marks,
               std::vector<IndexRange>& ranges);

}  // namespace sunder::skinning
