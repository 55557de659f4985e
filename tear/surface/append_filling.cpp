#include "tear/surface/append_filling.h"

namespace sunder::tear {

Index submesh_of_fillings(Index mesh, const std::string& name, Index material,
                          SurfaceEditor& editor) {
  editor.room.make_for_additions(mesh);
  return editor.fillings.find_or_append_submesh(mesh, name, material);
}

Index append_filling_point(SurfaceEditor& editor) {
  editor.room.make_for_point();
  return editor.connectivity.append_point();
}

Index append_filling(const FillingSubmesh& to, const std::array<Index, 3>& points,
                     const Triangle& vertices, SurfaceEditor& editor) {
  const Index mesh = to.mesh;
  editor.room.make_for_triangles(mesh, 1);
  editor.room.make_for_additions(mesh);
  const Surface& surface = editor.surface();
  const Index origin = editor.fillings.append(mesh, to.group, vertices);
  const Index triangle = editor.connectivity.append_filling(
      {mesh, editor.character().meshes[mesh].triangle_count(), origin}, to.submesh, points,
      vertices);
  for (Index k = 0; k < 3; ++k) {
    if (!editor.births.give_birth(mesh, vertices[k], origin, k)) continue;  // of an earlier one
    editor.sides.write(mesh, vertices[k], surface.side(points[k]));
    if (surface.point_corner[points[k]] == kNone)
      editor.connectivity.set_point_corner(points[k], 3 * triangle + k);
  }
  return triangle;
}

void connect(Index a, Index b, SurfaceEditor& editor) {
  editor.room.make_for_changes(2);
  editor.log.keep(a / 3);
  editor.log.keep(b / 3);
  editor.connectivity.join(a, b);
}

}  // namespace sunder::tear
