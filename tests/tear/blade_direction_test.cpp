// The directions of the blades near a place, of which far runs of blades are left out.
#include "tear/filling/blade_direction.h"

#include <numbers>
#include <random>

#include <gtest/gtest.h>

#include "core/internal/ordered.h"

namespace sunder::tear {
namespace {

/// A winding stroke whose blades turn.
Stroke winding_stroke(std::mt19937& random, std::size_t blades) {
  std::uniform_real_distribution<double> unit(-1, 1);
  const double turn = unit(random), sway = 0.3 * unit(random);
  Stroke stroke;
  for (std::size_t b = 0; b < blades; ++b) {
    const double t = 0.01 * static_cast<double>(b);
    const Vec3d base(t, sway * std::sin(3 * t), 0.5);
    stroke.push_back({base, base + Vec3d(std::sin(turn * t), 0.2 * unit(random), -1)});
  }
  return stroke;
}

/// The direction with all blades of the stroke, summed up one by one.
Vec3d direction_of_all(const Stroke& stroke, const Vec3d& place) {
  double nearest = squared_distance(stroke.front(), place);
  for (const Blade& blade : stroke) nearest = std::min(nearest, squared_distance(blade, place));
  Vec3d sum = Vec3d::Zero();
  for (const Blade& blade : stroke) {
    const double squared = squared_distance(blade, place);
    const double ratio = squared > 0 ? nearest / squared : 1;
    sum += ratio * ratio * (blade.tip - blade.base).normalized();
  }
  return sum.normalized();
}

TEST(BladeDirections, are_those_of_all_blades_within_a_degree) {
  std::mt19937 random(11);
  for (const std::size_t blades : {2, 31, 32, 33, 64, 500}) {
    const Stroke stroke = winding_stroke(random, blades);
    ScratchMemory scratch;
    BladeDirections directions(stroke, scratch);
    std::uniform_real_distribution<double> near(-0.1, 0.1);
    for (int k = 0; k < 100; ++k) {
      const Blade& blade = stroke[random() % blades];
      const Vec3d place =
          (blade.base + blade.tip) / 2 + Vec3d(near(random), near(random), near(random));
      const Vec3d got = directions.at(place);
      EXPECT_NEAR(got.norm(), 1, 1e-12);
      EXPECT_GE(got.dot(direction_of_all(stroke, place)), std::cos(std::numbers::pi / 180))
          << blades << " blades, place " << place.transpose();
    }
  }
}

TEST(BladeDirections, at_a_blade_are_its_own) {
  std::mt19937 random(12);
  const Stroke stroke = winding_stroke(random, 100);
  ScratchMemory scratch;
  BladeDirections directions(stroke, scratch);
  for (const Blade& blade : stroke) {
    const Vec3d direction = (blade.tip - blade.base).normalized();
    EXPECT_GE(directions.at(blade.base).dot(direction), 1 - 1e-12);
  }
}

}  // namespace
}  // namespace sunder::tear
