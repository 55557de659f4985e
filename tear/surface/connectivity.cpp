#include "tear/surface/connectivity.h"

namespace sunder::tear {

Index Connectivity::append_triangle(const TriangleRef& ref, Index submesh,
                                    const std::array<Index, 3>& points, const Triangle& vertices) {
  Surface& surface = columns_.surface;
  Mesh& mesh = character_.meshes[ref.mesh];
  const Index triangle = surface.triangle_count();
  surface.appended.push_back(ref);
  columns_.newest_change.push_back(kNone);
  origins_.link_new_parts();
  columns_.meshes[ref.mesh].surface_triangles.push_back(triangle);
  mesh.triangles.push_back(vertices);
  mesh.triangle_submesh.push_back(submesh);
  for (Index k = 0; k < 3; ++k) {
    surface.corner_point.push_back(points[k]);
    surface.twin.push_back(kNone);
  }
  return triangle;
}

Index Connectivity::append_part(Index like, const std::array<Index, 3>& points,
                                const Triangle& vertices) {
  const TriangleRef ref = columns_.surface.triangle(like);
  const Mesh& mesh = character_.meshes[ref.mesh];
  columns_.parents.push_back(like);
  columns_.ancestors.push_back(stage_.ancestor(like));
  return append_triangle({ref.mesh, mesh.triangle_count(), ref.source_triangle},
                         mesh.triangle_submesh[ref.triangle], points, vertices);
}

Index Connectivity::append_filling(const TriangleRef& origin, Index submesh,
                                   const std::array<Index, 3>& points, const Triangle& vertices) {
  columns_.parents.push_back(kNone);
  columns_.ancestors.push_back(columns_.surface.triangle_count());
  return append_triangle(origin, submesh, points, vertices);
}

}  // namespace sunder::tear
