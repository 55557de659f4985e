#include "tools/render/lighting.h"

#include <cmath>
#include <numbers>

namespace sunder::tools {
namespace {

constexpr std::size_t kSkyPerSample = 14, kLampPerSample = 4;
constexpr float kLampSize = 0.10f;  ///< Radius, in distances of the lamp.
const Vec3f kLamp(1.75f, 1.68f, 1.58f), kFill(0.20f, 0.22f, 0.26f), kAbove(0.86f, 0.90f, 0.98f),
    kGround(0.42f, 0.40f, 0.38f);

}  // namespace

Lighting::Lighting(const Camera& camera) {
  const Vec3d back = (camera.eye - camera.focal_point).normalized();
  const Vec3d right = camera.up.cross(back).normalized(), up = back.cross(right);
  const double golden = std::numbers::pi * (3 - std::sqrt(5.0));
  constexpr std::size_t kSky = kSamples * kSkyPerSample, kLamps = kSamples * kLampPerSample;
  for (std::size_t i = 0; i < kSky; ++i) {  // Spread evenly over the sphere.
    const double y = 1 - (2 * static_cast<double>(i) + 1) / kSky, r = std::sqrt(1 - y * y);
    const double angle = golden * static_cast<double>(i);
    const Vec3f towards = Vec3d(r * std::cos(angle), y, r * std::sin(angle)).cast<float>();
    const float height = 0.5f + 0.5f * towards.y();
    // The mean of cosines over a sphere is a quarter.
    const Vec3f light =
        4.0f * (height * kAbove + (1 - height) * kGround) / static_cast<float>(kSkyPerSample);
    sky_[i % kSamples].push_back({towards, light});
  }
  const Vec3d middle = (back - 0.65 * right + 1.05 * up).normalized();
  const Vec3d beside = middle.unitOrthogonal(), across = middle.cross(beside);
  for (std::size_t i = 0; i < kLamps; ++i) {
    const double r = kLampSize * std::sqrt((static_cast<double>(i) + 0.5) / kLamps);
    const double angle = golden * static_cast<double>(i);
    const Vec3d towards = middle + r * (std::cos(angle) * beside + std::sin(angle) * across);
    lamp_[i % kSamples].push_back(
        {towards.normalized().cast<float>(), kLamp / static_cast<float>(kLampPerSample)});
  }
  fill_ = {(0.6 * back + 0.9 * right + 0.1 * up).normalized().cast<float>(), kFill};
}

}  // namespace sunder::tools
