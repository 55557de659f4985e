#include <algorithm>

#include "pipeline/validation/match/position_table.h"
#include "pipeline/validation/match/surface_match.h"

namespace sunder::validation {
namespace {

/// The smallest triangle of each vertex of a mesh, retired ones aside.
std::vector<Index> triangles_of_vertices(const Mesh& mesh) {
  std::vector<Index> triangles(mesh.vertex_count(), kNone);
  for (Index t = mesh.triangle_count(); t-- > 0;)
    if (!is_retired(mesh.triangles[t]))
      for (const Index vertex : mesh.triangles[t]) triangles[vertex] = t;
  return triangles;
}

SurfaceMatch match_at(Index mesh, Index triangle, const std::array<double, 3>& barycentric) {
  SurfaceMatch match;
  match.mesh = mesh;
  match.triangle = triangle;
  match.barycentric = barycentric;
  match.is_accepted = true;
  return match;
}

SurfaceMatch match_at_vertex(const Mesh& mesh, Index mesh_index, Index vertex, Index triangle) {
  if (triangle == kNone) return {};
  std::array<double, 3> barycentric = {0, 0, 0};
  const Triangle& corners = mesh.triangles[triangle];
  barycentric[static_cast<std::size_t>(std::find(corners.begin(), corners.end(), vertex) -
                                       corners.begin())] = 1;
  return match_at(mesh_index, triangle, barycentric);
}

}  // namespace

SurfaceMatches matches_from_births(const TornModel& model) {
  const Character &source = model.source(), &torn = model.character();
  SurfaceMatches result;
  std::vector<Index> unborn;  // on the rims of walls and caps, or inside them
  std::size_t vertex_count = 0;
  for (const Mesh& mesh : torn.meshes) vertex_count += mesh.vertex_count();
  PositionTable known(vertex_count);
  for (Index m = 0; m < torn.meshes.size(); ++m) {
    const Mesh &before = source.meshes[m], &mesh = torn.meshes[m];
    const std::vector<Index> triangles = triangles_of_vertices(before);
    for (Index v = 0; v < mesh.vertex_count(); ++v) {
      const auto index = static_cast<Index>(result.matches.size());
      SurfaceMatch& match = result.matches.emplace_back();
      if (v < before.vertex_count()) {
        match = match_at_vertex(before, m, v, triangles[v]);
      } else if (const Birth birth = model.birth(m, v); birth.triangle < before.triangle_count()) {
        match = match_at(m, birth.triangle, birth.barycentric);
      } else {
        unborn.push_back(index);
        continue;
      }
      if (match.is_accepted) known.insert(mesh.positions[v].cast<double>(), index);
    }
    result.first_vertex.push_back(static_cast<Index>(result.matches.size()));
  }
  // The rim of a wall or cap stands at the place of a lip.
  for (const Index index : unborn) {
    const auto mesh = static_cast<Index>(
        std::upper_bound(result.first_vertex.begin(), result.first_vertex.end(), index) -
        result.first_vertex.begin() - 1);
    const Mesh& of = torn.meshes[mesh];
    known.find(of.positions[index - result.first_vertex[mesh]].cast<double>(), [&](Index lip) {
      const bool is_of_mesh =
          lip >= result.first_vertex[mesh] && lip < result.first_vertex[mesh + 1];
      if (is_of_mesh || !result.matches[index].is_accepted)
        result.matches[index] = result.matches[lip];
      return is_of_mesh;
    });
  }
  result.counts = count_matches(result.matches, {});
  return result;
}

}  // namespace sunder::validation
