#include <sunder/tear/change_record.h>

#include <algorithm>
#include <numeric>

#include <gtest/gtest.h>

#include "support/machine/random.h"

namespace sunder {
namespace {

using test::Random;

std::vector<IndexRange> ranges_of(const std::vector<std::uint32_t>& elements) {
  const DirtyRanges ranges = DirtyRanges::covering(elements);
  return {ranges.begin(), ranges.end()};
}

std::uint32_t covered_count(const std::vector<IndexRange>& ranges) {
  return std::accumulate(
      ranges.begin(), ranges.end(), 0u,
      [](std::uint32_t sum, const IndexRange& range) { return sum + range.count; });
}

/// Elements of [0, size), each with the probability `density`, some of them repeated.
std::vector<std::uint32_t> random_elements(Random& random, std::uint32_t size, double density) {
  std::vector<std::uint32_t> elements;
  for (std::uint32_t i = 0; i < size; ++i)
    if (random.uniform(0, 1) < density) elements.insert(elements.end(), 1 + random.index(3), i);
  return elements;
}

/// The smallest number of elements that `ranges` ranges can cover: tries each way to divide the
/// runs into groups, by recursion over the end of the first group.
std::uint32_t least_cover(std::span<const IndexRange> runs, std::size_t ranges) {
  if (runs.empty()) return 0;
  if (ranges == 0) return kNone;
  std::uint32_t least = kNone;
  for (std::size_t last = 0; last < runs.size(); ++last) {
    const std::uint32_t rest = least_cover(runs.subspan(last + 1), ranges - 1);
    if (rest != kNone)
      least = std::min(least, runs[last].first + runs[last].count - runs[0].first + rest);
  }
  return least;
}

std::vector<IndexRange> runs_of(const std::vector<std::uint32_t>& elements) {
  std::vector<IndexRange> runs;
  for (const std::uint32_t element : elements)
    if (!runs.empty() && element <= runs.back().first + runs.back().count)
      runs.back().count = element - runs.back().first + 1;
    else
      runs.push_back({element, 1});
  return runs;
}

TEST(DirtyRanges, of_nothing_are_none) {
  EXPECT_TRUE(DirtyRanges::covering({}).empty());
  EXPECT_EQ(DirtyRanges::covering({}), DirtyRanges{});
}

TEST(DirtyRanges, are_exact_up_to_eight_runs) {
  EXPECT_EQ(ranges_of({5}), (std::vector<IndexRange>{{5, 1}}));
  EXPECT_EQ(ranges_of({5, 5, 6, 8, 8}), (std::vector<IndexRange>{{5, 2}, {8, 1}}));
  EXPECT_EQ(ranges_of({0, 2, 4, 6, 8, 10, 12, 14}).size(), 8u);
  EXPECT_EQ(ranges_of({0, kNone - 1}), (std::vector<IndexRange>{{0, 1}, {kNone - 1, 1}}));
}

TEST(DirtyRanges, of_equal_gaps_the_last_are_filled) {
  EXPECT_EQ(
      ranges_of({0, 2, 4, 6, 8, 10, 12, 14, 16, 18}),
      (std::vector<IndexRange>{{0, 1}, {2, 1}, {4, 1}, {6, 1}, {8, 1}, {10, 1}, {12, 1}, {14, 5}}));
}

TEST(DirtyRanges, are_ascending_apart_and_hold_every_element) {
  Random random(1);
  for (int i = 0; i < 500; ++i) {
    const std::uint32_t size = 1 + random.index(3000);
    const double density = random.uniform(0, 1);
    const auto elements = random_elements(random, size, density * density);
    const auto ranges = ranges_of(elements);
    ASSERT_LE(ranges.size(), DirtyRanges::kMaximum);
    for (std::size_t r = 0; r < ranges.size(); ++r) {
      ASSERT_GT(ranges[r].count, 0u);
      if (r > 0) {
        ASSERT_GT(ranges[r].first, ranges[r - 1].first + ranges[r - 1].count);
      }
      // Both ends are elements, so no range could be shorter.
      ASSERT_TRUE(std::ranges::binary_search(elements, ranges[r].first));
      ASSERT_TRUE(std::ranges::binary_search(elements, ranges[r].first + ranges[r].count - 1));
    }
    for (const std::uint32_t element : elements)
      ASSERT_TRUE(std::ranges::any_of(ranges, [&](const IndexRange& range) {
        return element >= range.first && element - range.first < range.count;
      }));
    if (runs_of(elements).size() <= DirtyRanges::kMaximum) {
      ASSERT_EQ(ranges, runs_of(elements));
    }
  }
}

TEST(DirtyRanges, cover_the_least_that_eight_can) {
  Random random(2);
  int merged = 0;
  for (int i = 0; i < 300; ++i) {
    const auto elements = random_elements(random, 60, random.uniform(0.1, 0.5));
    const auto runs = runs_of(elements);
    if (runs.size() > 14) continue;  // the search is exponential
    merged += runs.size() > DirtyRanges::kMaximum ? 1 : 0;
    ASSERT_EQ(covered_count(ranges_of(elements)), least_cover(runs, DirtyRanges::kMaximum));
  }
  EXPECT_GT(merged, 100);
}

}  // namespace
}  // namespace sunder
