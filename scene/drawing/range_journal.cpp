#include "scene/drawing/range_journal.h"

#include <algorithm>

namespace sunder::scene {

void RangeJournal::add(std::uint64_t epoch, const IndexRange& range) noexcept {
  if (range.count == 0) return;
  if (entries_.size() < kMost) {
    entries_.push_back({epoch, range});
    return;
  }
  Index first = range.first, end = range.first + range.count;
  for (const Entry& entry : entries_) {
    first = std::min(first, entry.range.first);
    end = std::max(end, entry.range.first + entry.range.count);
  }
  entries_.resize(1);
  entries_[0] = {epoch, {first, end - first}};
}

void RangeJournal::collect(std::uint64_t seen, Index count, std::vector<IndexRange>& ranges) const {
  ranges.clear();
  for (auto entry = entries_.rbegin(); entry != entries_.rend() && entry->epoch > seen; ++entry) {
    const Index end = std::min(entry->range.first + entry->range.count, count);
    if (entry->range.first < end) ranges.push_back({entry->range.first, end - entry->range.first});
  }
  join_ranges(ranges);
}

void join_ranges(std::vector<IndexRange>& ranges) noexcept {
  std::sort(ranges.begin(), ranges.end(),
            [](const IndexRange& a, const IndexRange& b) { return a.first < b.first; });
  std::size_t joined = 0;
  for (const IndexRange& range : ranges) {
    if (joined > 0 && range.first <= ranges[joined - 1].first + ranges[joined - 1].count) {
      IndexRange& last = ranges[joined - 1];
      last.count = std::max(last.first + last.count, range.first + range.count) - last.first;
    } else {
      ranges[joined++] = range;
    }
  }
  ranges.resize(joined);
}

}  // namespace sunder::scene
