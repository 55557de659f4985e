#include "bench/peers/cgal_peer.h"

#include <CGAL/AABB_face_graph_triangle_primitive.h>
#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/corefinement.h>
#include <CGAL/Surface_mesh.h>
#include <map>

#include "bench/harness/measure.h"

namespace sunder::bench {
namespace {

namespace processing = CGAL::Polygon_mesh_processing;
using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point = Kernel::Point_3;
using SurfaceMesh = CGAL::Surface_mesh<Point>;
using Vertex = SurfaceMesh::Vertex_index;
using Halfedge = SurfaceMesh::Halfedge_index;
using Tree = CGAL::AABB_tree<
    CGAL::AABB_traits<Kernel, CGAL::AABB_face_graph_triangle_primitive<SurfaceMesh>>>;
using Floats = std::array<float, 8>;
using Attributes = SurfaceMesh::Property_map<Vertex, Floats>;

Point to_point(const Vec3d& p) { return {p.x(), p.y(), p.z()}; }

/// For each vertex that corefinement adds on an edge or face of the surface, interpolates the
/// floats of the corners.
class Interpolation : public processing::Corefinement::Default_visitor<SurfaceMesh> {
 public:
  Interpolation(const SurfaceMesh& surface, Attributes attributes)
      : surface_(&surface), attributes_(attributes) {}

  void intersection_point_detected(std::size_t id, int dimension, Halfedge on_edge,
                                   Halfedge on_other, const SurfaceMesh& with_edge,
                                   const SurfaceMesh& with_other, bool, bool) {
    const auto ends_of = [&](Halfedge edge) {
      return std::array{surface_->source(edge), surface_->target(edge), surface_->target(edge)};
    };
    if (&with_edge == surface_)
      corners_of_[id] = ends_of(on_edge);
    else if (&with_other == surface_ && dimension == 1)
      corners_of_[id] = ends_of(on_other);
    else if (&with_other == surface_ && dimension == 2)
      corners_of_[id] = {surface_->source(on_other), surface_->target(on_other),
                         surface_->target(surface_->next(on_other))};
  }

  void new_vertex_added(std::size_t id, Vertex vertex, const SurfaceMesh& mesh) {
    if (&mesh != surface_) return;
    const auto corners = corners_of_.find(id);
    if (corners == corners_of_.end()) return;
    const auto& [a, b, c] = corners->second;
    const auto part = barycentric(surface_->point(a), surface_->point(b), surface_->point(c),
                                  surface_->point(vertex));
    Floats& floats = attributes_[vertex];
    for (std::size_t i = 0; i < floats.size(); ++i)
      floats[i] = static_cast<float>(part[0] * attributes_[a][i] + part[1] * attributes_[b][i] +
                                     part[2] * attributes_[c][i]);
  }

 private:
  /// Barycentric coordinates of a position in a triangle, or on its first side if the last two
  /// corners coincide.
  static std::array<double, 3> barycentric(const Point& a, const Point& b, const Point& c,
                                           const Point& at) {
    if (b == c) {
      const double along = std::sqrt(CGAL::squared_distance(a, at) / CGAL::squared_distance(a, b));
      return {1 - along, along, 0};
    }
    const auto area = [](const Point& p, const Point& q, const Point& r) {
      return std::sqrt(CGAL::squared_area(p, q, r));
    };
    const double whole = area(a, b, c), to_b = area(a, at, c) / whole,
                 to_c = area(a, b, at) / whole;
    return {1 - to_b - to_c, to_b, to_c};
  }

  const SurfaceMesh* surface_;
  Attributes attributes_;
  std::map<std::size_t, std::array<Vertex, 3>> corners_of_;
};

}  // namespace

struct CgalPeer::State {
  SurfaceMesh surface, sheet;
  std::size_t new_vertices = 0;
  std::unique_ptr<Tree> tree;
};

CgalPeer::CgalPeer(const Scene& scene) : state_(std::make_unique<State>()) {
  SurfaceMesh& surface = state_->surface;
  for (const Vec3d& position : posed_positions(scene, scene.poses[0]))
    surface.add_vertex(to_point(position));
  const Mesh& mesh = scene.mesh();
  for (const Triangle& t : mesh.triangles)
    surface.add_face(Vertex(t[0]), Vertex(t[1]), Vertex(t[2]));
  const Attributes attributes = surface.add_property_map<Vertex, Floats>("v:attributes").first;
  for (const Vertex vertex : surface.vertices()) {
    const Vec3f &position = mesh.positions[vertex], &normal = mesh.normals[vertex];
    const Vec2f& uv = mesh.uv_sets[0][vertex];
    attributes[vertex] = {position.x(), position.y(), position.z(), normal.x(),
                          normal.y(),   normal.z(),   uv.x(),       uv.y()};
  }
  SurfaceMesh& sheet = state_->sheet;
  const Blade &first = scene.stroke.front(), &last = scene.stroke.back();
  const auto a = sheet.add_vertex(to_point(first.base)), b = sheet.add_vertex(to_point(first.tip)),
             c = sheet.add_vertex(to_point(last.tip)), d = sheet.add_vertex(to_point(last.base));
  sheet.add_face(a, b, c);
  sheet.add_face(a, c, d);
}

CgalPeer::~CgalPeer() = default;

double CgalPeer::corefine() {
  SurfaceMesh surface = state_->surface, sheet = state_->sheet;
  const Attributes attributes = surface.property_map<Vertex, Floats>("v:attributes").first;
  const Interpolation interpolation(surface, attributes);
  const double seconds = seconds_of(
      [&] { processing::corefine(surface, sheet, CGAL::parameters::visitor(interpolation)); });
  state_->new_vertices = surface.number_of_vertices() - state_->surface.number_of_vertices();
  return seconds;
}

std::size_t CgalPeer::new_vertices() const { return state_->new_vertices; }

double CgalPeer::build_tree() {
  return seconds_of([&] {
    state_->tree = std::make_unique<Tree>(faces(state_->surface).begin(),
                                          faces(state_->surface).end(), state_->surface);
    state_->tree->build();
  });
}

double CgalPeer::query_tree() {
  const SurfaceMesh& sheet = state_->sheet;
  std::vector<Tree::Primitive_id> found;
  return seconds_of([&] {
    for (const auto face : sheet.faces()) {
      const Halfedge first = sheet.halfedge(face), second = sheet.next(first);
      const Kernel::Triangle_3 triangle(sheet.point(sheet.source(first)),
                                        sheet.point(sheet.target(first)),
                                        sheet.point(sheet.target(second)));
      state_->tree->all_intersected_primitives(triangle, std::back_inserter(found));
    }
  });
}

}  // namespace sunder::bench
