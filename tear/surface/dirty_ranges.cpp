#include <sunder/tear/change_record.h>

#include <algorithm>

namespace sunder {
namespace {

/// The gap between elements[after - 1] and elements[after].
struct Gap {
  std::uint32_t width = 0;
  std::size_t after = 0;
};

/// Keeps the widest gaps in order; among equal ones the first.
class WidestGaps {
 public:
  void offer(const Gap& gap) {
    if (count_ == gaps_.size()) {
      const auto narrowest =
          std::min_element(gaps_.rbegin(), gaps_.rend(),
                           [](const Gap& a, const Gap& b) { return a.width < b.width; });
      if (gap.width <= narrowest->width) return;
      std::copy(narrowest.base(), gaps_.end(), narrowest.base() - 1);
      --count_;
    }
    gaps_[count_++] = gap;
  }
  [[nodiscard]] std::span<const Gap> in_order() const { return {gaps_.data(), count_}; }

 private:
  std::array<Gap, DirtyRanges::kMaximum - 1> gaps_ = {};
  std::size_t count_ = 0;
};

}  // namespace

DirtyRanges DirtyRanges::covering(std::span<const std::uint32_t> elements) {
  DirtyRanges ranges;
  if (elements.empty()) return ranges;
  WidestGaps gaps;
  for (std::size_t i = 1; i < elements.size(); ++i)
    if (elements[i] - elements[i - 1] > 1) gaps.offer({elements[i] - elements[i - 1] - 1, i});
  std::size_t first = 0;
  const auto close_at = [&](std::size_t end) {
    ranges.ranges_[ranges.count_++] = {elements[first], elements[end - 1] - elements[first] + 1};
    first = end;
  };
  for (const Gap& gap : gaps.in_order()) close_at(gap.after);
  close_at(elements.size());
  return ranges;
}

}  // namespace sunder
