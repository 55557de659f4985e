// Distances between posed surfaces and strokes, planes and axes, against dense samples.

#include "tools/model/posed_surface.h"

#include <sunder/skinning/pose.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include <gtest/gtest.h>

#include "tools/demo/demo_rig.h"
#include "tools/tear/stroke_warnings.h"

namespace sunder::tools {
namespace {

class Random {
 public:
  explicit Random(unsigned seed) : engine_(seed) {}
  double number(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(engine_);
  }
  Vec3d point(double low, double high) {
    const double x = number(low, high), y = number(low, high), z = number(low, high);
    return {x, y, z};
  }
  Corners triangle(const Vec3d& centre) {
    return {centre + point(-1, 1), centre + point(-1, 1), centre + point(-1, 1)};
  }

 private:
  std::mt19937 engine_;
};

std::vector<Vec3d> samples_of(const Corners& corners, int steps) {
  std::vector<Vec3d> samples;
  for (int i = 0; i <= steps; ++i)
    for (int j = 0; i + j <= steps; ++j) {
      const double u = static_cast<double>(i) / steps, v = static_cast<double>(j) / steps;
      samples.push_back((1 - u - v) * corners[0] + u * corners[1] + v * corners[2]);
    }
  return samples;
}

double sampled_distance(const Corners& a, const Corners& b, int steps) {
  double least = std::numeric_limits<double>::infinity();
  const std::vector<Vec3d> of_b = samples_of(b, steps);
  for (const Vec3d& p : samples_of(a, steps))
    for (const Vec3d& q : of_b) least = std::min(least, (p - q).norm());
  return least;
}

/// Samples are at most 2 sqrt(3) / steps of an edge of at most 2 sqrt(3) m apart.
TEST(PosedSurface, distances_of_triangles_agree_with_samples) {
  Random random(7);
  constexpr int kSteps = 24;
  const double spacing = 2 * std::sqrt(3.0) / kSteps;
  int touching = 0;
  for (int i = 0; i < 300; ++i) {
    const Corners a = random.triangle(Vec3d::Zero());
    Corners b = random.triangle(random.point(-1, 1));
    if (i % 5 == 1) b[2] = b[1];  // a segment
    if (i % 5 == 2) b[1] = b[2] = b[0];
    const double distance = distance_between(a, b), sampled = sampled_distance(a, b, kSteps);
    EXPECT_LE(distance, sampled + 1e-12) << i;
    EXPECT_GE(distance, sampled - 2 * spacing) << i;
    EXPECT_NEAR(distance, distance_between(b, a), 1e-9) << i;
    touching += distance == 0 ? 1 : 0;
  }
  EXPECT_GT(touching, 10);
  EXPECT_LT(touching, 200);
}

PosedSurface cactus() {
  const Character character = make_cactus();
  return *pose_surface(character, *make_pose(character, RestPose{}));
}

/// The search by runs of triangles finds what a search of all finds.
TEST(PosedSurface, the_nearest_triangle_is_found) {
  const PosedSurface surface = cactus();
  Random random(8);
  for (int i = 0; i < 40; ++i) {
    const std::vector<Corners> shape = {random.triangle(random.point(-3, 3)),
                                        random.triangle(random.point(-3, 3))};
    double least = std::numeric_limits<double>::infinity();
    for (const Corners& part : shape)
      for (const Corners& triangle : surface.triangles)
        least = std::min(least, distance_between(part, triangle));
    EXPECT_EQ(distance_between(surface, shape), least) << i;
  }
}

/// A point is inside if rays leave through an odd number of faces.
TEST(PosedSurface, the_inside_is_where_rays_cross_an_odd_number_of_faces) {
  const PosedSurface surface = cactus();
  Random random(9);
  int inside = 0;
  for (int i = 0; i < 200; ++i) {
    const Vec3d point(random.number(-0.6, 0.6), random.number(0, 1.8), random.number(-0.4, 0.4));
    const Vec3d direction = random.point(-1, 1);
    int crossed = 0;
    double at = 0;
    while (const auto next = first_hit(surface, point, direction, at)) {
      at = *next;
      ++crossed;
    }
    EXPECT_EQ(is_inside(surface, point), crossed % 2 == 1) << i;
    inside += crossed % 2;
  }
  EXPECT_GT(inside, 10);
}

/// A cylinder along y with open ends.
PosedSurface tube(double radius) {
  PosedSurface surface;
  constexpr int kSides = 64;
  for (int i = 0; i < kSides; ++i) {
    const auto at = [&](int side, double y) {
      const double angle = 2 * 3.14159265358979 * side / kSides;
      return Vec3d(radius * std::cos(angle), y, radius * std::sin(angle));
    };
    surface.triangles.push_back({at(i, 0), at(i, 1), at(i + 1, 1)});
    surface.triangles.push_back({at(i, 0), at(i + 1, 1), at(i + 1, 0)});
  }
  return surface;
}

TEST(PosedSurface, the_body_is_as_wide_as_it_is_across_the_stroke) {
  const PosedSurface surface = tube(0.1);
  const Stroke along = {{{0, 0.3, 2}, {0, 0.3, -2}}, {{0, 0.6, 2}, {0, 0.6, -2}}};
  ASSERT_TRUE(body_width(surface, along));
  EXPECT_NEAR(*body_width(surface, along), 0.2, 1e-3);
  const Stroke across = {{{-0.05, 0.5, 2}, {-0.05, 0.5, -2}}, {{0.05, 0.5, 2}, {0.05, 0.5, -2}}};
  EXPECT_FALSE(body_width(surface, across));  // open ends
  const Stroke beside = {{{5, 0.3, 2}, {5, 0.3, -2}}, {{5, 0.6, 2}, {5, 0.6, -2}}};
  EXPECT_FALSE(body_width(surface, beside));
}

}  // namespace
}  // namespace sunder::tools
