// Finds all pieces, including the remaining ones, as a cut reports them.
#include <algorithm>
#include <array>
#include <memory_resource>

#include "tear/internal/surface.h"
#include "tear/pieces/changed_faces.h"
#include "tear/pieces/piece_description.h"
#include "tear/pieces/pieces.h"

namespace sunder::tear {
namespace {

/// Connected components by points. A point has one fan, so faces with a common point are connected
/// across edges.
DisjointSets join_points(const Surface& surface) {
  DisjointSets parts(surface.point_count(),
                     *std::pmr::get_default_resource());  // scratch memory is for what tears need
  for (Index face = 0; face < surface.triangle_count(); ++face) {
    if (surface.has_repeated_point(face)) continue;
    const Index* points = &surface.corner_point[3 * face];
    parts.unite_with_lesser(points[0], points[1]);
    parts.unite_with_lesser(points[1], points[2]);
  }
  return parts;
}

/// The representative points of separated parts: of each former component that now has several.
std::vector<Index> find_separated(ChangedFaces& changed, const Surface& surface,
                                  DisjointSets& parts) {
  std::vector<std::array<Index, 2>> of_face;  // part, group
  for (Index i = 0; i < changed.count(); ++i)
    if (changed.is_live(i))
      of_face.push_back({parts.find(surface.corner_point[3 * changed.face(i)]), i});
  std::sort(of_face.begin(), of_face.end());
  // Faces that are connected now were connected before.
  for (std::size_t i = 1; i < of_face.size(); ++i)
    if (of_face[i][0] == of_face[i - 1][0])
      changed.groups().unite(of_face[i - 1][1], of_face[i][1]);
  std::vector<std::array<Index, 2>> by_group;
  for (std::size_t i = 0; i < of_face.size(); ++i)
    if (i == 0 || of_face[i][0] != of_face[i - 1][0])
      by_group.push_back({changed.groups().find(of_face[i][1]), of_face[i][0]});
  std::sort(by_group.begin(), by_group.end());
  std::vector<Index> separated;
  for (std::size_t i = 0; i < by_group.size(); ++i) {
    const bool is_alone = (i == 0 || by_group[i - 1][0] != by_group[i][0]) &&
                          (i + 1 == by_group.size() || by_group[i + 1][0] != by_group[i][0]);
    if (!is_alone) separated.push_back(by_group[i][1]);
  }
  return separated;
}

}  // namespace

std::vector<TornPiece> find_all_pieces(const EditLog::Mark& begin, const SurfaceEditor& editor,
                                       PosedPoints& posed) {
  ChangedFaces changed(begin, editor);
  if (changed.set_count() < 2) return {};
  const Surface& surface = editor.surface();
  DisjointSets parts = join_points(surface);
  const std::vector<Index> separated = find_separated(changed, surface, parts);
  if (separated.empty()) return {};

  // The least point of a part represents it, so it is visited first.
  std::vector<Index> number(surface.point_count(), kNone);
  for (Index i = 0; i < separated.size(); ++i) number[separated[i]] = i;
  for (Index point = 0; point < surface.point_count(); ++point)
    number[point] = number[parts.find(point)];
  std::vector<PieceDescription> descriptions(separated.size(), PieceDescription(editor, posed));
  std::vector<Index> order;  // in which the pieces are found
  for (Index face = 0; face < surface.triangle_count(); ++face) {
    if (surface.has_repeated_point(face)) continue;
    const Index i = number[surface.corner_point[3 * face]];
    if (i == kNone) continue;
    if (descriptions[i].is_empty()) order.push_back(i);
    descriptions[i].add(face);
  }
  std::vector<TornPiece> pieces;
  for (const Index i : order) pieces.push_back(descriptions[i].piece());
  return pieces;
}

}  // namespace sunder::tear
