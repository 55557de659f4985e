#include "tear/pieces/pieces.h"

#include "tear/internal/surface.h"
#include "tear/pieces/changed_faces.h"
#include "tear/pieces/piece_search.h"

namespace sunder::tear {
namespace {

TornPiece name(const PieceSearch::Part& part, Index face, const Surface& surface) {
  const TriangleRef ref = surface.triangle(face);
  return {ref.mesh, ref.triangle, part.triangle_count, part.component, part.is_body};
}

/// Groups neighbouring points of lips, each with its point before if an edge joins them.
class LipFronts {
 public:
  LipFronts(std::size_t point_count, const Surface& surface, ScratchMemory& scratch)
      : surface_(surface), faces_(&scratch) {
    faces_.reserve(point_count);
  }

  /// @param before  the previous point on the same side, and its front.
  Index front_of(Index point, Index before, Index front_before) {
    if (before != kNone && has_edge(point, before)) return front_before;
    faces_.push_back(surface_.point_corner[point] / 3);
    return static_cast<Index>(faces_.size()) - 1;
  }
  /// A face of each front.
  [[nodiscard]] const ScratchVector<Index>& faces() const { return faces_; }

 private:
  [[nodiscard]] bool has_edge(Index point, Index other) const {
    const Index first = surface_.first_of_fan(surface_.point_corner[point]);
    for (Index c = first; c != kNone;) {
      if (surface_.corner_point[Surface::next(c)] == other ||
          surface_.corner_point[Surface::previous(c)] == other)
        return true;
      c = surface_.rotate_ccw(c);
      if (c == first) break;
    }
    return false;
  }

  const Surface& surface_;
  ScratchVector<Index> faces_;
};

}  // namespace

TornPieces find_pieces(const EditLog::Mark& begin, const EditLog::Extent& end,
                       const SurfaceEditor& editor) {
  ChangedFaces changed(begin, end, editor);
  if (changed.set_count() < 2) return {};
  // A front per connected set of changed faces.
  ScratchVector<Index> front_of(changed.count(), kNone, &editor.scratch()),
      of_group(changed.count(), kNone, &editor.scratch()), faces(&editor.scratch());
  faces.reserve(changed.set_count());
  for (Index i = 0; i < changed.count(); ++i) {
    if (!changed.is_live(i)) continue;
    Index& front = front_of[changed.sets().find(i)];
    if (front == kNone) {
      front = static_cast<Index>(faces.size());
      faces.push_back(changed.face(i));
    }
    front_of[i] = front;
  }
  PieceSearch search(static_cast<Index>(faces.size()), editor);
  for (Index i = 0; i < changed.count(); ++i) {
    if (!changed.is_live(i)) continue;
    search.begin_at(front_of[i], changed.face(i));
    Index& first = of_group[changed.groups().find(i)];
    if (first == kNone) first = front_of[i];
    search.were_connected(first, front_of[i]);
  }
  search.grow();
  TornPieces pieces;
  for (const PieceSearch::Part& part : search.separated())
    if (!part.is_body) pieces.push_back(name(part, faces[part.front], editor.surface()));
  return pieces;
}

TornPieces find_pieces_at(std::span<const LipPair> lips, const SurfaceEditor& editor) {
  const Surface& surface = editor.surface();
  LipFronts fronts(2 * lips.size(), surface, editor.scratch());
  ScratchVector<std::array<Index, 2>> of_lips(&editor.scratch());  // left and right front
  of_lips.reserve(lips.size());
  LipPair before{kNone, kNone};
  std::array<Index, 2> front_before = {kNone, kNone};
  for (const LipPair& lip : lips) {
    front_before = {fronts.front_of(lip.left, before.left, front_before[0]),
                    fronts.front_of(lip.right, before.right, front_before[1])};
    before = lip;
    of_lips.push_back(front_before);
  }
  if (fronts.faces().size() < 2) return {};
  PieceSearch search(static_cast<Index>(fronts.faces().size()), editor);
  for (Index front = 0; front < fronts.faces().size(); ++front)
    search.begin_at(front, fronts.faces()[front]);
  for (const auto& [left, right] : of_lips) search.were_connected(left, right);
  search.grow();
  TornPieces pieces;
  for (const PieceSearch::Part& part : search.separated())
    pieces.push_back(name(part, fronts.faces()[part.front], surface));
  return pieces;
}

}  // namespace sunder::tear
