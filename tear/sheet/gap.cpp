#include "tear/sheet/gap.h"

#include <algorithm>
#include <limits>

#include "core/internal/ordered.h"
#include "tear/geometry/tolerances.h"
#include "tear/sheet/imprint_cell.h"
#include "tear/sheet/remove_faces.h"
#include "tear/surface/disjoint_sets.h"

namespace sunder::tear {
namespace {

using Corners = std::array<Vec3d, 3>;
using Word = CellSides::Word;

Corners posed_corners(Index face, CellSides& sides) {
  const Index* points = &sides.editor().surface().corner_point[3 * face];
  const auto at = [&](Index point) { return sides.posed().position(sides.editor(), point); };
  return {at(points[0]), at(points[1]), at(points[2])};
}

/// A convex polygon that is clipped in turn by half-spaces. A triangle gains at most one corner by
/// each of them.
struct Polygon {
  explicit Polygon(ScratchMemory& memory) : corners(&memory), clipped(&memory) {}

  /// Sutherland and Hodgman 1974.
  void clip(const PlaneSide& side) {
    clipped.clear();
    for (std::size_t i = 0; i < corners.size(); ++i) {
      const Vec3d &a = corners[i], &b = corners[(i + 1) % corners.size()];
      const double at_a = side.value(a), at_b = side.value(b);
      if (at_a > 0) clipped.push_back(a);
      if ((at_a > 0) != (at_b > 0)) clipped.push_back(a + at_a / (at_a - at_b) * (b - a));
    }
    corners.swap(clipped);
  }

  ScratchVector<Vec3d> corners, clipped;
};

/// The half-space on whose plane an edge lies, the first if there are two; kNone if there is none.
Index side_of_edge(std::span<const PlaneSide> cell, const Vec3d& a, const Vec3d& b) {
  Index nearest = kNone;
  double least = std::numeric_limits<double>::infinity();
  for (Index side = 0; side < cell.size(); ++side) {
    const double away = std::max(std::abs(cell[side].value(a)), std::abs(cell[side].value(b)));
    if (away >= least) continue;
    nearest = side;
    least = away;
  }
  // An end may be off the plane by the distance of snapping, where a face was too small for a new
  // point.
  const double rounding = std::max(a.cwiseAbs().maxCoeff(), b.cwiseAbs().maxCoeff());
  return least <= kOnSideEdges * norm(b - a) + kOnSideCoordinates * rounding ? nearest : kNone;
}

/// The parts of removed faces that are connected by edges.
class RemovedParts {
 public:
  RemovedParts(std::span<const Index> faces, const RemovedFaces& removed, CellSides& sides,
               CellRim& rim)
      : part_of_(faces.size(), kNone, &sides.memory()) {
    const Surface& surface = sides.editor().surface();
    const auto count = static_cast<Index>(faces.size());
    DisjointSets sets(count, sides.memory());
    for (Index i = 0; i < count; ++i)
      for (Index h = 3 * faces[i]; h < 3 * faces[i] + 3; ++h) {
        if (surface.twin[h] == kNone || surface.twin[h] < h) continue;  // each edge once
        const Index other = removed.find(surface.twin[h] / 3);
        if (other != kNone) sets.unite_with_lesser(i, other);
      }
    for (Index i = 0; i < count; ++i) {
      const Index root = sets.find(i);
      if (root == i) {  // the first face of its part
        part_of_[i] = static_cast<Index>(rim.areas.size());
        rim.areas.push_back(Vec3d::Zero());
      }
      part_of_[i] = part_of_[root];
      const Corners corners = posed_corners(faces[i], sides);
      rim.areas[part_of_[i]] += 0.5 * (corners[1] - corners[0]).cross(corners[2] - corners[0]);
    }
  }

  [[nodiscard]] Index part_of(Index face) const { return part_of_[face]; }

 private:
  ScratchVector<Index> part_of_;  ///< Per removed face.
};

void describe_rim(const RemovedFaces& removed, const RemovedParts& parts, CellSides& sides,
                  CellRim& rim) {
  const Surface& surface = sides.editor().surface();
  rim.edges.reserve(removed.border().size());
  for (const auto& [half_edge, face] : removed.border()) {
    const Index from = surface.corner_point[half_edge],
                to = surface.corner_point[Surface::next(half_edge)];
    rim.edges.push_back({{from, to},
                         side_of_edge(sides.cell(), sides.posed().position(sides.editor(), from),
                                      sides.posed().position(sides.editor(), to)),
                         parts.part_of(face)});
  }
}

/// Finds the faces inside a cell after its imprint, among the faces that were imprinted and their
/// children. A child need not be compared with half-spaces that contain all of its ancestor.
class FacesInside {
 public:
  /// @param faces  as they were imprinted.
  FacesInside(CellSides& sides, std::span<const CellFace> faces)
      : sides_(sides), faces_(faces), number_(faces.size(), sides.memory()) {
    for (Index i = 0; i < faces.size(); ++i) number_.insert(faces[i].face, i);
  }

