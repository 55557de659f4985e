#include "tear/section/flat_section.h"

#include <algorithm>
#include <cmath>

#include "tear/section/constrained_delaunay.h"
#include "tear/section/exact_predicates.h"
#include "tear/section/inner_points.h"

namespace sunder::tear {
namespace {

/// The points of the loops of a region, consecutive, and the edges between them.
struct Rim {
  std::vector<Vec2d> points;
  std::vector<std::array<Index, 2>> edges;
  double area = 0;  ///< Approximate area of the outline minus the holes.
};

double signed_area(const FlatLoop& loop) {
  double twice = 0;
  for (std::size_t i = 0; i < loop.size(); ++i) {
    const Vec2d a = loop[i] - loop[0], b = loop[(i + 1) % loop.size()] - loop[0];
    twice += a.x() * b.y() - a.y() * b.x();
  }
  return 0.5 * twice;
}

/// @return false if a loop is not a polygon or not in range.
bool append_loop(const FlatLoop& loop, Rim& rim) {
  if (loop.size() < 3) return false;
  const auto first = static_cast<Index>(rim.points.size());
  const auto count = static_cast<Index>(loop.size());
  for (Index i = 0; i < count; ++i) {
    const auto point = exact_range(loop[i]);
    if (!point) return false;
    rim.points.push_back(*point);
    rim.edges.push_back({first + i, first + (i + 1) % count});
  }
  return true;
}

std::optional<FlatMesh> triangulate_with(const Rim& rim, const std::vector<Vec2d>& inner) {
  std::vector<Vec2d> points = rim.points;
  points.insert(points.end(), inner.begin(), inner.end());
  auto triangulation = ConstrainedDelaunay::of(points);
  if (!triangulation) return std::nullopt;
  for (const auto& edge : rim.edges)
    if (!triangulation->fix_edge(edge[0], edge[1])) return std::nullopt;
  FlatMesh mesh;
  mesh.triangles = std::move(*triangulation).inside();
  if (mesh.triangles.empty()) return std::nullopt;

  // Inner points that are outside because of rounding are in no triangle.
  std::vector<Index> number(points.size(), kNone);
  const auto rim_count = static_cast<Index>(rim.points.size());
  for (const auto& triangle : mesh.triangles)
    for (const Index p : triangle) number[p] = p;
  for (Index p = rim_count; p < points.size(); ++p) {
    if (number[p] == kNone) continue;
    number[p] = rim_count + static_cast<Index>(mesh.inner.size());
    mesh.inner.push_back(points[p]);
  }
  for (auto& triangle : mesh.triangles)
    for (Index& p : triangle) p = number[p];
  return mesh;
}

}  // namespace

std::optional<FlatMesh> triangulate(std::span<const FlatLoop> loops, const FlatRegion& region,
                                    double spacing) {
  Rim rim;
  if (region.outline >= loops.size() || !append_loop(loops[region.outline], rim))
    return std::nullopt;
  rim.area = std::abs(signed_area(loops[region.outline]));
  for (const Index hole : region.holes) {
    if (hole >= loops.size() || !append_loop(loops[hole], rim)) return std::nullopt;
    rim.area -= std::abs(signed_area(loops[hole]));
  }
  std::vector<Vec2d> inner;
  if (spacing > 0 && std::isfinite(spacing))
    inner =
        place_inner_points(rim.points, rim.edges, rim.area, spacing, 4 * rim.points.size() + 64);
  auto mesh = triangulate_with(rim, inner);
  if (mesh || inner.empty()) return mesh;
  return triangulate_with(
      rim,
      {});  // inner points so close that rounding made some coincide with others or with the rim
}

}  // namespace sunder::tear
