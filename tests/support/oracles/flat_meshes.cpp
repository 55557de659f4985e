#include "support/oracles/flat_meshes.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>

#include <gtest/gtest.h>

#include "support/models/flat_loops.h"
#include "tear/section/exact_predicates.h"

namespace sunder::test {

using tear::FlatLoop;
using tear::FlatMesh;
using tear::FlatRegion;
using tear::in_circle;
using tear::orientation;

std::vector<Vec2d> all_points(std::span<const FlatLoop> loops, const FlatRegion& region,
                              const FlatMesh& mesh) {
  std::vector<Vec2d> points(loops[region.outline].begin(), loops[region.outline].end());
  for (const Index hole : region.holes)
    points.insert(points.end(), loops[hole].begin(), loops[hole].end());
  points.insert(points.end(), mesh.inner.begin(), mesh.inner.end());
  return points;
}

Index rim_count(std::span<const FlatLoop> loops, const FlatRegion& region) {
  std::size_t count = loops[region.outline].size();
  for (const Index hole : region.holes) count += loops[hole].size();
  return static_cast<Index>(count);
}

void expect_constrained_delaunay(std::span<const FlatLoop> loops, const FlatRegion& region,
                                 const FlatMesh& mesh) {
  const std::vector<Vec2d> points = all_points(loops, region, mesh);
  const Index rim = rim_count(loops, region);
  std::map<std::pair<Index, Index>, Index> apex;  // of half-edges
  double area = 0, scale = 0;
  std::vector<char> is_used(points.size(), 0);
  for (const auto& t : mesh.triangles) {
    for (const Index p : t) {
      ASSERT_LT(p, points.size());
      is_used[p] = 1;
    }
    ASSERT_EQ(orientation(points[t[0]], points[t[1]], points[t[2]]), 1);
    area += 0.5 * ((points[t[1]] - points[t[0]]).x() * (points[t[2]] - points[t[0]]).y() -
                   (points[t[1]] - points[t[0]]).y() * (points[t[2]] - points[t[0]]).x());
    for (std::size_t i = 0; i < 3; ++i)
      ASSERT_TRUE(apex.emplace(std::pair{t[i], t[(i + 1) % 3]}, t[(i + 2) % 3]).second)
          << "an edge with two faces on one side";
  }
  ASSERT_EQ(std::count(is_used.begin(), is_used.end(), 1),
            static_cast<std::ptrdiff_t>(points.size()));
  ASSERT_EQ(mesh.twins.size(), 3 * mesh.triangles.size());
  for (Index edge = 0; edge < mesh.twins.size(); ++edge) {
    const auto begin_of = [&](Index e) { return mesh.triangles[e / 3][e % 3]; };
    const auto end_of = [&](Index e) { return mesh.triangles[e / 3][(e + 1) % 3]; };
    const Index twin = mesh.twins[edge];
    ASSERT_EQ(twin == kNone, apex.count({end_of(edge), begin_of(edge)}) == 0);
    if (twin == kNone) continue;
    ASSERT_EQ(begin_of(twin), end_of(edge));
    ASSERT_EQ(end_of(twin), begin_of(edge));
  }

  double expected_area = 0;
  std::set<std::pair<Index, Index>> loop_edges;
  Index first = 0;
  std::vector<Index> members{region.outline};
  members.insert(members.end(), region.holes.begin(), region.holes.end());
  for (const Index l : members) {
    const auto count = static_cast<Index>(loops[l].size());
    expected_area += (l == region.outline ? 1 : -1) * std::abs(area_of(loops[l]));
    for (Index i = 0; i < count; ++i) {
      const Index a = first + i, b = first + (i + 1) % count;
      ASSERT_EQ(apex.count({a, b}) + apex.count({b, a}), 1u);
      loop_edges.insert({a, b});
      loop_edges.insert({b, a});
      scale = std::max(scale, (points[a] - points[0]).squaredNorm());
    }
    first += count;
  }
  ASSERT_NEAR(area, expected_area, 1e-12 * scale);
  for (const auto& [edge, tip] : apex) {
    if (loop_edges.count(edge) != 0) continue;
    const auto other = apex.find({edge.second, edge.first});
    ASSERT_NE(other, apex.end()) << "an inner edge with one face";
    ASSERT_LE(
        in_circle(points[edge.first], points[edge.second], points[tip], points[other->second]), 0);
  }
  ASSERT_EQ(mesh.triangles.size(),
            rim + 2 * region.holes.size() + 2 * mesh.inner.size() - 2);  // Euler's formula
}

void expect_inner_points_in_place(std::span<const FlatLoop> loops, const FlatRegion& region,
                                  const FlatMesh& mesh) {
  const std::vector<Vec2d> points = all_points(loops, region, mesh);
  const Index rim = rim_count(loops, region);
  ASSERT_LE(mesh.inner.size(), 2 * rim + 64);
  double least = std::numeric_limits<double>::infinity();
  std::vector<Index> members{region.outline};
  members.insert(members.end(), region.holes.begin(), region.holes.end());
  for (const Index l : members)
    for (std::size_t i = 0; i < loops[l].size(); ++i)
      least = std::min(least, (loops[l][i] - loops[l][(i + 1) % loops[l].size()]).norm());
  for (const auto& t : mesh.triangles)
    for (std::size_t k = 0; k < 3; ++k)
      if (std::max(t[k], t[(k + 1) % 3]) >= rim) {
        ASSERT_GT((points[t[k]] - points[t[(k + 1) % 3]]).norm(), 0.4 * least);
      }
}

}  // namespace sunder::test
