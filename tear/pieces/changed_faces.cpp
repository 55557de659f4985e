#include "tear/pieces/changed_faces.h"

namespace sunder::tear {

ChangedFaces::ChangedFaces(const EditLog::Mark& begin, const EditLog::Extent& end,
                           const SurfaceEditor& editor)
    : surface_(editor.surface()),
      face_(editor.log.numbers_since(begin), kNone, &editor.scratch()),
      sets_(editor.log.numbers_since(begin), editor.scratch()),
      groups_(editor.log.numbers_since(begin), editor.scratch()) {
  editor.log.for_each_first_change(begin, end, [&](const TriangleChange& change) {
    face_[editor.log.number_since(begin, change.triangle)] = change.triangle;
  });
  for (Index face = begin.triangles; face < end.triangles; ++face)
    face_[editor.log.number_since(begin, face)] = face;
  for (Index i = 0; i < count(); ++i) {
    if (!is_live(i)) continue;
    ++set_count_;
    for (Index h = 3 * face_[i]; h < 3 * face_[i] + 3; ++h) {
      const Index twin = surface_.twin[h];
      if (twin == kNone || twin < h) continue;  // each edge once
      const Index other = editor.log.number_since(begin, twin / 3);
      if (other != kNone && face_[other] != kNone && sets_.unite(i, other)) ++joined_;
    }
  }
  if (set_count() < 2) return;
  for (Index i = 0; i < count(); ++i) groups_.unite(sets_.find(i), i);
  // Connections before the operation: neighbours, and faces split from one face. Unchanged faces
  // are connected as they are now.
  editor.log.for_each_former_neighbour(begin, [&](Index one, Index other) {
    const Index b = editor.log.number_since(begin, other);
    if (b != kNone) groups_.unite(editor.log.number_since(begin, one), b);
  });
  for (Index face = begin.triangles; face < end.triangles; ++face)
    if (editor.origins.parent(face) != kNone)
      groups_.unite(editor.log.number_since(begin, face),
                    editor.log.number_since(begin, editor.origins.parent(face)));
}

}  // namespace sunder::tear
