#include "tear/operation/walls_in_gap.h"

#include <algorithm>

#include "core/internal/ordered.h"
#include "tear/geometry/tolerances.h"
#include "tear/internal/surface.h"
#include "tear/path/imprint_point.h"
#include "tear/path/wall_path.h"
#include "tear/sheet/remove_faces.h"
#include "tear/surface/index_map.h"
#include "tear/surface/open.h"

namespace sunder::tear {
namespace {

/// The walls of one cell.
class WallsInGap {
 public:
  WallsInGap(std::span<const PlaneSide> cell, const BladePlane& plane, const Workpiece& work)
      : cell_(cell), plane_(plane), work_(work), lips_(&scratch()) {}

  /// @return whether any lip with a wall is partly inside the cell.
  bool find_lips(std::span<const CellFace> faces) {
    for (const CellFace& face : faces) {
      if (work_.editor.is_wall(face.face)) continue;
      for (Index h = 3 * face.face; h < 3 * face.face + 3; ++h)
        if (is_above_wall(h) && !part_inside(h).is_empty()) lips_.push_back(ends_of(h));
    }
    return !lips_.empty();
  }

  /// Opens the walls where lips enter and leave the cell, and removes what is between.
  void remove() {
    ScratchVector<PointEdge> inside(&scratch());
    for (const PointEdge& lip : lips_)
      if (const Index h = surface().find_half_edge(lip[0], lip[1]); h != kNone)
        inside.push_back(cut_at_ends(h));
    ScratchVector<Index> faces(&scratch());
    IndexMap seen(64, scratch());
    for (const auto& [from, to] : inside)
      if (const Index h = surface().find_half_edge(from, to); h != kNone && is_above_wall(h))
        collect(surface().twin[h] / 3, seen, faces);
    if (!faces.empty()) RemovedFaces(faces, work_.editor).remove(work_.editor, work_.posed);
  }

 private:
  struct Part {
    double begin = 0, end = 1;
    [[nodiscard]] bool is_empty() const { return !(end - begin > kInCellEdges); }
  };

  [[nodiscard]] ScratchMemory& scratch() const { return work_.editor.scratch(); }
  [[nodiscard]] const Surface& surface() const { return work_.editor.surface(); }
  [[nodiscard]] bool is_above_wall(Index half_edge) const {
    const Index twin = surface().twin[half_edge];
    return twin != kNone && work_.editor.is_wall(twin / 3);
  }
  [[nodiscard]] PointEdge ends_of(Index half_edge) const {
    return {surface().corner_point[half_edge], surface().corner_point[Surface::next(half_edge)]};
  }

  /// The part of an edge that is inside the cell.
  [[nodiscard]] Part part_inside(Index half_edge) const {
    const auto [from, to] = ends_of(half_edge);
    const Vec3d a = work_.posed.position(work_.editor, from),
                b = work_.posed.position(work_.editor, to);
    Part part;
    for (const PlaneSide& side : cell_) {
      const double at_a = side.value(a), at_b = side.value(b);
      if (at_a < 0 && at_b < 0) return {1, 0};
      if (at_a < 0) part.begin = std::max(part.begin, at_a / (at_a - at_b));
      if (at_b < 0) part.end = std::min(part.end, at_a / (at_a - at_b));
    }
    return part;
  }

  /// Splits a lip where it enters and leaves the cell, and opens the wall below these places.
  /// @return the part inside.
  PointEdge cut_at_ends(Index half_edge) {
    const PointEdge whole = ends_of(half_edge);
    PointEdge inside = whole;
    const Part part = part_inside(half_edge);
    if (part.begin > 0)
      if (const Index made = split(half_edge, part.begin); made != kNone) inside[0] = made;
    const Index rest = surface().find_half_edge(inside[0], inside[1]);
    if (part.end < 1 && rest != kNone) {
      const double begin = inside[0] == whole[0] ? 0 : part.begin;
      if (const Index made = split(rest, (part.end - begin) / (1 - begin)); made != kNone)
        inside[1] = made;
    }
    for (const Index end : inside)
      if (!goes_on_inside(end, inside)) open_wall(end);
    return inside;
  }

  /// Whether another edge of the lip at one of its points is inside the cell.
  [[nodiscard]] bool goes_on_inside(Index point, const PointEdge& edge) const {
    bool goes_on = false;
    surface().for_each_in_fan(surface().point_corner[point], [&](Index corner) {
      if (work_.editor.is_wall(corner / 3)) return;
      for (const Index h : {corner, Surface::previous(corner)})
        if (ends_of(h) != edge && is_above_wall(h) && !part_inside(h).is_empty()) goes_on = true;
    });
    return goes_on;
  }

  Index split(Index half_edge, double fraction) {
    const double snap = snapped_part(half_edge, Snapping::tight, work_.editor, work_.posed);
    if (fraction < snap || fraction > 1 - snap) return kNone;
    return split_posed_edge(half_edge, fraction, work_.editor, work_.posed);
  }

  void open_wall(Index point) {
    if (surface().is_on_border(point)) return;
    const ScratchVector<Index> below = imprint_wall(plane_, point, work_.editor, work_.posed);
    ScratchVector<PointEdge> edges(&scratch());
    for (std::size_t i = 0; i < below.size(); ++i)
      edges.push_back({i == 0 ? point : below[i - 1], below[i]});
    std::vector<LipPair> lips;  // no lips of the operation: one side is removed next
    open_edges(edges, {}, {}, work_.editor, lips);
    for (const LipPair& lip : lips)
      work_.posed.pin(lip.left, Vec3d(work_.posed.position(work_.editor, lip.right)));
  }

  /// Adds the faces of the wall that are connected to one of them, unless they reach a lip outside
  /// of the cell.
  void collect(Index seed, IndexMap& seen, ScratchVector<Index>& faces) const {
    const std::size_t first = faces.size();
    bool is_apart = seen.insert(seed, 0) == kNone;
    if (is_apart) faces.push_back(seed);
    for (std::size_t i = first; i < faces.size(); ++i)
      for (Index h = 3 * faces[i]; h < 3 * faces[i] + 3; ++h) {
        const Index twin = surface().twin[h];
        if (twin == kNone) continue;
        if (!work_.editor.is_wall(twin / 3))
          is_apart = is_apart && !part_inside(h).is_empty();
        else if (seen.insert(twin / 3, 0) == kNone)
          faces.push_back(twin / 3);
      }
    if (!is_apart) faces.resize(first);
  }

  std::span<const PlaneSide> cell_;
  const BladePlane& plane_;
  const Workpiece& work_;
  ScratchVector<PointEdge> lips_;  ///< By their ends, because splits rename half-edges.
};

bool has_fillings(const SurfaceEditor& editor) {
  for (Index mesh = 0; mesh < editor.character().meshes.size(); ++mesh)
    if (!editor.fillings.of(mesh).empty()) return true;
  return false;
}

}  // namespace

bool remove_walls_in_gap(std::span<const PlaneSide> cell, std::span<const CellFace> faces,
                         const BladePlane& plane, const Workpiece& work) {
  if (!has_fillings(work.editor)) return false;
  WallsInGap walls(cell, plane, work);
  if (!walls.find_lips(faces)) return false;
  walls.remove();
  return true;
}

}  // namespace sunder::tear
