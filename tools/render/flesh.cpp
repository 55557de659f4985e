#include "tools/render/flesh.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace sunder::tools {
namespace {

float random(std::int32_t x, std::int32_t y) {
  std::uint32_t h =
      static_cast<std::uint32_t>(x) * 0x8da6b343u ^ static_cast<std::uint32_t>(y) * 0xd8163841u;
  h = (h ^ h >> 15) * 0x2c1b3c6du;
  h = (h ^ h >> 12) * 0x297a2d39u;
  return static_cast<float>(h >> 8) / 16777216.0f;
}

float smooth_step(float from, float to, float value) {
  const float t = std::clamp((value - from) / (to - from), 0.0f, 1.0f);
  return t * t * (3 - 2 * t);
}

Vec3f mix(const Vec3f& a, const Vec3f& b, float t) { return a + t * (b - a); }

}  // namespace

float noise(float x, float y) {
  const float left = std::floor(x), top = std::floor(y);
  const auto column = static_cast<std::int32_t>(left), row = static_cast<std::int32_t>(top);
  const float u = smooth_step(0, 1, x - left), v = smooth_step(0, 1, y - top);
  const float above = (1 - u) * random(column, row) + u * random(column + 1, row);
  const float below = (1 - u) * random(column, row + 1) + u * random(column + 1, row + 1);
  return (1 - v) * above + v * below;
}

Vec3f flesh_color(float along, float across) {
  const Vec3f skin(0.60f, 0.27f, 0.20f), fat(0.72f, 0.42f, 0.19f), muscle(0.33f, 0.022f, 0.018f),
      fibre(0.46f, 0.060f, 0.042f), blood(0.15f, 0.004f, 0.005f);
  if (across < -1) {
    const float spots =
        0.5f * noise(2.0f * along, 2.0f * across) + 0.5f * noise(7 * along, 7 * across);
    return mix(mix(muscle, fibre, spots), blood, 0.45f * noise(along, across));
  }
  const float wander = 0.07f * (noise(4 * along, 3 * across) - 0.5f);
  const float from_lip = std::min(across, 1 - across) + wander;
  const float fibres =
      noise(1.5f * along, 26 * across) * 0.6f + noise(6 * along, 9 * across) * 0.4f;
  const float lobes = noise(9 * along, 30 * across);
  Vec3f color =
      mix(skin, Vec3f(fat * (0.75f + 0.35f * lobes)), smooth_step(0.05f, 0.09f, from_lip));
  color = mix(color, mix(muscle, fibre, fibres), smooth_step(0.15f, 0.21f, from_lip));
  return mix(color, blood, 0.7f * smooth_step(0.33f, 0.48f, from_lip));
}

}  // namespace sunder::tools
