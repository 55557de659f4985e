#include "tools/render/lip_blood.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "tools/blood/blood_look.h"

namespace sunder::tools {
namespace {

constexpr float kFarthest = 1;       ///< Where it ends, in reaches.
constexpr float kMostPieces = 4096;  ///< Of a lip.

std::uint64_t key_of(const std::array<std::int64_t, 3>& cell) {
  std::uint64_t key = 0;
  for (const std::int64_t i : cell)
    key = (key ^ static_cast<std::uint64_t>(i)) * 0x9e3779b97f4a7c15u;
  return key;  // Equal keys of two cells cost time alone.
}

float squared_distance(const LipBlood::Segment& segment, const Vec3f& place) {
  const Vec3f along = segment[1] - segment[0], offset = place - segment[0];
  const float length = along.squaredNorm();
  const float t = length > 0 ? std::clamp(along.dot(offset) / length, 0.0f, 1.0f) : 0.0f;
  return (offset - t * along).squaredNorm();
}

}  // namespace

LipBlood::LipBlood(std::span<const Segment> lips, float reach) : lips_(lips), reach_(reach) {
  if (!(reach > 0)) return;
  for (std::uint32_t i = 0; i < lips.size(); ++i) {
    // A long lip crosses few of the cells of its box: it is entered piece by piece.
    const Vec3f along = lips[i][1] - lips[i][0];
    const float pieces =
        std::clamp(std::ceil(along.norm() / (kFarthest * reach)), 1.0f, kMostPieces);
    for (float piece = 0; piece < pieces; ++piece)
      add(i, lips[i][0] + piece / pieces * along, lips[i][0] + (piece + 1) / pieces * along);
  }
}

void LipBlood::add(std::uint32_t lip, const Vec3f& begin, const Vec3f& end) {
  const Vec3f margin = Vec3f::Constant(kFarthest * reach_);
  const auto least = cell_of(begin.cwiseMin(end) - margin),
             greatest = cell_of(begin.cwiseMax(end) + margin);
  for (std::int64_t x = least[0]; x <= greatest[0]; ++x)
    for (std::int64_t y = least[1]; y <= greatest[1]; ++y)
      for (std::int64_t z = least[2]; z <= greatest[2]; ++z) {
        std::vector<std::uint32_t>& near = near_[key_of({x, y, z})];
        if (near.empty() || near.back() != lip) near.push_back(lip);
      }
}

std::array<std::int64_t, 3> LipBlood::cell_of(const Vec3f& place) const {
  std::array<std::int64_t, 3> cell;
  for (int i = 0; i < 3; ++i)
    cell[static_cast<std::size_t>(i)] =
        static_cast<std::int64_t>(std::floor(place[i] / (kFarthest * reach_)));
  return cell;
}

Vec3f LipBlood::bloodied(const Vec3f& color, const Vec3f& place, const Vec3f& rest) const {
  if (near_.empty()) return color;
  const auto lips = near_.find(key_of(cell_of(place)));
  if (lips == near_.end()) return color;
  float nearest = std::numeric_limits<float>::max();
  for (const std::uint32_t i : lips->second)
    nearest = std::min(nearest, squared_distance(lips_[i], place));
  return tools::bloodied(color, {static_cast<double>(std::sqrt(nearest)),
                                 static_cast<double>(reach_), 0, rest.cast<double>()});
}

}  // namespace sunder::tools
