#pragma once

#include <span>

#include "skinning/blocks.h"

namespace sunder::skinning {

/// Releases vertices, or takes them back. Blocks that are posed again get a new revision.
/// @throws std::bad_alloc before anything changes. O(vertices + blocks / 64).
void set_released(std::span<const std::uint32_t> vertices, bool is_released, Blocks& blocks);

/// Makes room for update_released(). @throws std::bad_alloc
void make_room_for_released(std::uint32_t vertex_count, Blocks& blocks);
/// Follows a mesh whose blocks from `first` on are new, and whose vertices from `first_vertex` on
/// may be others. Does not allocate after make_room_for_released().
void update_released(std::uint32_t first, std::uint32_t first_vertex, Blocks& blocks) noexcept;

/// Unmarks the blocks that hold released vertices only.
void unmark_released(const Blocks& blocks, std::vector<std::uint64_t>& marks);

}  // namespace sunder::skinning
