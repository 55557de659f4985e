#include "tear/section/flat_section.h"

#include "tear/section/constrained_delaunay.h"
#include "tear/section/exact_predicates.h"
#include "tear/section/graded_points.h"

namespace sunder::tear {
namespace {

/// The points of the loops of a region, consecutive, and the ends of its loops.
struct SectionRim {
  explicit SectionRim(std::pmr::memory_resource& memory) : points(&memory), ends(&memory) {}

  /// @return false if a loop is not a polygon or not in range.
  [[nodiscard]] bool append(const FlatLoop& loop) {
    if (loop.size() < 3) return false;
    for (const Vec2d& p : loop) {
      const auto point = exact_range(p);
      if (!point) return false;
      points.push_back(*point);
    }
    ends.push_back(static_cast<Index>(points.size()));
    return true;
  }

  /// Calls visit(a, b) for each edge, until it returns false. @return whether it never did.
  template <class Visit>
  bool for_each_edge(Visit visit) const {
    Index first = 0;
    for (const Index end : ends) {
      for (Index i = first; i < end; ++i)
        if (!visit(i, i + 1 == end ? first : i + 1)) return false;
      first = end;
    }
    return true;
  }

  std::pmr::vector<Vec2d> points;
  std::pmr::vector<Index> ends;
};

/// Collects the triangles inside.
void collect_inside(const ConstrainedDelaunay& triangulation, std::size_t count, FlatMesh& mesh,
                    std::pmr::memory_resource& memory) {
  mesh.triangles.reserve(count);
  mesh.twins.reserve(3 * count);
  std::pmr::vector<Index> number_of(triangulation.triangle_count(), kNone, &memory);
  for (Index t = 0; t < number_of.size(); ++t) {
    if (!triangulation.is_inside(t)) continue;
    number_of[t] = static_cast<Index>(mesh.triangles.size());
    mesh.triangles.push_back(triangulation.corners(t));
  }
  for (Index t = 0; t < number_of.size(); ++t) {
    if (number_of[t] == kNone) continue;
    for (Index h = 3 * t; h < 3 * t + 3; ++h) {
      const Index twin = triangulation.twin(h), other = number_of[twin / 3];
      mesh.twins.push_back(other == kNone ? kNone : 3 * other + twin % 3);
    }
  }
}

}  // namespace

std::optional<FlatMesh> triangulate(std::span<const FlatLoop> loops, const FlatRegion& region,
                                    InnerPoints inner, std::pmr::memory_resource& memory) {
  SectionRim rim(memory);
  std::size_t count = 0;
  if (region.outline >= loops.size()) return std::nullopt;
  for (const Index hole : region.holes) {
    if (hole >= loops.size()) return std::nullopt;
    count += loops[hole].size();
  }
  rim.points.reserve(loops[region.outline].size() + count);
  if (!rim.append(loops[region.outline])) return std::nullopt;
  for (const Index hole : region.holes)
    if (!rim.append(loops[hole])) return std::nullopt;

  const std::size_t spare =
      inner == InnerPoints::graded ? most_graded_points(rim.points.size()) : 0;
  std::optional<FlatMesh> mesh(memory);
  auto triangulation = ConstrainedDelaunay::of(rim.points, spare, memory);
  if (!triangulation) return std::nullopt;
  if (!rim.for_each_edge([&](Index a, Index b) { return triangulation->fix_edge(a, b); }))
    return std::nullopt;
  if (!triangulation->find_inside()) return std::nullopt;
  if (inner == InnerPoints::graded) add_graded_points(rim.ends, *triangulation, memory);
  const auto inner_points = triangulation->points().subspan(rim.points.size());
  mesh->inner.assign(inner_points.begin(), inner_points.end());
  collect_inside(*triangulation,
                 rim.points.size() + 2 * region.holes.size() + 2 * inner_points.size(), *mesh,
                 memory);
  return mesh;
}

}  // namespace sunder::tear
