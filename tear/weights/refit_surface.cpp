#include "tear/weights/refit_surface.h"

#include <algorithm>
#include <array>
#include <limits>
#include <tuple>

#include "core/internal/ordered.h"
#include "tear/internal/surface.h"

namespace sunder::tear {
namespace {

/// The number of a point among those of an assignment; kNone for other vertices.
Index number_of(const VertexRef& vertex, const WeightAssignment& assignment) {
  const auto at = std::lower_bound(assignment.points.begin(), assignment.points.end(), vertex,
                                   [](const PointWeights& a, const auto& b) {
                                     return std::tie(a.vertex.mesh, a.vertex.vertex) <
                                            std::tie(b.mesh, b.vertex);
                                   });
  return at != assignment.points.end() && at->vertex == vertex
             ? static_cast<Index>(at - assignment.points.begin())
             : kNone;
}

/// Calls visit(face) for all faces around points that were created since `begin`: every one was
/// itself appended or changed since.
template <class Visit>
void for_each_face_around(const EditLog::Mark& begin, const SurfaceEditor& editor,
                          const Visit& visit) {
  const auto visit_used = [&](Index face) {
    if (editor.surface().corner_point[3 * face] != kNone) visit(face);
  };
  editor.log.for_each_changed(begin, visit_used);
  for (Index face = begin.triangles; face < editor.surface().triangle_count(); ++face)
    visit_used(face);
}

}  // namespace

std::vector<RefitNeighbours> find_neighbours(const WeightAssignment& assignment,
                                             const EditLog::Mark& begin,
                                             const SurfaceEditor& editor) {
  struct Edge {
    Index a, b;
    VertexRef end;  // the untorn end, if there is one
    double length;
    [[nodiscard]] auto key() const { return std::tuple(a, b, end.mesh, end.vertex); }
  };
  std::vector<Edge> edges;
  const auto add_edges = [&](Index face) {
    const Index mesh = editor.surface().triangle(face).mesh;
    for (Index h = 3 * face; h < 3 * face + 3; ++h) {
      const Index from = editor.vertex_at(h), to = editor.vertex_at(Surface::next(h));
      const auto original_from = editor.births.original(mesh, from),
                 original_to = editor.births.original(mesh, to);
      Index a = number_of(original_from, assignment), b = number_of(original_to, assignment);
      if (a == b) continue;
      const VertexRef end = a == kNone ? original_from : b == kNone ? original_to : VertexRef{};
      if (b < a) std::swap(a, b);  // kNone comes last
      const double length = norm(
          (editor.births.position(mesh, from) - editor.births.position(mesh, to)).cast<double>());
      edges.push_back({a, b, end, length});
    }
  };
  for_each_face_around(begin, editor, add_edges);
  std::sort(edges.begin(), edges.end(),
            [](const Edge& a, const Edge& b) { return a.key() < b.key(); });
  edges.erase(std::unique(edges.begin(), edges.end(),
                          [](const Edge& a, const Edge& b) { return a.key() == b.key(); }),
              edges.end());
  std::vector<RefitNeighbours> neighbours;
  neighbours.reserve(edges.size());
  for (const Edge& edge : edges) neighbours.push_back({edge.a, edge.b, edge.length});
  return neighbours;
}

std::vector<double> find_reach(const WeightAssignment& assignment, const EditLog::Mark& begin,
                               const SurfaceEditor& editor) {
  std::vector<double> reach(assignment.points.size(), std::numeric_limits<double>::infinity());
  for_each_face_around(begin, editor, [&](Index face) {
    const Index mesh = editor.surface().triangle(face).mesh;
    std::array<Vec3d, 3> corners;
    for (Index k = 0; k < 3; ++k)
      corners[k] = editor.births.position(mesh, editor.vertex_at(3 * face + k)).cast<double>();
    double longest = 0;
    for (Index k = 0; k < 3; ++k)
      longest = std::max(longest, norm(corners[(k + 1) % 3] - corners[k]));
    const Eigen::Vector3d a = corners[1] - corners[0], b = corners[2] - corners[0];
    const double height = longest > 0 ? norm(a.cross(b)) / longest : 0.0;
    for (Index k = 0; k < 3; ++k) {
      const Index vertex = editor.vertex_at(3 * face + k);
      const Index point = number_of(editor.births.original(mesh, vertex), assignment);
      if (point != kNone) reach[point] = std::min(reach[point], height / 3);
    }
  });
  return reach;
}

}  // namespace sunder::tear
