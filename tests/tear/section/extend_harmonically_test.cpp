// Values on the rim of a flat region, extended to its inner points.
#include <algorithm>
#include <array>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/machine/random.h"
#include "support/machine/stress.h"
#include "support/models/flat_loops.h"
#include "support/oracles/flat_meshes.h"
#include "tear/section/flat_section.h"

namespace sunder::tear {
namespace {

using test::Random;

TEST(ExtendHarmonically, reproduces_linear_functions_within_the_values_of_the_rim) {
  std::size_t inner = 0;
  for (int seed = 0; seed < test::stressed(100, 20); ++seed) {
    SCOPED_TRACE(seed);
    Random random(static_cast<std::uint64_t>(seed));
    const auto loops = test::random_nested(random);
    for (const FlatRegion& region : find_regions(loops)) {
      const FlatLoop& outline = loops[region.outline];
      const double size = (outline[0] - outline[outline.size() / 2]).norm();
      const auto mesh = triangulate(loops, region, InnerPoints::graded);
      ASSERT_TRUE(mesh);
      const auto points = test::all_points(loops, region, *mesh);
      const Index rim = test::rim_count(loops, region);
      const auto linear = [&](const Vec2d& p) {
        const Vec2d at = (p - outline[0]) / size;
        return at.x() - 2 * at.y() + 3;
      };
      std::vector<double> values(5 * points.size());
      for (Index i = 0; i < rim; ++i) {
        const double weight = random.uniform(0, 1);
        const std::array<double, 5> row{linear(points[i]), 1, weight, 1 - weight,
                                        random.index(2) * 1e3};
        std::ranges::copy(row, &values[5 * i]);
      }
      std::array<double, 5> least, greatest;
      for (std::size_t c = 0; c < 5; ++c) {
        least[c] = greatest[c] = values[c];
        for (Index i = 0; i < rim; ++i) {
          least[c] = std::min(least[c], values[5 * i + c]);
          greatest[c] = std::max(greatest[c], values[5 * i + c]);
        }
      }
      extend_harmonically(points, *mesh, 5, values);
      inner += mesh->inner.size();
      for (std::size_t i = rim; i < points.size(); ++i) {
        const double* const row = &values[5 * i];
        ASSERT_NEAR(row[0], linear(points[i]), 1e-9);
        ASSERT_EQ(row[1], 1);
        ASSERT_NEAR(row[2] + row[3], 1, 1e-10);
        for (std::size_t c = 0; c < 5; ++c) {
          ASSERT_GE(row[c], least[c]);
          ASSERT_LE(row[c], greatest[c]);
        }
      }
    }
  }
  EXPECT_GT(inner, 1000u);
}

TEST(ExtendHarmonically, is_harmonic) {
  for (int seed = 0; seed < test::stressed(20, 20); ++seed) {
    SCOPED_TRACE(seed);
    Random random(static_cast<std::uint64_t>(seed));
    const auto loops = test::random_nested(random);
    for (const FlatRegion& region : find_regions(loops)) {
      const auto mesh = triangulate(loops, region, InnerPoints::graded);
      ASSERT_TRUE(mesh);
      const auto points = test::all_points(loops, region, *mesh);
      const Index rim = test::rim_count(loops, region);
      std::vector<double> values(points.size()), sums(points.size(), 0), weights(points.size(), 0);
      for (Index i = 0; i < rim; ++i) values[i] = random.uniform(0, 1);
      extend_harmonically(points, *mesh, 1, values);
      for (const auto& t : mesh->triangles)
        for (std::size_t k = 0; k < 3; ++k) {
          const Index a = t[k], b = t[(k + 1) % 3];
          const Vec2d to_a = points[a] - points[t[(k + 2) % 3]],
                      to_b = points[b] - points[t[(k + 2) % 3]];
          const double cotangent = to_a.dot(to_b) / (to_a.x() * to_b.y() - to_a.y() * to_b.x());
          for (const auto& [at, from] : {std::pair{a, b}, std::pair{b, a}}) {
            weights[at] += cotangent;
            sums[at] += cotangent * values[from];
          }
        }
      for (std::size_t i = rim; i < points.size(); ++i)
        ASSERT_NEAR(values[i], sums[i] / weights[i], 1e-9);
    }
  }
}

TEST(ExtendHarmonically, gives_no_rows_without_inner_points) {
  const std::vector<FlatLoop> loops{{{0, 0}, {1, 0}, {0, 1}}};
  const auto mesh = triangulate(loops, {0, {}}, InnerPoints::none);
  ASSERT_TRUE(mesh);
  std::vector<double> values(6, 1.0);
  extend_harmonically(loops[0], *mesh, 2, values);
  EXPECT_THAT(values, testing::Each(1.0));
}
}  // namespace
}  // namespace sunder::tear
