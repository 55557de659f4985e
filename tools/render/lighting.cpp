#include "tools/render/lighting.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace sunder::tools {
namespace {

constexpr float kLampSize = 0.10f;  ///< Radius, in distances of the lamp.
const Vec3f kLamp(1.75f, 1.68f, 1.58f), kFill(0.20f, 0.22f, 0.26f), kAbove(0.86f, 0.90f, 0.98f),
    kGround(0.42f, 0.40f, 0.38f);

/// The place with this index of `count` places that are spread evenly over a disc of radius 1.
Vec2d on_disc(std::size_t index, std::size_t count) {
  const double golden = std::numbers::pi * (3 - std::sqrt(5.0));
  const double r = std::sqrt((static_cast<double>(index) + 0.5) / static_cast<double>(count));
  const double angle = golden * static_cast<double>(index);
  return {r * std::cos(angle), r * std::sin(angle)};
}

}  // namespace

Lighting::Lighting(const Camera& camera) {
  const Vec3d back = (camera.eye - camera.focal_point).normalized();
  const Vec3d right = camera.up.cross(back).normalized(), up = back.cross(right);
  const Vec3d middle = (back - 0.65 * right + 1.05 * up).normalized();
  const Vec3d beside = middle.unitOrthogonal(), across = middle.cross(beside);
  for (std::size_t pattern = 0; pattern < kPatterns; ++pattern) {
    for (std::size_t i = 0; i < kSkyRays; ++i) {
      // The first half of the rays alone is spread over the whole disc, too.
      const std::size_t ring = i < kSkyRays / 2 ? 2 * i : 2 * (i - kSkyRays / 2) + 1;
      const Vec2d at = on_disc(ring * kPatterns + pattern, kSkyRays * kPatterns);
      sky_[pattern][i] =
          Vec3d(at.x(), at.y(), std::sqrt(std::max(0.0, 1 - at.squaredNorm()))).cast<float>();
    }
    for (std::size_t i = 0; i < kLampRays; ++i) {
      const Vec2d at =
          static_cast<double>(kLampSize) * on_disc(i * kPatterns + pattern, kLampRays * kPatterns);
      lamp_[pattern * kLampRays + i] =
          Vec3d(middle + at.x() * beside + at.y() * across).normalized().cast<float>();
    }
  }
  back_ = back.cast<float>();
  right_ = right.cast<float>();
  up_ = up.cast<float>();
  middle_of_lamp_ = {middle.cast<float>(), kLamp};
  fill_ = {(0.6 * back + 0.9 * right + 0.1 * up).normalized().cast<float>(), kFill};
}

Lighting::Across Lighting::across(const Vec3f& normal) const {
  // The shortest rotation from `back` to the normal, applied to `right` and `up`: Duff et al.,
  // "Building an Orthonormal Basis, Revisited", 2017. It jumps at -back alone, which is not seen.
  const float x = normal.dot(right_), y = normal.dot(up_), z = std::max(normal.dot(back_), -0.999f);
  const float a = 1 / (1 + z), b = -x * y * a;
  return {(1 - x * x * a) * right_ + b * up_ - x * back_,
          b * right_ + (1 - y * y * a) * up_ - y * back_};
}

Vec3f Lighting::sky_color(const Vec3f& towards) {
  const float height = 0.5f + 0.5f * towards.y();
  return height * kAbove + (1 - height) * kGround;
}

Vec3f Lighting::sky_light(const Vec3f& normal) {
  // The mean over the sphere of twice the positive cosine, times the colour.
  return (kAbove + kGround) / 4 + (kAbove - kGround) * (normal.y() / 6);
}

}  // namespace sunder::tools
