#include "tear/surface/improve.h"

#include <algorithm>

#include "tear/geometry/face_shape.h"
#include "tear/geometry/tolerances.h"
#include "tear/internal/surface.h"
#include "tear/surface/flip_edge.h"

namespace sunder::tear {
namespace {

/// The factor by which flipping an edge improves the worse of its two faces; at most 1 if it does
/// not.
double gain(Index half_edge, const SurfaceEditor& editor) {
  const Surface& surface = editor.surface();
  const Index twin = surface.twin[half_edge];
  const TriangleRef f = surface.triangle(half_edge / 3), g = surface.triangle(twin / 3);
  const Mesh& mesh = editor.character().meshes[f.mesh];
  const Triangle &of_f = mesh.triangles[f.triangle], &of_g = mesh.triangles[g.triangle];
  const auto place = [&](Index vertex) { return place_of(editor.births.position(f.mesh, vertex)); };
  const Place a = place(of_f[half_edge % 3]), b = place(of_f[Surface::next(half_edge) % 3]),
              c = place(of_f[Surface::previous(half_edge) % 3]),
              d = place(of_g[Surface::previous(twin) % 3]);
  const double before = std::min(shape_squared(a, b, c), shape_squared(b, a, d));
  const double after = std::min(shape_squared(a, d, c), shape_squared(b, c, d));
  return before > 0 ? after / before : after > 0 ? 2.0 : 0.0;
}

}  // namespace

void improve_faces(const EditLog::Mark& since, SurfaceEditor& editor) {
  const Surface& surface = editor.surface();
  ScratchVector<Index> open(&editor.scratch());
  open.reserve(3 * editor.log.numbers_since(since));
  // Each edge once, from the later of its faces if both changed.
  const auto add = [&](Index face) {
    if (surface.corner_point[3 * face] == kNone || editor.origins.is_settled(face)) return;
    for (Index h = 3 * face; h < 3 * face + 3; ++h)
      if (editor.origins.is_inner_edge(h) &&
          (surface.twin[h] < h || editor.log.number_since(since, surface.twin[h] / 3) == kNone))
        open.push_back(h);
  };
  editor.log.for_each_changed(since, add);
  for (Index face = since.triangles; face < surface.triangle_count(); ++face)
    if (editor.origins.parent(face) != kNone) add(face);  // a whole filling has no inner edge
  std::size_t turns_left = 16 * editor.log.numbers_since(since);
  while (!open.empty() && turns_left > 0) {
    const Index h = open.back();
    open.pop_back();
    if (!editor.origins.is_inner_edge(h) || !(gain(h, editor) > kBetterShapeFactor)) continue;
    const Index twin = surface.twin[h];
    if (!flip_edge(h, editor)) continue;
    --turns_left;
    // The diagonal is the better one now; only the edges around it may gain.
    const Index diagonal = Surface::next(h);
    for (const Index face : {h / 3, twin / 3})
      for (Index side = 3 * face; side < 3 * face + 3; ++side)
        if (side != diagonal && side != surface.twin[diagonal]) open.push_back(side);
  }
}

}  // namespace sunder::tear
