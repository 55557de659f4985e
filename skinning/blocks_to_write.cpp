#include "skinning/blocks_to_write.h"

#include <algorithm>
#include <bit>

namespace sunder::skinning {
namespace {

void mark(const Range& blocks, std::vector<std::uint64_t>& marks) {
  std::uint32_t first = blocks.first;
  const std::uint32_t end = blocks.first + blocks.count;
  while (first < end) {
    const std::uint32_t word = first / 64, last = std::min(end, 64 * (word + 1));
    const std::uint64_t bits = last - first == 64 ? ~std::uint64_t{0} : ((std::uint64_t{1} << (last - first)) - 1) << (first % 64);
    marks[word] |= bits;
    first = last;
  }
}

/// Runs of set bits.
void list_runs(const std::vector<std::uint64_t>& marks, std::vector<Range>& ranges) {
  for (std::size_t word = 0; word < marks.size(); ++word) {
    std::uint64_t bits = marks[word];
    while (bits != 0) {
      const int first = std::countr_zero(bits), length = std::countr_one(bits >> first);
      const std::uint32_t block = static_cast<std::uint32_t>(64 * word) + static_cast<std::uint32_t>(first);
      if (!ranges.empty() && ranges.back().first + ranges.back().count == block)
        ranges.back().count += static_cast<std::uint32_t>(length);
      else
        ranges.push_back({block, static_cast<std::uint32_t>(length)});
      bits &= length + first == 64 ? 0 : ~std::uint64_t{0} << (first + length);
    }
  }
}

}  // namespace

void find_blocks_to_write(const Blocks& blocks, const PaletteData& palette, std::uint64_t palette_revision,
                          std::uint64_t mesh_revision, std::vector<std::uint64_t>& marks, std::vector<Range>& ranges) {
  marks.assign((blocks.block_count() + 63) / 64, 0);
  ranges.clear();
  ranges.reserve(blocks.block_count() / 2 + 1);
  const auto mark_moved_by = [&](std::size_t mover) {
    blocks.movers.for_each_run(static_cast<std::uint32_t>(mover), [&](const Range& run) { mark(run, marks); });
  };
  for (std::size_t slot = 0; slot < blocks.slot_count; ++slot)
    if (palette.revisions[slot] > palette_revision) mark_moved_by(slot);
  for (std::size_t j = 0; j < blocks.morph_count; ++j)
    if (palette.revisions[palette.slots + blocks.first_morph_weight + j] > palette_revision) mark_moved_by(blocks.slot_count + j);

  // Blocks are only ever replaced from some place to the end: those that are new lie there.
  std::uint32_t first_new = blocks.block_count();
  while (first_new > 0 && blocks.revisions[first_new - 1] > mesh_revision) --first_new;
  mark({first_new, blocks.block_count() - first_new}, marks);
  list_runs(marks, ranges);
}

}  // namespace sunder::skinning
