#include "tear/surface/connected_faces.h"

#include "core/internal/index_set.h"
#include "tear/surface/disconnect.h"

namespace sunder::tear {

std::vector<Index> connected_faces(Index face, const Surface& surface) {
  std::vector<Index> faces = {face};
  IndexSet seen(surface.triangle_count());
  seen.insert(face);
  for (std::size_t i = 0; i < faces.size(); ++i)
    for (Index h = 3 * faces[i]; h < 3 * faces[i] + 3; ++h) {
      const Index twin = surface.twin[h];
      if (twin != kNone && seen.insert(twin / 3)) faces.push_back(twin / 3);
    }
  return seen.list();
}

bool has_others(const std::vector<Index>& faces, const Surface& surface) {
  auto next = faces.begin();
  for (Index face = 0; face < surface.triangle_count(); ++face) {
    if (next != faces.end() && *next == face)
      ++next;
    else if (!surface.has_repeated_point(face))
      return true;
  }
  return false;
}

void retire_component(const std::vector<Index>& faces, SurfaceEditor& editor) {
  const Surface& surface = editor.surface();
  editor.room.make_for_changes(faces.size());
  // The points are logged with the faces, so all faces are logged before any point changes.
  for (const Index face : faces) editor.log.keep(face);
  for (const Index face : faces) {
    const std::array<Index, 3> points = {surface.corner_point[3 * face],
                                         surface.corner_point[3 * face + 1],
                                         surface.corner_point[3 * face + 2]};
    retire_triangle(face, editor);
    for (const Index point : points) editor.connectivity.set_point_corner(point, kNone);
  }
}

}  // namespace sunder::tear
