#include "core/internal/index_set.h"

#include <set>

#include <gtest/gtest.h>

#include "support/machine/random.h"

namespace sunder {
namespace {

TEST(IndexSet, lists_what_std_set_lists) {
  test::Random random(1);
  for (int i = 0; i < 200; ++i) {
    const Index limit = 1 + random.index(500);
    IndexSet set(limit);
    std::set<Index> expected;
    for (std::uint32_t k = random.index(300); k > 0; --k) {
      const Index index = random.index(limit);
      EXPECT_EQ(set.insert(index), expected.insert(index).second);
    }
    const std::vector<Index> found = set.list();
    ASSERT_EQ(found, std::vector<Index>(expected.begin(), expected.end()));
    for (Index place = 0; place < found.size(); ++place)
      ASSERT_EQ(set.place_of(found[place]), place);
  }
}

TEST(IndexSet, of_nothing_is_empty) {
  EXPECT_TRUE(IndexSet(0).list().empty());
  EXPECT_TRUE(IndexSet(64).list().empty());
}

}  // namespace
}  // namespace sunder
