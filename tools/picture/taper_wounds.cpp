#include "tools/picture/taper_wounds.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <map>
#include <queue>
#include <set>
#include <utility>

#include "tools/picture/unfold_skin.h"

namespace sunder::tools {
namespace {

constexpr double kTaper = 0.4;  ///< Of a wound's length, at each end.
constexpr int kRings = 5;       ///< Around lips, whose points follow them.
constexpr int kPasses = 24;     ///< Over these points.
constexpr double kFar = std::numeric_limits<double>::infinity();

/// Distances along lips from the nearest tip, where the two lips of a wound are one point.
class FromTips {
 public:
  FromTips(const CharacterInstance& instance, std::span<const Wound> wounds,
           const SurfacePoints& points) {
    for (const Wound& wound : wounds)
      for (const LipPair& pair : wound.lips)
        if (pair.left != pair.right) distances_[pair.left] = distances_[pair.right] = kFar;
    std::map<std::uint32_t, std::vector<std::uint32_t>> beside;
    for (const LipEdge& edge : instance.particles()->lips()) {
      beside[edge.points[0]].push_back(edge.points[1]);
      beside[edge.points[1]].push_back(edge.points[0]);
    }
    using Reached = std::pair<double, std::uint32_t>;
    std::priority_queue<Reached, std::vector<Reached>, std::greater<>> next;
    for (const auto& [point, others] : beside)
      if (!distances_.contains(point)) next.push({0.0, point});
    while (!next.empty()) {
      const auto [distance, point] = next.top();
      next.pop();
      double& known = distances_.try_emplace(point, kFar).first->second;
      if (known <= distance) continue;
      known = distance;
      for (const std::uint32_t other : beside.at(point))
        next.push({distance + points.distance(point, other), other});
    }
  }

  [[nodiscard]] double of(const LipPair& pair) const {
    return std::min(distances_.at(pair.left), distances_.at(pair.right));
  }

 private:
  std::map<std::uint32_t, double> distances_;
};

/// The length of a wound: half that of its lips.
double length_of(const CharacterInstance& instance, const Wound& wound,
                 const SurfacePoints& points) {
  std::set<std::uint32_t> of_wound;
  for (const LipPair& pair : wound.lips) of_wound.insert({pair.left, pair.right});
  double length = 0;
  for (const LipEdge& edge : instance.particles()->lips())
    if (of_wound.contains(edge.points[0]) || of_wound.contains(edge.points[1]))
      length += points.distance(edge.points[0], edge.points[1]) / 2;
  return length;
}

/// The share of its greatest width that a wound may have at a distance from one of its ends.
double taper(double from_end, double length) {
  const double t = 1 - std::min(1.0, from_end / (kTaper * length));
  return std::sqrt(std::max(0.0, 1 - t * t));
}

using Moves = std::map<std::uint32_t, Vec3f>;  ///< Of points.

/// Lets the points around those that are moved follow them, the more the shorter the edges between
/// them are.
void spread(const SurfacePoints& points, Moves& moves) {
  std::vector<std::uint32_t> ring, followers;
  for (const auto& [point, move] : moves) ring.push_back(point);
  for (int i = 0; i < kRings; ++i) {
    std::vector<std::uint32_t> next;
    for (const std::uint32_t point : ring)
      points.for_each_neighbour(point, [&](std::uint32_t other) {
        if (points.is_lip(other) || !moves.try_emplace(other, Vec3f::Zero()).second) return;
        next.push_back(other);
      });
    followers.insert(followers.end(), next.begin(), next.end());
    ring = std::move(next);
  }
  for (int pass = 0; pass < kPasses; ++pass)
    for (const std::uint32_t point : followers) {
      Vec3f sum = Vec3f::Zero();
      float weights = 0;
      points.for_each_weighted(point, [&](std::uint32_t other, float weight) {
        const auto found = moves.find(other);
        if (found != moves.end()) sum += weight * found->second;
        weights += weight;
      });
      if (weights > 0 && std::isfinite(weights)) moves[point] = sum / weights;
    }
}

}  // namespace

void taper_wounds(const CharacterInstance& instance, std::span<const Wound> wounds,
                  const std::vector<DeformedMesh>& closed, std::vector<DeformedMesh>& open) {
  const SurfacePoints at_rest(instance, closed);
  const std::vector<Vec3f> opened = places_of_points(instance, open);
  const auto width_at = [&opened](const LipPair& pair) {
    return static_cast<double>((opened[pair.left] - opened[pair.right]).norm());
  };
  const FromTips from_tips(instance, wounds, at_rest);
  Moves moves;
  for (const Wound& wound : wounds) {
    const double length = length_of(instance, wound, at_rest);
    double widest = 0;
    for (const LipPair& pair : wound.lips) widest = std::max(widest, width_at(pair));
    if (!(length > 0) || !(widest > 0)) continue;
    for (const LipPair& pair : wound.lips) {
      if (pair.left == pair.right) continue;
      const double width = width_at(pair), allowed = widest * taper(from_tips.of(pair), length);
      if (!(width > allowed)) continue;
      const Vec3f move = static_cast<float>((width - allowed) / (2 * width)) *
                         (opened[pair.right] - opened[pair.left]);
      moves[pair.left] = move;
      moves[pair.right] = -move;
    }
  }
  spread(at_rest, moves);
  for (std::uint32_t m = 0; m < open.size(); ++m) {
    const std::span<const std::uint32_t> points = instance.particles()->vertex_points(m);
    for (std::uint32_t v = 0; v < points.size(); ++v)
      if (const auto found = moves.find(points[v]); found != moves.end())
        open[m].positions[v] += found->second;
  }
  unfold_skin(instance, at_rest, closed, open);
}

}  // namespace sunder::tools
