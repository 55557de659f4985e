#pragma once

#include <sunder/core/index.h>

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

namespace sunder::skinning {

/// The blocks that each mover (a slot or a morph target) moves, as runs of blocks. The newest run
/// comes first, so that blocks can be appended, and removed from the end.
class MoverRuns {
 public:
  void resize(std::size_t movers) { newest_.assign(movers, kNoRun); }

  /// Records that `mover` moves `block`. The last block is not exceeded by earlier ones.
  void append(std::uint32_t mover, std::uint32_t block);
  /// Removes all blocks from `first_block` on.
  void truncate(std::uint32_t first_block);

  template <class Visit>
  void for_each_run(std::uint32_t mover, Visit visit) const {
    for (std::uint32_t i = newest_[mover]; i != kNoRun; i = runs_[i].older) visit(runs_[i].blocks);
  }

  /// Makes room for that many more runs.
  void make_room(std::size_t more_runs) {
    if (runs_.capacity() - runs_.size() < more_runs)
      runs_.reserve(runs_.size() + std::max(more_runs, runs_.size() / 8));
  }

 private:
  static constexpr std::uint32_t kNoRun = 0xFFFF'FFFFu;
  struct Run {
    IndexRange blocks;
    std::uint32_t mover = 0, older = kNoRun;
  };
  std::vector<Run> runs_;
  std::vector<std::uint32_t> newest_;  // per mover
};

}  // namespace sunder::skinning
