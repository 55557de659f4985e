// The lists to which repairs append, compared with plain ones.
#include <gtest/gtest.h>

#include "particles/clusters/membership_list.h"
#include "particles/internal/chunked_list.h"
#include "support/machine/random.h"

namespace sunder {
namespace {

using particles::ChunkedList;
using particles::MembershipList;

TEST(ChunkedList, keeps_entries_in_their_order_and_place) {
  ChunkedList<std::size_t> list;
  for (std::size_t i = 0; i < 5000; ++i) list.push_back(3 * i);
  const std::size_t* const early = &list[2000];
  for (std::size_t i = 5000; i < 9000; ++i) list.push_back(3 * i);
  EXPECT_EQ(&list[2000], early);
  ASSERT_EQ(list.size(), 9000u);
  std::size_t next = 0;
  list.for_each([&](std::size_t entry) { EXPECT_EQ(entry, 3 * next++); });
  EXPECT_EQ(next, 9000u);
  const std::vector<std::size_t> other = {5, 7};
  list.assign(other);
  EXPECT_EQ(list.size(), 2u);
  EXPECT_EQ(list[1], 7u);
}

/// The memberships of points, as a repair writes them.
struct Points {
  struct Slab {
    std::size_t first = 0;
    std::vector<ParticleMembership> wanted;
  };

  void write(std::size_t point, std::size_t count, test::Random& random) {
    Slab& of = slabs[point];
    std::vector<ParticleMembership> now;
    for (std::size_t i = 0; i < count; ++i)
      now.push_back({random.index(1000), static_cast<float>(random.uniform(0, 1))});
    if (of.wanted.empty() || !list.replace(of.first, of.wanted.size(), now)) {
      of.first = list.size();
      list.append(now, random.index(8));
    }
    of.wanted = std::move(now);
  }
  [[nodiscard]] bool are_kept(std::size_t end) const {
    return std::ranges::all_of(slabs, [&](const Slab& of) {
      if (of.first + of.wanted.size() > end) return true;  // was dropped
      return std::ranges::equal(list.at(of.first, of.wanted.size()), of.wanted,
                                [](const auto& a, const auto& b) {
                                  return a.particle == b.particle && a.reach == b.reach;
                                });
    });
  }

  MembershipList list;
  std::vector<Slab> slabs;
};

TEST(MembershipList, keeps_the_memberships_of_other_points_when_some_are_replaced) {
  test::Random random(5);
  Points points;
  points.list.set_decomposed(std::vector<ParticleMembership>(100, {3, 0.5f}));
  points.slabs.resize(4000);
  for (int i = 0; i < 30'000; ++i) points.write(random.index(4000), 1 + random.index(20), random);
  ASSERT_TRUE(points.are_kept(points.list.size()));
  // What is recorded is read back in one piece.
  MembershipList read;
  read.set_decomposed(std::vector<ParticleMembership>(100, {3, 0.5f}));
  read.set_appended(points.list.appended(points.list.size()));
  EXPECT_EQ(read.size(), points.list.size());
  std::swap(points.list, read);
  EXPECT_TRUE(points.are_kept(points.list.size()));
  std::swap(points.list, read);
  const std::size_t end = points.slabs[7].first;
  points.list.shrink(end);
  EXPECT_EQ(points.list.size(), end);
  EXPECT_TRUE(points.are_kept(end));
}

TEST(MembershipList, does_not_grow_when_points_get_one_more_again_and_again) {
  test::Random random(6);
  Points points;
  points.slabs.resize(100);
  const auto append_with_room = [&](std::size_t count) {
    for (Points::Slab& of : points.slabs) {
      std::vector<ParticleMembership> now(count, {1, 0.25f});
      if (of.wanted.empty() || !points.list.replace(of.first, of.wanted.size(), now)) {
        of.first = points.list.size();
        points.list.append(now, count / 2 + 4);
      }
      of.wanted = now;
    }
  };
  for (std::size_t count = 1; count <= 40; ++count) append_with_room(count);
  EXPECT_TRUE(points.are_kept(points.list.size()));
  EXPECT_LT(points.list.size(), 100u * 40 * 4) << "a list of all steps has 100 * 820";
}

}  // namespace
}  // namespace sunder
