#pragma once

#include <sunder/core/index.h>
#include <sunder/tear/change_record.h>

#include <cstdint>
#include <vector>

namespace sunder::scene {

/// Ranges that changed, with the epoch of each change, so that readers who fell behind by different
/// numbers of epochs learn what they missed.
class RangeJournal {
 public:
  RangeJournal() { entries_.reserve(kMost); }

  /// Where there are too many entries, one range takes in all of them. Epochs do not decrease.
  void add(std::uint64_t epoch, const IndexRange& range) noexcept;
  void add(std::uint64_t epoch, const DirtyRanges& ranges) noexcept {
    for (const IndexRange& range : ranges) add(epoch, range);
  }
  /// Writes the ranges that changed after an epoch, ascending and disjoint, up to `count`. @throws
  /// std::bad_alloc
  void collect(std::uint64_t seen, Index count, std::vector<IndexRange>& ranges) const;

 private:
  struct Entry {
    std::uint64_t epoch;
    IndexRange range;
  };
  static constexpr std::size_t kMost = 16;
  std::vector<Entry> entries_;
};

/// Sorts ranges and joins those that touch or overlap.
void join_ranges(std::vector<IndexRange>& ranges) noexcept;

}  // namespace sunder::scene
