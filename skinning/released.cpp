#include "skinning/released.h"

#include <algorithm>

#include "skinning/blocks_to_write.h"

namespace sunder::skinning {
namespace {

constexpr std::uint64_t bit(std::uint32_t index) { return std::uint64_t{1} << (index % 64); }

bool is_set(const std::vector<std::uint64_t>& bits, std::uint32_t index) {
  return (bits[index / 64] & bit(index)) != 0;
}

void assign(std::vector<std::uint64_t>& bits, std::uint32_t index, bool value) {
  bits[index / 64] = value ? bits[index / 64] | bit(index) : bits[index / 64] & ~bit(index);
}

bool holds_released_only(const Blocks& blocks, const Block& block) {
  const std::uint32_t* const places =
      (block.kind & kScattered) != 0
          ? blocks.scattered.places.data() + blocks.extras[block.extra].places
          : nullptr;
  for (std::uint32_t lane = 0; lane < block.lane_count; ++lane)
    if (!is_set(blocks.released.vertices,
                places != nullptr ? places[lane] : block.first_vertex + lane))
      return false;
  return true;
}

std::vector<IndexRange> ranges_of(std::span<const std::uint32_t> vertices) {
  std::vector<std::uint32_t> sorted(vertices.begin(), vertices.end());
  std::sort(sorted.begin(), sorted.end());
  std::vector<IndexRange> ranges;
  for (const std::uint32_t vertex : sorted) {
    if (ranges.empty() || ranges.back().first + ranges.back().count < vertex)
      ranges.push_back({vertex, 1});
    else
      ranges.back().count = vertex + 1 - ranges.back().first;
  }
  return ranges;
}

}  // namespace

void set_released(std::span<const std::uint32_t> vertices, bool is_released, Blocks& blocks) {
  if (vertices.empty()) return;
  std::vector<std::uint64_t> marks((blocks.block_count() + 63) / 64, 0);
  mark_blocks_of(blocks, ranges_of(vertices), marks);
  make_room_for_released(blocks.vertex_count, blocks);
  blocks.released.vertices.resize((blocks.vertex_count + 63) / 64, 0);
  blocks.released.blocks.resize(marks.size(), 0);

  for (const std::uint32_t vertex : vertices) assign(blocks.released.vertices, vertex, is_released);
  if (!is_released) blocks.released.restored = ++blocks.revision;
  for (std::uint32_t b = 0; b < blocks.block_count(); ++b) {
    if (marks[b / 64] == 0) {
      b |= 63;  // none of these
      continue;
    }
    if (!is_set(marks, b)) continue;
    const bool was_idle = is_set(blocks.released.blocks, b);
    assign(blocks.released.blocks, b, holds_released_only(blocks, blocks.blocks[b]));
    if (was_idle && !is_set(blocks.released.blocks, b)) blocks.revisions[b] = blocks.revision;
  }
}

void make_room_for_released(std::uint32_t vertex_count, Blocks& blocks) {
  blocks.released.vertices.reserve((vertex_count + 63) / 64);
  // A block per vertex at most.
  blocks.released.blocks.reserve((blocks.block_count() + vertex_count / kLanes + 2 + 63) / 64);
}

void update_released(std::uint32_t first, std::uint32_t first_vertex, Blocks& blocks) noexcept {
  Blocks::Released& released = blocks.released;
  if (released.vertices.empty()) return;
  const std::uint32_t known = static_cast<std::uint32_t>(64 * released.vertices.size());
  for (std::uint32_t v = std::min(first_vertex, known); v < known; ++v)
    if (v >= blocks.vertex_count) assign(released.vertices, v, false);
  released.vertices.resize((blocks.vertex_count + 63) / 64, 0);
  released.blocks.resize((blocks.block_count() + 63) / 64, 0);
  for (std::uint32_t b = first; b < 64 * released.blocks.size(); ++b)
    assign(released.blocks, b,
           b < blocks.block_count() && holds_released_only(blocks, blocks.blocks[b]));
}

void unmark_released(const Blocks& blocks, std::vector<std::uint64_t>& marks) {
  const std::size_t known = std::min(marks.size(), blocks.released.blocks.size());
  for (std::size_t word = 0; word < known; ++word) marks[word] &= ~blocks.released.blocks[word];
}

}  // namespace sunder::skinning
