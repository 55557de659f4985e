// Pruning of <sunder/weights/influences.h>.

#include <sunder/weights/influences.h>

#include <algorithm>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include "skinning/internal/reference.h"
#include "support/machine/random.h"
#include "support/models/random_skin.h"

namespace sunder {
namespace {

using Influences = std::vector<Influence>;

Influences copy_of(std::span<const Influence> influences) {
  return {influences.begin(), influences.end()};
}

double sum_of(std::span<const Influence> influences) {
  double sum = 0;
  for (const Influence& influence : influences) sum += static_cast<double>(influence.weight);
  return sum;
}

/// Linear blend skinning by its definition, with weights divided by their sum.
Vec3d posed(const Vec3d& position, std::span<const Influence> influences,
            const std::vector<Affine3d>& palette) {
  Vec3d sum = Vec3d::Zero();
  for (const Influence& influence : influences)
    sum += static_cast<double>(influence.weight) / sum_of(influences) *
           (palette[influence.slot] * position);
  return sum;
}

Mesh many_influences(test::Random& random) {
  test::RandomSkin wanted;
  wanted.vertices = 4'000;
  wanted.slots = 60;
  wanted.influences = 40;
  wanted.spread = 40;
  return test::make_random_skin(random, wanted);
}

TEST(Prune, keeps_the_largest_followed_by_dropped_ones) {
  Influences influences = {{7, 0.125f}, {3, 0.25f}, {5, 0.0625f}, {1, 0.5f}, {2, 0.0625f}};
  ASSERT_EQ(prune_influences(influences, 2), 2u);
  EXPECT_EQ(influences, (Influences{{1, static_cast<float>(0.5 / 0.75)},
                                    {3, static_cast<float>(0.25 / 0.75)},
                                    {7, 0.125f},
                                    {2, 0.0625f},
                                    {5, 0.0625f}}));
}

TEST(Prune, equal_weights_stay_by_the_lower_slot_whatever_their_order) {
  Influences influences = {{0, 0.25f}, {4, 0.25f}, {9, 0.25f}, {12, 0.25f}};
  do {
    Influences pruned = influences;
    ASSERT_EQ(prune_influences(pruned, 2), 2u);
    EXPECT_EQ(pruned[0], (Influence{0, 0.5f}));
    EXPECT_EQ(pruned[1], (Influence{4, 0.5f}));
  } while (std::next_permutation(influences.begin(), influences.end(),
                                 [](auto& a, auto& b) { return a.slot < b.slot; }));
}

TEST(Prune, a_maximum_of_zero_keeps_all_in_their_order) {
  const Influences influences = {{7, 0.1f}, {3, 0.2f}, {5, 0.7f}};
  Influences pruned = influences;
  EXPECT_EQ(prune_influences(pruned, 0), 3u);
  EXPECT_EQ(pruned, influences);
}

TEST(Prune, influences_within_the_maximum_are_sorted_and_keep_their_bits) {
  for (const std::size_t maximum : {3u, 4u, 100u}) {
    Influences pruned = {{7, 0.1f}, {3, 0.2f}, {5, 0.7f}};
    EXPECT_EQ(prune_influences(pruned, maximum), 3u);
    EXPECT_EQ(pruned, (Influences{{5, 0.7f}, {3, 0.2f}, {7, 0.1f}}));
  }
}

TEST(Prune, kept_weights_sum_to_one_largest_first) {
  test::Random random(3);
  const Mesh mesh = many_influences(random);
  for (std::uint32_t v = 0; v < mesh.vertex_count(); ++v)
    for (const std::size_t maximum : {1u, 2u, 4u, 8u, 12u}) {
      Influences influences = copy_of(mesh.weights.of(v));
      const std::size_t kept = prune_influences(influences, maximum);
      ASSERT_EQ(kept, std::min<std::size_t>(maximum, mesh.weights.of(v).size()));
      influences.resize(kept);
      EXPECT_NEAR(sum_of(influences), 1, 2e-7 * static_cast<double>(kept));
      EXPECT_TRUE(std::is_sorted(influences.begin(), influences.end(),
                                 [](auto& a, auto& b) { return a.weight > b.weight; }));
    }
}

TEST(Prune, the_displacement_is_that_of_linear_blend_skinning) {
  test::Random random(8);
  const Mesh mesh = many_influences(random);
  for (const double scale : {1.0, 3.0}) {
    const std::vector<Affine3d> palette = test::random_palette(random, 60, scale);
    for (std::uint32_t v = 0; v < mesh.vertex_count(); ++v) {
      const Vec3d position = mesh.positions[v].cast<double>();
      Influences influences = copy_of(mesh.weights.of(v));
      ASSERT_TRUE(sort_influences(influences));
      for (const std::size_t kept : {1u, 4u, 8u, 40u}) {
        const Vec3d displacement = pruning_displacement(position, influences, kept, palette);
        const auto first =
            std::span<const Influence>(influences).first(std::min(kept, influences.size()));
        const Vec3d expected =
            posed(position, first, palette) - posed(position, influences, palette);
        EXPECT_LT((displacement - expected).norm(), 1e-12)
            << "vertex " << v << ", " << kept << " kept";
        EXPECT_NEAR(dropped_mass(influences, kept), 1 - sum_of(first) / sum_of(influences), 1e-14);
      }
    }
  }
}

TEST(Prune, the_displacement_holds_for_stored_weights_within_rounding) {
  test::Random random(9);
  Mesh mesh = many_influences(random);
  const Mesh unpruned = mesh;
  const std::vector<Affine3d> palette = test::random_palette(random, 60);
  mesh.weights = {};
  for (std::uint32_t v = 0; v < unpruned.vertex_count(); ++v) {
    Influences influences = copy_of(unpruned.weights.of(v));
    influences.resize(prune_influences(influences, 4));
    mesh.weights.append(influences);
  }
  for (std::uint32_t v = 0; v < mesh.vertex_count(); ++v) {
    Influences influences = copy_of(unpruned.weights.of(v));
    ASSERT_TRUE(sort_influences(influences));
    const Vec3d moved = deform_position_reference(mesh, v, palette, {}) -
                        deform_position_reference(unpruned, v, palette, {});
    EXPECT_LT(
        (moved - pruning_displacement(mesh.positions[v].cast<double>(), influences, 4, palette))
            .norm(),
        2e-6);
  }
}

TEST(Prune, nothing_dropped_moves_nothing) {
  const std::vector<Affine3d> palette(2, Affine3d::Identity());
  const Influences influences = {{0, 0.75f}, {1, 0.25f}};
  for (const std::size_t kept : {2u, 3u}) {
    EXPECT_EQ(dropped_mass(influences, kept), 0);
    EXPECT_EQ(pruning_displacement(Vec3d(1, 2, 3), influences, kept, palette),
              Vec3d(Vec3d::Zero()));
  }
  EXPECT_EQ(dropped_mass(influences, 0), 1);
  EXPECT_EQ(pruning_displacement(Vec3d(1, 2, 3), influences, 0, palette), Vec3d(Vec3d::Zero()));
  const Influences without_weight = {{0, 1.0f}, {1, 0.0f}};
  EXPECT_EQ(dropped_mass(without_weight, 1), 0);
  EXPECT_EQ(pruning_displacement(Vec3d(1, 2, 3), without_weight, 1, palette), Vec3d(Vec3d::Zero()));
}

TEST(Prune, invalid_weights_stay_as_they_are) {
  const float nan = std::numeric_limits<float>::quiet_NaN(),
              infinity = std::numeric_limits<float>::infinity();
  for (const Influences& bad : {Influences{},
                                {{0, 0.0f}},
                                {{0, 0.0f}, {1, -0.0f}},
                                {{0, 0.25f}, {1, nan}, {2, 0.75f}},
                                {{0, 0.25f}, {1, infinity}},
                                {{0, 0.25f}, {1, -0.5f}, {2, 1.25f}}}) {
    for (const std::size_t maximum : {0u, 1u, 2u, 4u}) {
      Influences pruned = bad;
      EXPECT_EQ(prune_influences(pruned, maximum), 0u);
      EXPECT_FALSE(sort_influences(pruned));
      ASSERT_EQ(pruned.size(), bad.size());
      for (std::size_t i = 0; i < bad.size(); ++i) EXPECT_EQ(pruned[i].slot, bad[i].slot);
    }
  }
}

}  // namespace
}  // namespace sunder
