#include "skinning/blocks_to_write.h"

#include <algorithm>
#include <array>
#include <bit>

namespace sunder::skinning {
namespace {

/// Sets bits [first, end).
void set_bits(std::uint32_t first, std::uint32_t end, std::uint64_t* words) {
  while (first < end) {
    const std::uint32_t word = first / 64, last = std::min(end, 64 * (word + 1));
    const std::uint64_t bits = last - first == 64
                                   ? ~std::uint64_t{0}
                                   : ((std::uint64_t{1} << (last - first)) - 1) << (first % 64);
    words[word] |= bits;
    first = last;
  }
}

/// The last block from `b` on whose window begins at `vertex` or before, by exponential search: the
/// next one is usually near.
std::uint32_t last_block_to(const Blocks& blocks, std::uint32_t vertex, std::uint32_t b) {
  const std::uint32_t count = blocks.block_count();
  std::uint32_t step = 1;
  for (; step < count - b && blocks.window(blocks.blocks[b + step]) <= vertex; step *= 2) b += step;
  const auto from = blocks.blocks.begin() + b, end = from + std::min(step, count - b);
  return b +
         static_cast<std::uint32_t>(
             std::partition_point(
                 from, end, [&](const Block& block) { return blocks.window(block) <= vertex; }) -
             from - 1);
}

/// Marks the blocks among [first, end) of one window that hold any vertex of `vertices`, which are
/// ascending.
void mark_in_window(const Blocks& blocks, std::uint32_t first, std::uint32_t end,
                    std::uint32_t window_end, std::span<const IndexRange> vertices,
                    std::vector<std::uint64_t>& marks) {
  const std::uint32_t window = blocks.window(blocks.blocks[first]);
  std::array<std::uint64_t, kWindow / 64> wanted = {};
  for (const IndexRange& range : vertices) {
    if (range.first >= window_end) break;
    set_bits(std::max(range.first, window) - window,
             std::min(range.first + range.count, window_end) - window, wanted.data());
  }
  for (std::uint32_t b = first; b < end; ++b) {
    const Block& block = blocks.blocks[b];
    const bool is_scattered = (block.kind & kScattered) != 0;
    const std::uint32_t* places =
        is_scattered ? blocks.scattered.places.data() + blocks.extras[block.extra].places : nullptr;
    std::uint64_t any = 0;
    for (std::uint32_t lane = 0; lane < block.lane_count; ++lane) {
      const std::uint32_t at = (is_scattered ? places[lane] : block.first_vertex + lane) - window;
      any |= wanted[at / 64] >> (at % 64);
    }
    marks[b / 64] |= (any & 1) << (b % 64);
  }
}

}  // namespace

void mark(const IndexRange& blocks, std::vector<std::uint64_t>& marks) {
  set_bits(blocks.first, blocks.first + blocks.count, marks.data());
}

void mark_blocks_of(const Blocks& blocks, std::span<const IndexRange> vertices,
                    std::vector<std::uint64_t>& marks) {
  // Blocks before `b`, which hold the vertices before `done`, have been processed.
  std::uint32_t b = 0, done = 0;
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    const std::uint32_t end = vertices[i].first + vertices[i].count;
    if (vertices[i].count == 0 || end <= done) continue;
    if (vertices[i].first > done) {
      b = last_block_to(blocks, vertices[i].first, b);
      while (b > 0 && blocks.window(blocks.blocks[b - 1]) == blocks.window(blocks.blocks[b])) --b;
    }
    do {
      if (b >= blocks.scattered.end) {
        const std::uint32_t last = last_block_to(blocks, end - 1, b);
        mark({b, last + 1 - b}, marks);
        done = blocks.last_vertex(blocks.blocks[last]) + 1;
        b = last + 1;
      } else {
        const std::uint32_t first = b, window = blocks.window(blocks.blocks[b]);
        for (++b; b < blocks.scattered.end && blocks.window(blocks.blocks[b]) == window;) ++b;
        done = b < blocks.block_count() ? blocks.window(blocks.blocks[b]) : blocks.vertex_count;
        mark_in_window(blocks, first, b, done, vertices.subspan(i), marks);
      }
    } while (done < end);
  }
}

void mark_changed(const Blocks& blocks, const PaletteData& palette, std::uint64_t palette_revision,
                  std::uint64_t mesh_revision, std::vector<std::uint64_t>& marks) {
  const auto mark_moved_by = [&](std::size_t mover) {
    blocks.movers.for_each_run(static_cast<std::uint32_t>(mover),
                               [&](const IndexRange& run) { mark(run, marks); });
  };
  for (std::size_t slot = 0; slot < blocks.layout.slot_count; ++slot)
    if (palette.revisions[slot] > palette_revision) mark_moved_by(slot);
  for (std::size_t j = 0; j < blocks.layout.morph_count; ++j)
    if (palette.revisions[palette.slots + blocks.layout.first_morph_weight + j] > palette_revision)
      mark_moved_by(blocks.layout.slot_count + j);

  if (blocks.released.restored > mesh_revision)
    for (std::uint32_t b = 0; b < blocks.block_count(); ++b)
      if (blocks.revisions[b] > mesh_revision) mark({b, 1}, marks);
  // Other blocks are only replaced from some block to the end, so the new ones are there.
  std::uint32_t first_new = blocks.block_count();
  while (first_new > 0 && blocks.revisions[first_new - 1] > mesh_revision) --first_new;
  mark({first_new, blocks.block_count() - first_new}, marks);
}

void mark_displaced(const Blocks& blocks, std::span<const IndexRange> moved,
                    std::vector<std::uint64_t>& displaced, std::vector<std::uint64_t>& marks) {
  const std::size_t known = std::min(displaced.size(), marks.size());
  for (std::size_t word = 0; word < known; ++word) marks[word] |= displaced[word];
  if (blocks.block_count() % 64 != 0)
    marks.back() &= (std::uint64_t{1} << (blocks.block_count() % 64)) - 1;
  displaced.clear();
  if (moved.empty()) return;
  displaced.resize(marks.size());
  mark_blocks_of(blocks, moved, displaced);
  for (std::size_t word = 0; word < marks.size(); ++word) marks[word] |= displaced[word];
}

void list_runs(const Blocks& blocks, const std::vector<std::uint64_t>& marks,
               std::vector<IndexRange>& ranges) {
  ranges.clear();
  ranges.reserve(blocks.block_count() / 2 + 1);
  for (std::size_t word = 0; word < marks.size(); ++word) {
    std::uint64_t bits = marks[word];
    while (bits != 0) {
      const int first = std::countr_zero(bits), length = std::countr_one(bits >> first);
      const std::uint32_t block =
          static_cast<std::uint32_t>(64 * word) + static_cast<std::uint32_t>(first);
      if (!ranges.empty() && ranges.back().first + ranges.back().count == block)
        ranges.back().count += static_cast<std::uint32_t>(length);
      else
        ranges.push_back({block, static_cast<std::uint32_t>(length)});
      bits &= length + first == 64 ? 0 : ~std::uint64_t{0} << (first + length);
    }
  }
}

}  // namespace sunder::skinning
