#include <sunder/bodies/convex_hulls.h>
#include <sunder/bodies/mass_properties.h>
#include <sunder/skinning/pose.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <vector>

#include <gtest/gtest.h>

#include "support/machine/random.h"
#include "support/models/rigs.h"
#include "support/models/solids.h"

namespace sunder {
namespace {

using test::make_ball;
using test::make_box;
using test::Random;
using test::Solid;

/// Greatest distance of a point above the faces of a hull.
double farthest_outside(const ConvexHull& hull, const std::vector<Vec3d>& points) {
  double farthest = 0;
  for (const auto& [a, b, c] : hull.triangles) {
    const Vec3d normal =
        Vec3d(hull.points[b] - hull.points[a]).cross(Vec3d(hull.points[c] - hull.points[a]));
    if (!(normal.norm() > 0)) continue;
    for (const Vec3d& point : points)
      farthest = std::max(farthest, (point - hull.points[a]).dot(normal) / normal.norm());
  }
  return farthest;
}

ConvexHull hull_of(const std::vector<Vec3d>& points, std::uint32_t most = 65535) {
  const auto hull = convex_hull(points, most);
  EXPECT_TRUE(hull) << hull.error().text();
  return hull ? *hull : ConvexHull();
}

TEST(ConvexHulls, hold_all_points) {
  for (int seed = 1; seed <= 30; ++seed) {
    SCOPED_TRACE(seed);
    Random random(static_cast<std::uint64_t>(seed));
    const double scale = std::pow(10.0, random.uniform(-9, 9));
    const Vec3d away = scale * 10.0 * random.direction();
    std::vector<Vec3d> points;
    for (std::uint32_t i = 0; i < 4 + random.index(300); ++i) {
      const Vec3d p{random.uniform(-1, 1), random.uniform(-2, 2), random.uniform(-1, 3)};
      points.push_back(scale * p + away);
      if (random.index(10) == 0) points.push_back(points.back());
    }
    const ConvexHull hull = hull_of(points);
    EXPECT_LT(farthest_outside(hull, points), 1e-12 * scale);
    EXPECT_EQ(hull.farthest_outside, 0);
    // Closed, of given points, and its volume is that of its faces.
    const auto mass = compute_mass(hull.points, hull.triangles);
    ASSERT_TRUE(mass);
    EXPECT_EQ(mass->holes, 0u);
    EXPECT_NEAR(hull.volume, mass->volume, 1e-11 * std::pow(scale, 3));
    for (const Vec3d& corner : hull.points)
      EXPECT_NE(std::find(points.begin(), points.end(), corner), points.end());
    EXPECT_EQ(hull_of(points).points, hull.points);  // deterministic
  }
}

TEST(ConvexHulls, of_known_shapes_have_their_volume) {
  Solid box = make_box(Vec3d(1, 2, 3));
  for (int i = 1; i < 10; ++i) box.positions.push_back(0.05 * i * Vec3d(1, 2, -3));  // inside
  const ConvexHull hull = hull_of(box.positions);
  EXPECT_EQ(hull.points.size(), 8u);
  EXPECT_EQ(hull.triangles.size(), 12u);
  EXPECT_NEAR(hull.volume, 6, 1e-12);
  const Solid ball = make_ball(3);
  const auto mass = compute_mass(ball.positions, ball.triangles);
  EXPECT_NEAR(hull_of(ball.positions).volume, mass->volume, 1e-12);
}

TEST(ConvexHulls, of_few_points_lose_little) {
  const Solid ball = make_ball(4);
  double before = 2;
  for (const std::uint32_t most : {4u, 8u, 16u, 32u, 64u, 128u}) {
    const ConvexHull hull = hull_of(ball.positions, most);
    EXPECT_LE(hull.points.size(), most);
    EXPECT_NEAR(hull.farthest_outside, farthest_outside(hull, ball.positions), 1e-12);
    EXPECT_LT(hull.farthest_outside, before);
    before = hull.farthest_outside;
  }
  EXPECT_LT(before, 0.06);
}

TEST(ConvexHulls, of_degenerate_points_are_flat) {
  Random random(3);
  const Vec3d right = random.direction(), up = right.cross(random.direction()).normalized();
  std::vector<Vec3d> points(5, Vec3d(1, 2, 3));
  ConvexHull hull = hull_of(points);
  EXPECT_EQ(hull.points.size(), 1u);
  EXPECT_TRUE(hull.triangles.empty());
  EXPECT_EQ(hull.volume, 0);

  for (int i = -3; i < 5; ++i) points.push_back(Vec3d(1, 2, 3) + i * right);
  hull = hull_of(points);
  ASSERT_EQ(hull.points.size(), 2u);
  EXPECT_NEAR((hull.points[0] - hull.points[1]).norm(), 7, 1e-12);

  for (int i = 0; i < 60; ++i) {  // a disc
    const double angle = 0.1 * i;
    points.push_back(Vec3d(1, 2, 3) + 10 * std::cos(angle) * right + 10 * std::sin(angle) * up);
  }
  hull = hull_of(points);
  EXPECT_GE(hull.points.size(), 60u);
  EXPECT_EQ(hull.triangles.size(), 2 * (hull.points.size() - 2));
  EXPECT_NEAR(hull.volume, 0, 1e-9);
  EXPECT_LT(farthest_outside(hull, points), 1e-12);
  hull = hull_of(points, 8);
  EXPECT_EQ(hull.points.size(), 8u);
  EXPECT_GT(hull.farthest_outside, 0.01);
  EXPECT_LT(hull.farthest_outside, 2);

  for (const double thickness : {1e-4, 1e-7, 1e-10, 1e-13}) {  // nearly flat
    std::vector<Vec3d> thick = points;
    for (std::size_t i = 0; i < points.size(); i += 2) thick[i] += thickness * right.cross(up);
    EXPECT_LT(farthest_outside(hull_of(thick), thick), 1e-6) << thickness;
  }
}

TEST(ConvexHulls, of_a_character_follow_its_bones) {
  const Character tube = test::make_tube(24, 12, 4);
  Random random(9);
  const ModelPose pose = test::random_pose(tube, random);
  std::vector<Vec3d> all = test::posed_positions(tube, 0, pose);
  for (const std::uint32_t most : {1u, 2u, 3u, 8u}) {
    const auto hulls = convex_hulls(tube, pose, {most, 255});
    ASSERT_TRUE(hulls) << hulls.error().text();
    EXPECT_EQ(hulls->size(), std::min(most, 4u));
    std::set<std::uint32_t> bones;
    for (const ConvexHull& hull : *hulls) bones.insert(hull.part);
    EXPECT_EQ(bones.size(), hulls->size());
    for (const Vec3d& point : all) {  // in one of them
      double nearest = 1;
      for (const ConvexHull& hull : *hulls)
        nearest = std::min(nearest, farthest_outside(hull, {point}));
      EXPECT_LT(nearest, 1e-9);
    }
  }
}

TEST(ConvexHulls, faults_are_named) {
  const Solid box = make_box(Vec3d(1, 1, 1));
  EXPECT_EQ(convex_hull({}).error().code(), StatusCode::empty_input);
  EXPECT_EQ(convex_hull(box.positions, 3).error().code(), StatusCode::invalid_argument);
  std::vector<Vec3d> points = box.positions;
  points[5][0] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(convex_hull(points).error().code(), StatusCode::non_finite_value);
  EXPECT_EQ(convex_hull(points).error().index(), 5u);
  const std::vector<std::uint32_t> parts(box.triangles.size(), 7);
  EXPECT_EQ(convex_hulls(box.positions, box.triangles, std::span(parts).first(3)).error().code(),
            StatusCode::size_mismatch);
  EXPECT_EQ(convex_hulls(box.positions, box.triangles, parts, {0, 64}).error().code(),
            StatusCode::invalid_argument);
  EXPECT_EQ(convex_hulls(box.positions, {}, {}).error().code(), StatusCode::empty_input);
  const auto hulls = convex_hulls(box.positions, box.triangles, parts);
  ASSERT_TRUE(hulls);
  ASSERT_EQ(hulls->size(), 1u);
  EXPECT_EQ((*hulls)[0].part, 7u);
}

}  // namespace
}  // namespace sunder
