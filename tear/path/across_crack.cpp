#include "tear/path/across_crack.h"

#include <algorithm>
#include <optional>

#include "core/internal/ordered.h"
#include "tear/geometry/tolerances.h"
#include "tear/internal/surface.h"

namespace sunder::tear {
namespace {

/// A part of an edge of the source, by fractions from its begin.
struct SourceEdgePart {
  Index half_edge = kNone;
  double begin = 0, end = 1;
};

/// The part that a half-edge is; none if it lies within a source triangle or on a filling.
std::optional<SourceEdgePart> source_edge_of(Index half_edge, const SurfaceEditor& editor) {
  const Surface& surface = editor.surface();
  const TriangleRef ref = surface.triangle(half_edge / 3);
  const Index first = surface.first_triangle[ref.mesh];
  if (ref.source_triangle >= surface.first_triangle[ref.mesh + 1] - first) return std::nullopt;
  const auto begin = editor.source_barycentric(half_edge),
             end = editor.source_barycentric(Surface::next(half_edge));
  for (Index k = 0; k < 3; ++k) {
    const Index next = (k + 1) % 3, apex = (k + 2) % 3;
    if (begin[apex] == 0 && end[apex] == 0)
      return SourceEdgePart{3 * (first + ref.source_triangle) + k, begin[next], end[next]};
  }
  return std::nullopt;
}

}  // namespace

ScratchVector<Index> half_edges_across_crack(Index half_edge, double farthest,
                                             const SurfaceEditor& editor,
                                             const PosedPoints& posed) {
  const Surface& surface = editor.surface();
  ScratchVector<Index> beyond(&editor.scratch());
  if (surface.cracks.empty()) return beyond;
  const auto here = source_edge_of(half_edge, editor);
  const Index across = here ? surface.across_crack(here->half_edge) : kNone;
  if (across == kNone) return beyond;
  const auto place = [&](Index corner) {
    const TriangleRef ref = surface.triangle(corner / 3);
    const Mesh& mesh = editor.source().meshes[ref.mesh];
    return posed.pose().position(mesh, mesh.triangles[ref.source_triangle][corner % 3]);
  };
  const Index after = Surface::next(here->half_edge);
  if (norm(Vec3d(place(here->half_edge) - place(Surface::next(across)))) > farthest ||
      norm(Vec3d(place(after) - place(across))) > farthest)
    return beyond;
  const TriangleRef other = surface.triangle(across / 3);
  editor.origins.for_each_part(other.mesh, other.source_triangle, [&](Index face) {
    for (Index h = 3 * face; h < 3 * face + 3; ++h) {
      const auto there = source_edge_of(h, editor);
      if (there && there->half_edge == across &&
          std::min(here->end, 1 - there->begin) - std::max(here->begin, 1 - there->end) >
              kInCellEdges)
        beyond.push_back(h);
    }
  });
  return beyond;
}

}  // namespace sunder::tear
