#include "pipeline/validation/transfer/target_points.h"

#include <algorithm>
#include <array>
#include <numeric>
#include <tuple>

namespace sunder::validation {
namespace {

constexpr double kSameTargetWeights = 1e-6;

/// Splits the points of the weld where accepted matches disagree. @return the number of points.
Index part_points(const BindSurface& target, std::span<const SurfaceMatch> matches,
                  std::span<const WeightRow> rows, std::vector<Index>& point_of_vertex) {
  // The accepted vertices that stand for the points into which each point of the weld is split.
  std::vector<std::vector<Index>> representatives(target.weld.point_count);
  std::vector<std::vector<Index>> points(target.weld.point_count);
  Index count = 0;
  point_of_vertex.assign(target.positions.size(), kNone);
  for (Index v = 0; v < target.vertex_count(); ++v) {
    if (!matches[v].is_accepted) continue;
    auto& known = representatives[target.weld.point_of_vertex[v]];
    auto& numbers = points[target.weld.point_of_vertex[v]];
    std::size_t i = 0;
    while (i < known.size() && distance(rows[known[i]], rows[v]) > kSameTargetWeights) ++i;
    if (i == known.size()) {
      known.push_back(v);
      numbers.push_back(count++);
    }
    point_of_vertex[v] = numbers[i];
  }
  for (Index v = 0; v < target.vertex_count(); ++v) {
    if (point_of_vertex[v] != kNone) continue;
    auto& numbers = points[target.weld.point_of_vertex[v]];
    if (numbers.empty()) numbers.push_back(count++);
    point_of_vertex[v] = numbers[0];
  }
  return count;
}

/// Numbers points by place, then tear side, then number.
void sort_points(const BindSurface& target, TargetPoints& points, Index count) {
  points.first_vertex.assign(count, kNone);
  for (Index v = target.vertex_count(); v-- > 0;)
    points.first_vertex[points.point_of_vertex[v]] = v;
  std::vector<Index> old_from_new(count);
  std::iota(old_from_new.begin(), old_from_new.end(), 0u);
  const auto key = [&](Index point) {
    const Index v = points.first_vertex[point];
    const Vec3d& p = target.positions[v];
    return std::tuple(p.x(), p.y(), p.z(), target.tear_side[v], point);
  };
  std::ranges::sort(old_from_new, [&](Index a, Index b) { return key(a) < key(b); });
  std::vector<Index> new_from_old(count), first_vertex(count);
  for (Index i = 0; i < count; ++i) {
    new_from_old[old_from_new[i]] = i;
    first_vertex[i] = points.first_vertex[old_from_new[i]];
  }
  points.first_vertex = std::move(first_vertex);
  for (Index& point : points.point_of_vertex) point = new_from_old[point];
}

}  // namespace

TargetPoints make_points(const BindSurface& target, std::span<const SurfaceMatch> matches,
                         std::span<const WeightRow> rows) {
  TargetPoints points;
  const Index count = part_points(target, matches, rows, points.point_of_vertex);
  sort_points(target, points, count);
  for (const Index vertex : points.first_vertex)
    points.positions.push_back(target.positions[vertex]);
  for (Index t = 0; t < target.triangles.size(); ++t) {
    if (!target.has_area[t]) continue;
    Triangle triangle = target.triangles[t];
    for (Index& corner : triangle) corner = points.point_of_vertex[corner];
    points.triangles.push_back(triangle);
  }
  return points;
}

Parts find_parts(std::size_t elements, std::span<const Triangle> triangles) {
  std::vector<Index> root(elements);
  std::iota(root.begin(), root.end(), 0u);
  const auto find = [&](Index i) {
    while (root[i] != i) i = root[i] = root[root[i]];
    return i;
  };
  for (const Triangle& triangle : triangles)
    for (std::size_t k = 1; k < 3; ++k) {
      const Index a = find(triangle[0]), b = find(triangle[k]);
      root[std::max(a, b)] = std::min(a, b);
    }
  Parts parts;
  parts.of.resize(elements);
  for (Index i = 0; i < elements; ++i)
    parts.of[i] = find(i) == i ? parts.count++ : parts.of[find(i)];
  return parts;
}

}  // namespace sunder::validation
