#include "tools/pull_open.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <queue>
#include <utility>

namespace sunder::tools {
namespace {

using Index = std::uint32_t;

bool contains(const std::vector<Index>& values, Index value) {
  return std::find(values.begin(), values.end(), value) != values.end();
}

Vec3d position_of(const PointMap& map, Index point, const std::vector<DeformedMesh>& posed) {
  const PointMap::AnyVertex at = map.vertex_of_point[point];
  return posed[at.mesh].positions[at.vertex].cast<double>();
}

}  // namespace

PointMap::PointMap(const TornModel& model) {
  const Character& character = model.character();
  vertex_of_point.resize(model.point_count());
  neighbours.resize(model.point_count());
  for (Index mesh = 0; mesh < character.meshes.size(); ++mesh) {
    std::vector<Index>& points = point_of_vertex.emplace_back(character.meshes[mesh].vertex_count(), kNone);
    const auto& triangles = character.meshes[mesh].triangles;
    for (Index t = 0; t < triangles.size(); ++t)
      for (Index corner = 0; corner < 3 && !is_retired(triangles[t]); ++corner) {
        const Index point = model.point_at(mesh, t, corner), next = model.point_at(mesh, t, (corner + 1) % 3);
        points[triangles[t][corner]] = point;
        vertex_of_point[point] = {mesh, triangles[t][corner]};
        neighbours[point].push_back(next);
        neighbours[next].push_back(point);
      }
  }
}

std::vector<Index> PointMap::neighbours_to_follow(Index point) const {
  const std::vector<Index>& all = neighbours[point];
  std::vector<Index> along_border;
  for (const Index next : all)
    if (std::count(all.begin(), all.end(), next) == 1) along_border.push_back(next);
  return along_border.empty() ? all : along_border;
}

std::vector<PulledPair> chain_lips(const TornModel& model, const ChangeRecord& change, const std::vector<DeformedMesh>& posed) {
  const PointMap map(model);
  const auto& lips = change.lips;
  const auto are_neighbours = [&](std::size_t a, std::size_t b) { return contains(map.neighbours[lips[a].left], lips[b].left); };
  const auto meets_tip = [&](std::size_t i) {
    return std::ranges::any_of(map.neighbours[lips[i].left],
                               [&](Index point) { return contains(map.neighbours[lips[i].right], point); });
  };
  std::vector<PulledPair> pairs;
  for (std::size_t first = 0, end = 0; first < lips.size(); first = end) {
    // One run of torn surface: neighbours in the list that are neighbours on the surface.
    std::vector<double> along = {0};
    for (end = first + 1; end < lips.size() && are_neighbours(end - 1, end); ++end)
      along.push_back(along.back() +
                      (position_of(map, lips[end].left, posed) - position_of(map, lips[end - 1].left, posed)).norm());
    const bool is_closed = end - first > 2 && are_neighbours(end - 1, first);
    const bool has_first_tip = !is_closed && meets_tip(first), has_last_tip = !is_closed && meets_tip(end - 1);
    const double mean_step = along.back() / static_cast<double>(along.size());
    for (std::size_t i = first; i < end; ++i) {
      // The tips lie about one step beyond the outermost pairs; a tear without one ends like the middle of one with two.
      const double from_first = has_first_tip ? along[i - first] + mean_step : along.back() + mean_step;
      const double from_last = has_last_tip ? along.back() - along[i - first] + mean_step : along.back() + mean_step;
      const double sum = from_first + from_last;
      const std::size_t before = i > first ? i - 1 : is_closed ? end - 1 : i, after = i + 1 < end ? i + 1 : is_closed ? first : i;
      pairs.push_back({lips[i].left, lips[i].right, lips[before].left, lips[after].left,
                       is_closed || !(along.back() > 0) ? 1.0 : std::sqrt(4 * from_first * from_last / (sum * sum))});
    }
  }
  return pairs;
}

PullOpen::PullOpen(const TornModel& model, const std::vector<PulledPair>& pairs, const std::vector<DeformedMesh>& posed,
                   double reach)
    : map_(model) {
  const auto is_there = [&](Index point) { return point < map_.neighbours.size() && !map_.neighbours[point].empty(); };
  std::copy_if(pairs.begin(), pairs.end(), std::back_inserter(pairs_), [&](const PulledPair& pair) {
    return is_there(pair.left) && is_there(pair.right) && is_there(pair.before) && is_there(pair.after);
  });
  spread(posed, reach);
}

Vec3d PullOpen::position(Index point, const std::vector<DeformedMesh>& posed) const { return position_of(map_, point, posed); }

Vec3d PullOpen::normal(Index point, const std::vector<DeformedMesh>& posed) const {
  const PointMap::AnyVertex at = map_.vertex_of_point[point];
  return posed[at.mesh].normals[at.vertex].cast<double>();
}

Vec3d PullOpen::middle_of_neighbours(Index point, const std::vector<DeformedMesh>& posed) const {
  Vec3d sum = Vec3d::Zero();
  for (const Index next : map_.neighbours[point]) sum += position(next, posed);
  return sum / static_cast<double>(map_.neighbours[point].size());
}

void PullOpen::spread(const std::vector<DeformedMesh>& posed, double reach) {
  pulls_.resize(map_.vertex_of_point.size());
  for (std::size_t side = 0; side < kSides; ++side) {
    // Dijkstra from all points of one lip at once; ties go to the smaller point, so that the result does not depend on the heap.
    using Entry = std::pair<double, Index>;
    std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
    std::vector<double> distance(map_.vertex_of_point.size(), 1e300);
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
      for (const Index next : map_.neighbours[point]) {
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
    const PulledPair& pair = pairs_[i];
    const Vec3d along = position(pair.after, posed) - position(pair.before, posed);
    const Vec3d outwards = normal(pair.left, posed) + normal(pair.right, posed);
    const Vec3d left = outwards.cross(along);
    to_left[i] = left.norm() > 0 ? Vec3d(pair.share * amount * left.normalized()) : Vec3d(Vec3d::Zero());
    agreement += to_left[i].dot(middle_of_neighbours(pair.left, posed) - middle_of_neighbours(pair.right, posed));
  }
  if (agreement < 0)
    for (Vec3d& direction : to_left) direction = -direction;

  std::vector<Vec3d> moves(map_.vertex_of_point.size(), Vec3d::Zero());
  std::vector<Index> moved;
  for (Index point = 0; point < moves.size(); ++point) {
    const auto& [left, right] = pulls_[point];
    if (left.pair == kNone && right.pair == kNone) continue;
    if (left.pair != kNone) moves[point] += left.strength * to_left[left.pair];
    if (right.pair != kNone) moves[point] -= right.strength * to_left[right.pair];
    moved.push_back(point);
  }
  // Neighbours may follow different pairs: even out what that leaves, but for the lips themselves. What later operations put
  // between two points of a lip stays between them.
  std::vector<bool> is_lip(moves.size(), false);
  for (const PulledPair& pair : pairs_) is_lip[pair.left] = is_lip[pair.right] = true;
  std::vector<std::vector<Index>> around;
  for (const Index point : moved) around.push_back(is_lip[point] ? std::vector<Index>() : map_.neighbours_to_follow(point));
  for (int round = 0; round < 8; ++round) {
    std::vector<Vec3d> even;
    for (std::size_t i = 0; i < moved.size(); ++i) {
      Vec3d sum = moves[moved[i]];
      for (const Index next : around[i]) sum += moves[next];
      even.push_back(sum / (1.0 + static_cast<double>(around[i].size())));
    }
    for (std::size_t i = 0; i < moved.size(); ++i) moves[moved[i]] = even[i];
  }
  for (std::size_t mesh = 0; mesh < posed.size(); ++mesh)
    for (std::size_t v = 0; v < posed[mesh].positions.size(); ++v)
      if (const Index point = map_.point_of_vertex[mesh][v]; point != kNone) posed[mesh].positions[v] += moves[point].cast<float>();
}

}  // namespace sunder::tools
