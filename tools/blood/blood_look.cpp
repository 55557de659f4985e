#include "tools/blood/blood_look.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace sunder::tools {
namespace {

const Vec3f kFresh(0.26f, 0.008f, 0.009f), kClotted(0.085f, 0.003f, 0.004f);
constexpr double kNarrowest = 0.25, kWidest = 1.0;  ///< Border of the blood, in reaches.
constexpr double kSoftness = 0.5;                   ///< Of the border, as a share of its distance.
constexpr double kMostCover = 0.97, kLeastCover = 0.5;  ///< At the lip, and at the reach.
constexpr float kReddest = 0.5f;                        ///< Share of reddened skin at the lip.

double at_lattice(std::int64_t x, std::int64_t y, std::int64_t z) {
  std::uint64_t h = static_cast<std::uint64_t>(x) * 0x9e3779b97f4a7c15u ^
                    static_cast<std::uint64_t>(y) * 0xc2b2ae3d27d4eb4fu ^
                    static_cast<std::uint64_t>(z) * 0x165667b19e3779f9u;
  h = (h ^ h >> 31) * 0xd6e8feb86659fd93u;
  h ^= h >> 29;
  return static_cast<double>(h >> 40) / 16777216.0;
}

double step_between(double from, double to, double value) {
  const double t = std::clamp((value - from) / (to - from), 0.0, 1.0);
  return t * t * (3 - 2 * t);
}

/// Values between 0 and 1 that change over a length of 1, smoothly.
double cloud(const Vec3d& at) {
  constexpr double kFarthest = 1e12;  // Beyond, doubles have no place for fractions.
  if (!(at.cwiseAbs().maxCoeff() < kFarthest)) return 0.5;
  const Vec3d low = at.array().floor();
  const auto x = static_cast<std::int64_t>(low.x()), y = static_cast<std::int64_t>(low.y()),
             z = static_cast<std::int64_t>(low.z());
  const double u = step_between(0, 1, at.x() - low.x()), v = step_between(0, 1, at.y() - low.y()),
               w = step_between(0, 1, at.z() - low.z());
  const auto in_row = [&](std::int64_t j, std::int64_t k) {
    return (1 - u) * at_lattice(x, j, k) + u * at_lattice(x + 1, j, k);
  };
  const double front = (1 - v) * in_row(y, z) + v * in_row(y + 1, z),
               back = (1 - v) * in_row(y, z + 1) + v * in_row(y + 1, z + 1);
  return (1 - w) * front + w * back;
}

/// Clouds with finer ones in them.
double clouds(const Vec3d& at) { return 0.6 * cloud(at) + 0.4 * cloud(2.7 * at); }

}  // namespace

double blood_cover(const BloodPlace& at) {
  const double near = std::abs(at.distance) / at.reach;
  double cover = 0;
  if (near < 1) {
    // Clouds are mostly near one half.
    const double uneven = step_between(0.25, 0.75, clouds(at.rest / 0.9));
    const double border = kNarrowest + (kWidest - kNarrowest) * uneven * uneven;
    cover = 1 - step_between((1 - kSoftness) * border, border, near);
  }
  return std::max(cover, std::clamp(at.flow, 0.0, 1.0));
}

Vec3f bloodied(const Vec3f& color, const BloodPlace& at) {
  const double near = std::abs(at.distance) / at.reach;
  if (near >= 1 && !(at.flow > 0)) return color;
  Vec3f result = color;
  if (near < 1) {
    const auto share =
        kReddest * static_cast<float>((1 - near) * (1 - near) * (1 - near) * (1 - near));
    const Vec3f red = 0.35f * color + 0.25f * color.norm() * Vec3f(0.9f, 0.16f, 0.13f);
    result += share * (red - color);
  }
  const double clots = step_between(0.3, 0.7, clouds(at.rest / 0.6));
  const auto dark = static_cast<float>(0.75 * clots * (1 - 0.6 * std::min(near, 1.0)));
  const Vec3f blood = kFresh + dark * (kClotted - kFresh);
  // Blood is thinner farther away, and the surface shows through.
  const auto thickness = static_cast<float>(
      kLeastCover +
      (kMostCover - kLeastCover) * std::max(1 - std::min(near, 1.0), std::min(at.flow, 1.0)));
  return result + thickness * static_cast<float>(blood_cover(at)) * (blood - result);
}

}  // namespace sunder::tools
