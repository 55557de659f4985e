#include "tear/surface/copy_with_room.h"

#include "tear/internal/assign_with_room.h"
#include "tear/surface/room.h"

namespace sunder::tear {

Surface copy_with_room(const Surface& surface, const TornCapacity& capacity,
                       std::size_t mesh_count) {
  const auto assign = [&](const Column& column, const std::vector<Index>& from,
                          std::vector<Index>& to) {
    assign_with_room(from, entries_in_advance(column, from.size(), capacity, mesh_count), to);
  };
  // Names every member, so that a new one is not forgotten.
  const auto& [corner_point, twin, first_triangle, appended, point_corner, source_side,
               appended_side, is_shared_vertex, largest_coordinate, cracks, non_manifold_edges,
               non_manifold_half_edges] = surface;
  Surface copy;
  assign({Rows::triangles, 3}, corner_point, copy.corner_point);
  assign({Rows::triangles, 3}, twin, copy.twin);
  copy.first_triangle = first_triangle;
  copy.appended = appended;
  assign({Rows::points}, point_corner, copy.point_corner);
  copy.source_side = source_side;
  copy.appended_side = appended_side;
  copy.is_shared_vertex = is_shared_vertex;
  copy.largest_coordinate = largest_coordinate;
  copy.cracks = cracks;
  copy.non_manifold_edges = non_manifold_edges;
  copy.non_manifold_half_edges = non_manifold_half_edges;
  return copy;
}

Character copy_with_room(const Character& character, const TornCapacity& capacity) {
  const auto& [name, skeleton, skins, meshes, rest_morph_weights, clips] = character;
  Character copy{name, skeleton, skins, {}, rest_morph_weights, clips};
  copy.meshes.reserve(meshes.size());
  for (const Mesh& mesh : meshes)
    copy.meshes.push_back(
        sunder::copy_with_room(mesh, vertices_in_advance(mesh, capacity),
                               entries_in_advance({Rows::mesh_triangles}, mesh.triangles.size(),
                                                  capacity, meshes.size())));
  return copy;
}

}  // namespace sunder::tear
