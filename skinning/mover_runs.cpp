#include "skinning/mover_runs.h"

#include <algorithm>

namespace sunder::skinning {

void MoverRuns::append(std::uint32_t mover, std::uint32_t block) {
  const std::uint32_t newest = newest_[mover];
  if (newest != kNoRun) {
    IndexRange& blocks = runs_[newest].blocks;
    if (blocks.first + blocks.count > block) return;
    if (blocks.first + blocks.count == block) {
      ++blocks.count;
      return;
    }
  }
  newest_[mover] = static_cast<std::uint32_t>(runs_.size());
  runs_.push_back({{block, 1}, mover, newest});
}

void MoverRuns::truncate(std::uint32_t first_block) {
  // Runs are ordered by their first block; older ones may extend beyond the cut.
  while (!runs_.empty() && runs_.back().blocks.first >= first_block) {
    newest_[runs_.back().mover] = runs_.back().older;
    runs_.pop_back();
  }
  for (const std::uint32_t newest : newest_) {
    if (newest == kNoRun) continue;
    IndexRange& blocks = runs_[newest].blocks;
    blocks.count = std::min(blocks.count, first_block - blocks.first);
  }
}

}  // namespace sunder::skinning
