#include "bench/peers/cgal_clip_peer.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/clip.h>
#include <CGAL/Surface_mesh.h>
#include <exception>

namespace sunder::bench {
namespace {

namespace processing = CGAL::Polygon_mesh_processing;
using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point = Kernel::Point_3;
using SurfaceMesh = CGAL::Surface_mesh<Point>;

SurfaceMesh to_mesh(const test::Solid& solid) {
  SurfaceMesh mesh;
  for (const Vec3d& at : solid.positions) mesh.add_vertex(Point(at.x(), at.y(), at.z()));
  using Vertex = SurfaceMesh::Vertex_index;
  for (const auto& [a, b, c] : solid.triangles) mesh.add_face(Vertex(a), Vertex(b), Vertex(c));
  return mesh;
}

test::Solid to_solid(SurfaceMesh& mesh) {
  mesh.collect_garbage();
  test::Solid solid;
  for (const auto vertex : mesh.vertices()) {
    const Point& at = mesh.point(vertex);
    solid.positions.emplace_back(at.x(), at.y(), at.z());
  }
  for (const auto face : mesh.faces()) {
    Triangle& triangle = solid.triangles.emplace_back();
    std::size_t k = 0;
    for (const auto vertex : CGAL::vertices_around_face(mesh.halfedge(face), mesh))
      triangle[k++] = static_cast<std::uint32_t>(vertex.idx());
  }
  return solid;
}

/// The part on the negative side of a plane.
std::optional<test::Solid> clip(const test::Solid& body, const Kernel::Plane_3& plane) {
  SurfaceMesh mesh = to_mesh(body);
  try {
    if (!processing::clip(mesh, plane, CGAL::parameters::clip_volume(true))) return std::nullopt;
  } catch (const std::exception&) {
    return std::nullopt;
  }
  return to_solid(mesh);
}

}  // namespace

CutSidesOfAll cut_by_cgal(const std::vector<test::HardCut>& cuts) {
  CutSidesOfAll all;
  for (const test::HardCut& cut : cuts) {
    const Kernel::Plane_3 plane(Point(cut.point.x(), cut.point.y(), cut.point.z()),
                                Kernel::Vector_3(cut.normal.x(), cut.normal.y(), cut.normal.z()));
    auto below = clip(cut.body, plane), above = clip(cut.body, plane.opposite());
    auto& sides = all.emplace_back();
    if (below && above) sides = CutSides{std::move(*below), std::move(*above)};
  }
  return all;
}

}  // namespace sunder::bench
