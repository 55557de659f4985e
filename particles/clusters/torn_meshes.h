#pragma once

#include <sunder/tear/torn_model.h>

#include "tear/internal/surface.h"

namespace sunder::particles {

// Access to the meshes of a torn model by the corners and points of its surface, in one place.

[[nodiscard]] inline Index vertex_at(const TornModel& model, const tear::TriangleRef& ref,
                                     Index corner) {
  return model.character().meshes[ref.mesh].triangles[ref.triangle][corner % 3];
}

/// Calls visit(mesh, vertex) for the vertex of each face around a point; none for a point that has
/// no face. Vertices are repeated.
template <class Visit>
void for_each_vertex(const TornModel& model, Index point, Visit visit) {
  const tear::Surface& surface = model.surface();
  if (point >= surface.point_count() || surface.point_corner[point] == kNone) return;
  surface.for_each_in_fan(surface.point_corner[point], [&](Index corner) {
    const tear::TriangleRef ref = surface.triangle(corner / 3);
    visit(ref.mesh, vertex_at(model, ref, corner));
  });
}

/// Whether one of the faces around a point uses a vertex for it.
[[nodiscard]] inline bool has_vertex(const TornModel& model, Index point, Index mesh,
                                     Index vertex) {
  bool has = false;
  for_each_vertex(model, point,
                  [&](Index of, Index other) { has |= of == mesh && other == vertex; });
  return has;
}

}  // namespace sunder::particles
