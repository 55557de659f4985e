#include "tools/pull_open.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <queue>
#include <utility>

namespace sunder::tools {
namespace {

using Index = std::uint32_t;

bool contains(const std::vector<Index>& values, Index value) {
  return std::find(values.begin(), values.end(), value) != values.end();
}

}  // namespace

PullOpen::PullOpen(const TornModel& model, const ChangeRecord& change, const std::vector<DeformedMesh>& posed, double reach) {
  number_vertices(model);
  chain_pairs(change, posed);
  spread(posed, reach);
}

void PullOpen::number_vertices(const TornModel& model) {
  const Character& character = model.character();
  vertex_of_point_.resize(model.point_count(), {kNone, kNone});
  neighbours_.resize(model.point_count());
  for (Index mesh = 0; mesh < character.meshes.size(); ++mesh) {
    std::vector<Index>& points = point_of_vertex_.emplace_back(character.meshes[mesh].vertex_count(), kNone);
    const auto& triangles = character.meshes[mesh].triangles;
    for (Index t = 0; t < triangles.size(); ++t)
      for (Index corner = 0; corner < 3; ++corner) {
        const Index point = model.point_at(mesh, t, corner), next = model.point_at(mesh, t, (corner + 1) % 3);
        points[triangles[t][corner]] = point;
        vertex_of_point_[point] = {mesh, triangles[t][corner]};
        neighbours_[point].push_back(next);
        neighbours_[next].push_back(point);
      }
  }
}

Vec3d PullOpen::position(Index point, const std::vector<DeformedMesh>& posed) const {
  const LipVertex at = vertex_of_point_[point];
  return posed[at.mesh].positions[at.vertex].cast<double>();
}

Vec3d PullOpen::normal(Index point, const std::vector<DeformedMesh>& posed) const {
  const LipVertex at = vertex_of_point_[point];
  return posed[at.mesh].normals[at.vertex].cast<double>();
}

Vec3d PullOpen::middle_of_neighbours(Index point, const std::vector<DeformedMesh>& posed) const {
  Vec3d sum = Vec3d::Zero();
  for (const Index next : neighbours_[point]) sum += position(next, posed);
  return sum / static_cast<double>(neighbours_[point].size());
}

void PullOpen::chain_pairs(const ChangeRecord& change, const std::vector<DeformedMesh>& posed) {
  std::size_t first = 0;
  while (first < change.lips.size()) {
    // One run of torn surface: neighbours in the list that are neighbours on the surface.
    std::size_t end = first + 1;
    while (end < change.lips.size() && contains(neighbours_[change.lips[end - 1].left], change.lips[end].left)) ++end;
    std::vector<double> along = {0};
    Lip left, right;
    for (std::size_t i = first; i < end; ++i) {
      left.push_back(vertex_of_point_[change.lips[i].left]);
      right.push_back(vertex_of_point_[change.lips[i].right]);
      if (i > first)
        along.push_back(along.back() + (position(change.lips[i].left, posed) - position(change.lips[i - 1].left, posed)).norm());
    }
    const double mean_step = along.back() / static_cast<double>(along.size());
    for (std::size_t i = first; i < end; ++i) {
      const auto self = static_cast<Index>(i);
      // The tips lie about one step beyond the outermost pairs.
      const double t = (along[i - first] + mean_step) / (along.back() + 2 * mean_step);
      pairs_.push_back({change.lips[i].left, change.lips[i].right, i > first ? self - 1 : self, i + 1 < end ? self + 1 : self,
                        along.back() > 0 ? std::sqrt(std::max(0.0, 4 * t * (1 - t))) : 1.0});
    }
    lips_.push_back(std::move(left));
    lips_.push_back(std::move(right));
    first = end;
  }
}

void PullOpen::spread(const std::vector<DeformedMesh>& posed, double reach) {
  pulls_.resize(vertex_of_point_.size());
  for (std::size_t side = 0; side < kSides; ++side) {
    // Dijkstra from all points of one lip at once; ties go to the smaller point, so that the result does not depend on the heap.
    using Entry = std::pair<double, Index>;
    std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
    std::vector<double> distance(vertex_of_point_.size(), 1e300);
    for (Index pair = 0; pair < pairs_.size(); ++pair) {
      const Index point = side == 0 ? pairs_[pair].left : pairs_[pair].right;
      distance[point] = 0;
      pulls_[point][side].pair = pair;
      queue.emplace(0.0, point);
    }
    while (!queue.empty()) {
      const auto [at, point] = queue.top();
      queue.pop();
      if (at > distance[point]) continue;
      const double fade = 1 - (at / reach) * (at / reach);
      pulls_[point][side].strength = fade * fade;
      for (const Index next : neighbours_[point]) {
        const double further = at + (position(next, posed) - position(point, posed)).norm();
        if (further >= reach || further >= distance[next]) continue;
        distance[next] = further;
        pulls_[next][side].pair = pulls_[point][side].pair;
        queue.emplace(further, next);
      }
    }
  }
}

void PullOpen::apply(double amount, std::vector<DeformedMesh>& posed) const {
  // Of each pair, to the left: perpendicular to the tear and to the surface's normal. Which way that is the flesh beside the lips
  // knows, also where a file's normals point inwards.
  std::vector<Vec3d> to_left(pairs_.size());
  double agreement = 0;
  for (std::size_t i = 0; i < pairs_.size(); ++i) {
    const Pair& pair = pairs_[i];
    const Vec3d along = position(pairs_[pair.after].left, posed) - position(pairs_[pair.before].left, posed);
    const Vec3d outwards = normal(pair.left, posed) + normal(pair.right, posed);
    const Vec3d left = outwards.cross(along);
    to_left[i] = left.norm() > 0 ? Vec3d(pair.share * amount * left.normalized()) : Vec3d(Vec3d::Zero());
    agreement += to_left[i].dot(middle_of_neighbours(pair.left, posed) - middle_of_neighbours(pair.right, posed));
  }
  if (agreement < 0)
    for (Vec3d& direction : to_left) direction = -direction;

  std::vector<Vec3d> moves(vertex_of_point_.size(), Vec3d::Zero());
  std::vector<Index> moved;
  for (Index point = 0; point < moves.size(); ++point) {
    const auto& [left, right] = pulls_[point];
    if (left.pair == kNone && right.pair == kNone) continue;
    if (left.pair != kNone) moves[point] += left.strength * to_left[left.pair];
    if (right.pair != kNone) moves[point] -= right.strength * to_left[right.pair];
    moved.push_back(point);
  }
  // Neighbours may follow different pairs: even out what that leaves, but for the lips themselves.
  std::vector<bool> is_lip(moves.size(), false);
  for (const Pair& pair : pairs_) is_lip[pair.left] = is_lip[pair.right] = true;
  for (int round = 0; round < 8; ++round) {
    std::vector<Vec3d> even;
    for (const Index point : moved) {
      Vec3d sum = moves[point];
      for (const Index next : neighbours_[point]) sum += moves[next];
      even.push_back(is_lip[point] ? moves[point] : Vec3d(sum / (1.0 + static_cast<double>(neighbours_[point].size()))));
    }
    for (std::size_t i = 0; i < moved.size(); ++i) moves[moved[i]] = even[i];
  }
  for (std::size_t mesh = 0; mesh < posed.size(); ++mesh)
    for (std::size_t v = 0; v < posed[mesh].positions.size(); ++v)
      if (const Index point = point_of_vertex_[mesh][v]; point != kNone) posed[mesh].positions[v] += moves[point].cast<float>();
}

}  // namespace sunder::tools
