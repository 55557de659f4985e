#include "tools/picture/unfold_skin.h"

#include <cmath>
#include <cstdint>
#include <set>
#include <vector>

namespace sunder::tools {
namespace {

/// A triangle counts as folded if its normal was turned by more than 78 degrees.
constexpr float kFoldedCosine = 0.2f;
/// In each round points of folded triangles become loose; after a round that did not help, lips
/// too, and after two in turn, the points around them.
constexpr int kMostRounds = 12;
constexpr int kLoosePasses = 16;

/// How the surface moved from one state to another, and where that folded it.
class Moved {
 public:
  Moved(const SurfacePoints& closed, const std::vector<Vec3f>& to) : closed_(closed) {
    const std::vector<Vec3f>& from = closed.places();
    for (std::size_t p = 0; p < from.size(); ++p) moves.push_back(to[p] - from[p]);
    for (const Triangle& triangle : closed.triangles())
      if (moves[triangle[0]] != Vec3f::Zero() || moves[triangle[1]] != Vec3f::Zero() ||
          moves[triangle[2]] != Vec3f::Zero())
        moved_.push_back(triangle);
  }

  /// Collects the triangles that are folded. @return their area when closed, doubled.
  [[nodiscard]] double find_folded(std::vector<Triangle>& folded) const {
    folded.clear();
    double area = 0;
    for (const Triangle& triangle : moved_) {
      const auto [a, b, c] = triangle;
      const Vec3f closed_ab = closed_.place(b) - closed_.place(a),
                  closed_ac = closed_.place(c) - closed_.place(a);
      const Vec3f before = closed_ab.cross(closed_ac),
                  after = (closed_ab + moves[b] - moves[a]).cross(closed_ac + moves[c] - moves[a]);
      if (!(before.dot(after) < kFoldedCosine * before.norm() * after.norm())) continue;
      folded.push_back(triangle);
      area += static_cast<double>(before.norm());
    }
    return area;
  }

  /// Moves a point by the mean of its neighbours.
  void follow_neighbours(std::uint32_t point) {
    Vec3f sum = Vec3f::Zero();
    float weights = 0;
    closed_.for_each_weighted(point, [&](std::uint32_t other, float weight) {
      sum += weight * moves[other];
      weights += weight;
    });
    if (weights > 0 && std::isfinite(weights)) moves[point] = sum / weights;
  }

  std::vector<Vec3f> moves;  ///< Per point.

 private:
  const SurfacePoints& closed_;
  std::vector<Triangle> moved_;
};

/// What unfolding changed.
struct Unfolded {
  std::vector<Vec3f> moves;        ///< Per point, since the lips were closed.
  std::set<std::uint32_t> mended;  ///< Points of triangles that were folded, and around them.
};

/// The corners of triangles, and all points that edges join to them if `with_ring`.
std::set<std::uint32_t> corners(const SurfacePoints& surface,
                                const std::vector<Triangle>& triangles, bool with_ring) {
  std::set<std::uint32_t> points;
  for (const Triangle& triangle : triangles)
    for (const std::uint32_t corner : triangle) {
      points.insert(corner);
      if (with_ring)
        surface.for_each_neighbour(corner, [&](std::uint32_t other) { points.insert(other); });
    }
  return points;
}

Unfolded unfolded(const SurfacePoints& closed, Moved moved) {
  std::vector<Triangle> folded;
  double least = moved.find_folded(folded);
  Unfolded best{moved.moves, {}};
  std::set<std::uint32_t> loose;
  int rounds_in_vain = 0;
  for (int round = 0; round < kMostRounds && !folded.empty(); ++round) {
    for (const std::uint32_t point : corners(closed, folded, rounds_in_vain > 1)) {
      best.mended.insert(point);
      if (!closed.is_lip(point) || rounds_in_vain > 0) loose.insert(point);
    }
    for (int pass = 0; pass < kLoosePasses; ++pass)
      for (const std::uint32_t point : loose) moved.follow_neighbours(point);
    const double area = moved.find_folded(folded);
    rounds_in_vain = area > least / 2 ? rounds_in_vain + 1 : 0;
    if (area >= least) continue;
    least = area;
    best.moves = moved.moves;
  }
  return best;
}

/// Where the surface faces at each point, by the areas of its triangles.
std::vector<Vec3f> facings(const std::vector<Triangle>& triangles,
                           const std::vector<Vec3f>& places) {
  std::vector<Vec3f> facings(places.size(), Vec3f::Zero());
  for (const auto& [a, b, c] : triangles) {
    const Vec3f doubled_area = (places[b] - places[a]).cross(places[c] - places[a]);
    for (const std::uint32_t point : {a, b, c}) facings[point] += doubled_area;
  }
  for (Vec3f& facing : facings) facing.normalize();
  return facings;
}

}  // namespace

void unfold_skin(const CharacterInstance& instance, const SurfacePoints& from,
                 const std::vector<DeformedMesh>& closed, std::vector<DeformedMesh>& open) {
  const std::vector<Vec3f> to = places_of_points(instance, open);
  const auto [moves, mended] = unfolded(from, Moved(from, to));
  if (mended.empty()) return;
  std::vector<Vec3f> places = from.places();
  for (std::size_t p = 0; p < places.size(); ++p) places[p] += moves[p];
  const std::vector<Vec3f> faced = facings(from.triangles(), from.places()),
                           facing = facings(from.triangles(), places);
  for (std::uint32_t m = 0; m < open.size(); ++m) {
    const std::span<const std::uint32_t> points = instance.particles()->vertex_points(m);
    for (std::uint32_t v = 0; v < points.size(); ++v) {
      const std::uint32_t point = points[v];
      if (!mended.contains(point)) continue;
      open[m].positions[v] += places[point] - to[point];
      if (open[m].normals.empty() || closed[m].normals.empty()) continue;
      const Vec3f normal = closed[m].normals[v] + facing[point] - faced[point];
      if (normal.norm() > 0.0f) open[m].normals[v] = normal.normalized();
    }
  }
}

}  // namespace sunder::tools
