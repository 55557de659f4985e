#include "tools/render/triangle_tree.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numeric>
#include <utility>

namespace sunder::tools {
namespace {

constexpr std::size_t kLeafSize = 4;
constexpr std::size_t kMostOpen = 96;  ///< Nodes that wait; halves make a tree this deep at most.

/// Where a ray enters a box; beyond `farthest` if it does not.
float entry(const Vec3f& least, const Vec3f& greatest, const Vec3f& from, const Vec3f& inverse,
            float farthest) {
  float enter = 0, leave = farthest;
  for (int i = 0; i < 3; ++i) {
    const float a = (least[i] - from[i]) * inverse[i], b = (greatest[i] - from[i]) * inverse[i];
    enter = std::max(enter, std::min(a, b));
    leave = std::min(leave, std::max(a, b));
  }
  return enter <= leave ? enter : std::numeric_limits<float>::max();
}

/// The distance of a triangle on a ray [moller1997fast]; negative if it is not met.
float meet(const TriangleTree::Corners& triangle, const Vec3f& from, const Vec3f& along) {
  const Vec3f ab = triangle[1] - triangle[0], ac = triangle[2] - triangle[0];
  const Vec3f p = along.cross(ac);
  const float determinant = ab.dot(p);
  if (determinant == 0.0f) return -1;
  const Vec3f offset = from - triangle[0];
  const float u = offset.dot(p) / determinant;
  if (!(u >= 0.0f && u <= 1.0f)) return -1;
  const Vec3f q = offset.cross(ab);
  const float v = along.dot(q) / determinant;
  if (!(v >= 0.0f && u + v <= 1.0f)) return -1;
  return ac.dot(q) / determinant;
}

}  // namespace

TriangleTree::TriangleTree(std::span<const Corners> triangles) : given_(triangles.size()) {
  std::iota(given_.begin(), given_.end(), Index{0});
  if (triangles.empty()) return;
  std::vector<Vec3f> middles;
  middles.reserve(triangles.size());
  for (const Corners& t : triangles) middles.emplace_back((t[0] + t[1] + t[2]) / 3);
  nodes_.reserve(triangles.size());
  build(triangles, given_, middles);
  triangles_.reserve(triangles.size());
  for (const Index given : given_) triangles_.push_back(triangles[given]);
}

void TriangleTree::build(std::span<const Corners> triangles, std::span<Index> part,
                         std::span<const Vec3f> middles) {
  const std::size_t at = nodes_.size();
  Node node;
  node.least = node.greatest = triangles[part[0]][0];
  Vec3f low = middles[part[0]], high = low;
  for (const Index t : part) {
    for (const Vec3f& corner : triangles[t]) {
      node.least = node.least.cwiseMin(corner);
      node.greatest = node.greatest.cwiseMax(corner);
    }
    low = low.cwiseMin(middles[t]);
    high = high.cwiseMax(middles[t]);
  }
  nodes_.push_back(node);
  if (part.size() <= kLeafSize) {
    nodes_[at].first = static_cast<Index>(part.data() - given_.data());
    nodes_[at].count = static_cast<Index>(part.size());
    return;
  }
  Eigen::Index axis = 0;
  (high - low).maxCoeff(&axis);
  const std::size_t half = part.size() / 2;
  std::nth_element(
      part.begin(), part.begin() + static_cast<std::ptrdiff_t>(half), part.end(),
      [&](Index a, Index b) {
        return middles[a][axis] != middles[b][axis] ? middles[a][axis] < middles[b][axis] : a < b;
      });
  build(triangles, part.first(half), middles);
  nodes_[at].first = static_cast<Index>(nodes_.size());
  build(triangles, part.subspan(half), middles);
}

template <bool kAny>
TriangleTree::Hit TriangleTree::search(const Vec3f& from, const Vec3f& along,
                                       float farthest) const {
  Hit best{kNone, farthest};
  if (nodes_.empty()) return best;
  const Vec3f inverse = along.cwiseInverse();
  const auto enter = [&](Index at) {
    return entry(nodes_[at].least, nodes_[at].greatest, from, inverse, best.distance);
  };
  struct Waiting {
    Index node;
    float distance;
  };
  std::array<Waiting, kMostOpen> open;
  std::size_t count = 0;
  open[count++] = {0, enter(0)};
  while (count > 0) {
    const Waiting next = open[--count];
    if (next.distance > best.distance) continue;
    const Node& node = nodes_[next.node];
    if (node.count == 0) {
      Waiting near{next.node + 1, enter(next.node + 1)}, far{node.first, enter(node.first)};
      if (far.distance < near.distance) std::swap(near, far);
      if (far.distance <= best.distance) open[count++] = far;
      if (near.distance <= best.distance) open[count++] = near;
      continue;
    }
    for (Index t = node.first; t < node.first + node.count; ++t) {
      const float distance = meet(triangles_[t], from, along);
      if (!(distance > 0.0f && distance < best.distance)) continue;
      best = {given_[t], distance};
      if constexpr (kAny) return best;
    }
  }
  return best;
}

TriangleTree::Hit TriangleTree::first_hit(const Vec3f& from, const Vec3f& along,
                                          float farthest) const {
  return search<false>(from, along, farthest);
}

bool TriangleTree::is_blocked(const Vec3f& from, const Vec3f& along, float farthest) const {
  return search<true>(from, along, farthest).triangle != kNone;
}

}  // namespace sunder::tools
