#include "skinning/released.h"

namespace sunder::skinning {
namespace {

constexpr std::uint64_t bit(std::uint32_t index) { return std::uint64_t{1} << (index % 64); }

std::size_t words_of(std::uint32_t count) { return (std::size_t{count} + 63) / 64; }

bool is_set(const std::vector<std::uint64_t>& bits, std::uint32_t index) {
  return (bits[index / 64] & bit(index)) != 0;
}

bool holds_released_only(const Blocks& blocks, const Block& block,
                         const std::vector<std::uint64_t>& vertices) {
  const std::uint32_t* const places =
      (block.kind & kScattered) != 0
          ? blocks.scattered.places.data() + blocks.extras[block.extra].places
          : nullptr;
  for (std::uint32_t lane = 0; lane < block.lane_count; ++lane)
    if (!is_set(vertices, places != nullptr ? places[lane] : block.first_vertex + lane))
      return false;
  return true;
}

/// Lists the blocks that hold released vertices only. Vertices that the mesh does not have any more
/// are forgotten.
void list_blocks(const Blocks& blocks, ReleasedVertices& released) {
  released.vertices.resize(words_of(blocks.vertex_count), 0);
  released.blocks.assign(words_of(blocks.block_count()), 0);
  if (const std::uint32_t rest = blocks.vertex_count % 64; rest != 0)
    released.vertices.back() &= (std::uint64_t{1} << rest) - 1;
  for (std::uint32_t b = 0; b < blocks.block_count(); ++b)
    if (holds_released_only(blocks, blocks.blocks[b], released.vertices))
      released.blocks[b / 64] |= bit(b);
  released.mesh_revision = blocks.revision;
}

}  // namespace

void set_released(std::span<const std::uint32_t> vertices, bool is_released, const Blocks& blocks,
                  ReleasedVertices& released) {
  ReleasedVertices made = released;
  made.vertices.resize(words_of(blocks.vertex_count), 0);
  for (const std::uint32_t vertex : vertices)
    made.vertices[vertex / 64] = is_released ? made.vertices[vertex / 64] | bit(vertex)
                                             : made.vertices[vertex / 64] & ~bit(vertex);
  const std::vector<std::uint64_t> before = made.blocks;
  list_blocks(blocks, made);
  made.returned.resize(made.blocks.size(), 0);
  for (std::size_t word = 0; word < std::min(before.size(), made.blocks.size()); ++word)
    made.returned[word] |= before[word] & ~made.blocks[word];
  released = std::move(made);
}

void mark_released(const Blocks& blocks, bool is_known, ReleasedVertices& released,
                   std::vector<std::uint64_t>& marks) {
  if (released.vertices.empty()) return;
  if (!is_known || released.mesh_revision != blocks.revision) list_blocks(blocks, released);
  for (std::size_t word = 0; word < marks.size(); ++word) {
    if (word < released.returned.size()) marks[word] |= released.returned[word];
    marks[word] &= ~released.blocks[word];
  }
}

}  // namespace sunder::skinning
