#include "tear/sheet/remove_faces.h"

#include <algorithm>

#include "tear/internal/surface.h"
#include "tear/surface/disconnect.h"

namespace sunder::tear {
namespace {

/// A fan of remaining faces at a point that had removed ones.
struct Fan {
  Index point;
  Index lowest;  ///< Its lowest corner: fans of a point are ordered by them.
  Index first;

  [[nodiscard]] bool operator<(const Fan& other) const {
    return point != other.point ? point < other.point : lowest < other.lowest;
  }
};

Fan fan_from(Index first, const Surface& surface) {
  Fan fan{surface.corner_point[first], first, first};
  surface.for_each_in_fan(first, [&](Index corner) { fan.lowest = std::min(fan.lowest, corner); });
  return fan;
}

/// Gives all fans of a point but the first one points of their own.
void separate(std::span<const Fan> fans, SurfaceEditor& editor, PosedPoints& posed) {
  const Index point = fans.front().point;
  editor.connectivity.set_point_corner(point, fans.front().first);
  ScratchVector<Index> corners(&editor.scratch()), others(&editor.scratch());
  for (std::size_t i = 1; i < fans.size(); ++i) {
    corners.clear();
    others.clear();
    for (std::size_t k = 0; k < fans.size(); ++k)
      if (k != i) others.push_back(fans[k].first);
    editor.surface().for_each_in_fan(fans[i].first,
                                     [&](Index corner) { corners.push_back(corner); });
    posed.pin(separate_fan(corners, others, editor), Vec3d(posed.position(editor, point)));
  }
}

}  // namespace

RemovedFaces::RemovedFaces(std::span<const Index> faces, const SurfaceEditor& editor,
                           DisjointSets* connected)
    : faces_(faces),
      number_(faces.size(), editor.scratch()),
      first_newest_(editor.stage.first_triangle()),
      of_newest_(editor.surface().triangle_count() - first_newest_, kNone, &editor.scratch()),
      border_(&editor.scratch()) {
  for (Index i = 0; i < faces.size(); ++i)
    if (faces[i] < first_newest_)
      number_.insert(faces[i], i);
    else
      of_newest_[faces[i] - first_newest_] = i;
  const Surface& surface = editor.surface();
  // Edges at the border cannot be predicted, so nothing branches there.
  border_.resize(3 * faces.size());
  std::size_t count = 0;
  for (Index i = 0; i < faces.size(); ++i)
    for (Index h = 3 * faces[i]; h < 3 * faces[i] + 3; ++h) {
      const Index twin = surface.twin[h];
      const Index other = twin == kNone ? i : find(twin / 3);
      border_[count] = {twin, i};
      count += other == kNone ? 1 : 0;
      if (connected != nullptr) connected->unite_with_lesser(i, std::min(i, other));
    }
  border_.resize(count);
}

void RemovedFaces::remove(SurfaceEditor& editor, PosedPoints& posed) const {
  const Surface& surface = editor.surface();
  for (const BorderEdge& edge : border_) cut_edge(surface.twin[edge.half_edge], editor);
  for (const Index face : faces_) {
    const Index* of_face = &surface.corner_point[3 * face];
    const std::array<Index, 3> points = {of_face[0], of_face[1], of_face[2]};
    retire_triangle(face, editor);  // which logs the corners of the points
    for (const Index point : points) editor.connectivity.set_point_corner(point, kNone);
  }
  separate_fans(editor, posed);
}

/// Each remaining fan at a point of the removed faces has an end on the border.
void RemovedFaces::separate_fans(SurfaceEditor& editor, PosedPoints& posed) const {
  const Surface& surface = editor.surface();
  ScratchVector<Fan> several(&editor.scratch());  // and the first fan of their points
  const auto meet = [&](Index first) {
    const Index point = surface.corner_point[first], known = surface.point_corner[point];
    if (known == kNone) {
      editor.connectivity.set_point_corner(point, first);
    } else if (known != first) {
      several.push_back(fan_from(known, surface));
      several.push_back(fan_from(first, surface));
    }
  };
  for (const BorderEdge& edge : border_) {
    meet(edge.half_edge);
    meet(surface.first_of_fan(Surface::next(edge.half_edge)));
  }
  std::sort(several.begin(), several.end());
  const auto same = [](const Fan& a, const Fan& b) { return a.first == b.first; };
  several.erase(std::unique(several.begin(), several.end(), same), several.end());
  for (std::size_t begin = 0, end = 0; begin < several.size(); begin = end) {
    while (end < several.size() && several[end].point == several[begin].point) ++end;
    separate(std::span(several).subspan(begin, end - begin), editor, posed);
  }
}

}  // namespace sunder::tear
