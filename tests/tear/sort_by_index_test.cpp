#include "tear/surface/sort_by_index.h"

#include <algorithm>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "support/machine/random.h"

namespace sunder::tear {
namespace {

using test::Random;

TEST(SortByIndex, orders_as_a_stable_sort_does) {
  using Item = std::pair<Index, Index>;  // key, place
  const auto key_of = [](const Item& item) { return item.first; };
  ScratchMemory memory;
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    SCOPED_TRACE(seed);
    Random random(seed);
    memory.reset();
    const Index count = random.index(seed % 2 == 0 ? 20 : 3000),
                most = std::vector<Index>{1, 200, 60'000, 10'000'000, kNone}[random.index(5)];
    ScratchVector<Item> items(&memory);
    for (Index i = 0; i < count; ++i) items.emplace_back(random.index(most), i);
    std::vector<Item> expected(items.begin(), items.end());
    std::stable_sort(expected.begin(), expected.end(),
                     [&](const Item& a, const Item& b) { return key_of(a) < key_of(b); });
    sort_by_index(items, key_of, memory);
    EXPECT_EQ(std::vector<Item>(items.begin(), items.end()), expected);
  }
}

TEST(SortByIndex, takes_no_memory_for_what_is_in_order) {
  ScratchMemory memory;
  ScratchVector<Index> items(&memory);
  for (Index i = 0; i < 1000; ++i) items.push_back(i);
  const std::size_t before = memory.bytes();
  for (int i = 0; i < 100; ++i)
    sort_by_index(
        items, [](Index item) { return item; }, memory);
  EXPECT_EQ(memory.bytes(), before);
}

}  // namespace
}  // namespace sunder::tear