  /// @param area_posed  of the faces, added to.
  [[nodiscard]] ScratchVector<Index> find(double& area_posed) {
    const SurfaceEditor& editor = sides_.editor();
    const Index first = editor.stage.first_triangle(), end = editor.surface().triangle_count();
    ScratchVector<Index> inside(&sides_.memory());
    inside.reserve(faces_.size() + (end - first));
    const auto add = [&](Index face, Index ancestor) {
      if (ancestor == kNone) return;
      const CellSides::OfFace of = sides_.at(faces_[ancestor].places);
      if (sides_.is_beyond(of)) return;
      const Corners corners = posed_corners(face, sides_);
      if (!has_middle_inside(corners, of)) return;
      inside.push_back(face);
      area_posed += 0.5 * norm((corners[1] - corners[0]).cross(corners[2] - corners[0]));
    };
    for (Index i = 0; i < faces_.size(); ++i) add(faces_[i].face, i);
    for (Index t = first; t < end; ++t) add(t, number_.find(editor.stage.ancestor(t)));
    return inside;
  }

 private:
  [[nodiscard]] bool has_middle_inside(const Corners& corners,
                                       const CellSides::OfFace& ancestor) const {
    const Vec3d middle = (corners[0] + corners[1] + corners[2]) / 3;
    bool is_inside = true;
    for (Index w = 0; w < sides_.word_count() && is_inside; ++w)
      CellSides::for_each_bit(ancestor.doubtful(w) & sides_.all(w), w, [&](Index side) {
        is_inside = is_inside && sides_.cell()[side].value(middle) > 0;
      });
    return is_inside;
  }

  CellSides& sides_;
  std::span<const CellFace> faces_;
  IndexMap number_;
};

}  // namespace

bool is_edge_in_cell(const CellFace& face, Index k, CellSides& sides) {
  const Index l = (k + 1) % 3;
  const CellSides::OfFace of = sides.at(face.places);
  Word beyond = 0;
  for (Index w = 0; w < sides.word_count(); ++w) beyond |= of.outside[k][w] & of.outside[l][w];
  if (beyond != 0) return false;
  const Index* points = &sides.editor().surface().corner_point[3 * face.face];
  const auto at = [&](Index corner) {
    return sides.posed().position(sides.editor(), points[corner]);
  };
  double begin = 0, end = 1;
  bool is_beside = false;
  for (Index w = 0; w < sides.word_count(); ++w)
    CellSides::for_each_bit(~(of.inside[k][w] & of.inside[l][w]) & sides.all(w), w,
                            [&](Index number) {
                              const PlaneSide& side = sides.cell()[number];
                              const double at_a = side.value(at(k)), at_b = side.value(at(l));
                              is_beside |= at_a < 0 && at_b < 0;
                              if (is_beside) return;
                              if (at_a < 0) begin = std::max(begin, at_a / (at_a - at_b));
                              if (at_b < 0) end = std::min(end, at_a / (at_a - at_b));
                            });
  return !is_beside && end - begin > kInCellEdges;
}

bool is_face_in_cell(const CellFace& face, CellSides& sides) {
  const CellSides::OfFace of = sides.at(face.places);
  if (sides.is_beyond(of)) return false;
  bool is_in = true;
  const Corners corners = posed_corners(face.face, sides);
  const ScratchMemory::Frame memory_of_step(sides.memory());
  Polygon polygon(sides.memory());
  for (Index w = 0; w < sides.word_count(); ++w)
    CellSides::for_each_bit(of.doubtful(w) & sides.all(w), w, [&](Index number) {
      if (!is_in) return;
      if (polygon.corners.empty()) polygon.corners.assign(corners.begin(), corners.end());
      polygon.clip(sides.cell()[number]);
      is_in = polygon.corners.size() >= 3;
    });
  return is_in;
}

ScratchVector<CellFace> faces_in_cell(CellSides& sides) {
  const std::span<const PlaneSide> cell = sides.cell();
  const Frame frame = sides.posed().frame_along(
      cell.size() < 2 ? axes_along(Vec3d::Zero()) : axes_along(cell[0].normal, cell[1].normal),
      sides.editor());
  ScratchVector<FramedPlaneSide> framed(&sides.memory());
  framed.reserve(cell.size());
  for (const PlaneSide& side : cell) framed.emplace_back(frame, side);
  return faces_in_cell(sides, frame, [&](const FrameBox& box) {
    return std::none_of(framed.begin(), framed.end(),
                        [&](const FramedPlaneSide& side) { return side.is_beside(box); });
  });
}

GapRemoval remove_cell(CellSides& sides, std::span<const CellFace> faces, SurfaceEditor& editor,
                       CellRim* rim) {
  GapRemoval removal;
  if (faces.empty()) return removal;
  const CellImprint imprint = imprint_cell(sides, faces, editor);
  removal.faces_crossed = imprint.faces_crossed;
  removal.blocked = imprint.blocked;
  const ScratchVector<Index> inside = FacesInside(sides, faces).find(removal.area_posed);
  if (inside.empty()) return removal;
  removal.faces_removed = static_cast<Index>(inside.size());
  const RemovedFaces removed(inside, editor);
  if (rim == nullptr) {
    removed.remove(editor, sides.posed());
    return removal;
  }
  const RemovedParts parts(inside, removed, sides, *rim);
  removed.remove(editor, sides.posed());
  describe_rim(removed, parts, sides, *rim);
  return removal;
}

}  // namespace sunder::tear
