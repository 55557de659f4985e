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

using GapWord = CellSides::Word;

/// References to the posed corners of a face: copies would be read before they are stored.
struct GapCorners {
  const Vec3d &a, &b, &c;

  [[nodiscard]] Vec3d area() const { return 0.5 * (b - a).cross(c - a); }
  [[nodiscard]] Vec3d middle() const { return (a + b + c) / 3; }
};

/// All points must be covered.
GapCorners posed_corners(Index face, CellSides& sides) {
  const Index* points = &sides.editor().surface().corner_point[3 * face];
  const auto at = [&](Index point) -> const Vec3d& {
    return sides.posed().position(sides.editor(), point);
  };
  return {at(points[0]), at(points[1]), at(points[2])};
}

/// The corners of a face that is as it was.
GapCorners corners_of(const CellFace& face, const CellSides& sides) {
  return {sides.position(face.places[0]), sides.position(face.places[1]),
          sides.position(face.places[2])};
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
    double away = std::abs(cell[side].value(a));
    if (away >= least) continue;
    away = std::max(away, std::abs(cell[side].value(b)));
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
  /// @param areas  per face, its posed area vector.
  /// @param sets  the faces that are connected.
  RemovedParts(std::span<const Vec3d> areas, DisjointSets& sets, ScratchMemory& memory,
               CellRim& rim)
      : part_of_(areas.size(), kNone, &memory) {
    for (Index i = 0; i < areas.size(); ++i) {
      const Index root = sets.find(i);
      if (root == i) {  // the first face of its part
        part_of_[i] = static_cast<Index>(rim.areas.size());
        rim.areas.push_back(Vec3d::Zero());
      }
      part_of_[i] = part_of_[root];
      rim.areas[part_of_[i]] += areas[i];
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
  FacesInside(CellSides& sides, std::span<const CellFace> faces, bool has_turned_edges)
      : sides_(sides),
        faces_(faces),
        has_turned_edges_(has_turned_edges),
        crossed_(faces.size(), sides.memory()) {}

  /// Appends the faces and their posed area vectors. @return their posed area.
  double find(ScratchVector<Index>& inside, ScratchVector<Vec3d>& areas) {
    const SurfaceEditor& editor = sides_.editor();
    const Index first = editor.stage.first_triangle(), end = editor.surface().triangle_count();
    inside.reserve(faces_.size() + (end - first));
    areas.reserve(faces_.size() + (end - first));
    sides_.posed().cover(editor.surface().point_count());
    double area = 0;
    const auto add = [&](Index face, const GapCorners& corners) {
      const Vec3d of_face = corners.area();
      inside.push_back(face);
      areas.push_back(of_face);
      area += norm(of_face);
    };
    const auto add_if_inside = [&](Index face, const CellSides::OfFace& of) {
      if (sides_.is_beyond(of)) return;
      const GapCorners corners = posed_corners(face, sides_);
      if (has_middle_inside(corners, of)) add(face, corners);
    };
    for (Index i = 0; i < faces_.size(); ++i) {
      const Index face = faces_[i].face;
      if (faces_[i].is_inside) {  // and therefore as it was
        add(face, corners_of(faces_[i], sides_));
        continue;
      }
      crossed_.insert(face, i);
      add_if_inside(face, sides_.at(faces_[i].places));
    }
    Index of_ancestor = kNone, ancestor = kNone;  // most children follow one another
    for (Index t = first; t < end; ++t) {
      if (ancestor != editor.stage.ancestor(t)) {
        ancestor = editor.stage.ancestor(t);
        of_ancestor = crossed_.find(ancestor);
      }
      if (of_ancestor != kNone) add_if_inside(t, sides_.at(faces_[of_ancestor].places));
    }
    return area;
  }

 private:
  [[nodiscard]] bool has_middle_inside(const GapCorners& corners,
                                       const CellSides::OfFace& ancestor) const {
    const Vec3d middle = corners.middle();
    bool is_inside = true;
    for (Index w = 0; w < sides_.word_count() && is_inside; ++w)
      CellSides::for_each_bit(doubtful(ancestor, w) & sides_.all(w), w, [&](Index side) {
        is_inside = is_inside && sides_.cell()[side].value(middle) > 0;
      });
    return is_inside;
  }

  [[nodiscard]] GapWord doubtful(const CellSides::OfFace& ancestor, Index word) const {
    return has_turned_edges_ ? ~GapWord{0} : ancestor.doubtful(word);
  }

  CellSides& sides_;
  std::span<const CellFace> faces_;
  bool has_turned_edges_;
  IndexMap crossed_;  ///< Index in faces_ of each face that may have children.
};

}  // namespace

bool is_edge_in_cell(const CellFace& face, Index k, CellSides& sides) {
  const Index l = (k + 1) % 3;
  const CellSides::OfFace of = sides.at(face.places);
  GapWord beyond = 0;
  for (Index w = 0; w < sides.word_count(); ++w) beyond |= of.outside[k][w] & of.outside[l][w];
  if (beyond != 0) return false;
  const Vec3d &a = sides.position(face.places[k]), &b = sides.position(face.places[l]);
  double begin = 0, end = 1;
  bool is_beside = false;
  for (Index w = 0; w < sides.word_count(); ++w)
    CellSides::for_each_bit(~(of.inside[k][w] & of.inside[l][w]) & sides.all(w), w,
                            [&](Index number) {
                              const PlaneSide& side = sides.cell()[number];
                              const double at_a = side.value(a), at_b = side.value(b);
                              is_beside |= at_a < 0 && at_b < 0;
                              if (is_beside) return;
                              if (at_a < 0) begin = std::max(begin, at_a / (at_a - at_b));
                              if (at_b < 0) end = std::min(end, at_a / (at_a - at_b));
                            });
  return !is_beside && end - begin > kInCellEdges;
}

bool is_face_in_cell(CellFace& face, CellSides& sides) {
  const CellSides::OfFace of = sides.at(face.places);
  face.is_inside = sides.is_surely_inside(of);
  if (face.is_inside) return true;
  if (sides.is_beyond(of)) return false;
  // What is left around a corner inside always has an area.
  if (sides.has_corner_surely_inside(of)) return true;
  bool is_in = true;
  const GapCorners corners = corners_of(face, sides);
  const ScratchMemory::Frame memory_of_step(sides.memory());
  Polygon polygon(sides.memory());
  for (Index w = 0; w < sides.word_count(); ++w)
    CellSides::for_each_bit(of.doubtful(w) & sides.all(w), w, [&](Index number) {
      if (!is_in) return;
      if (polygon.corners.empty()) polygon.corners.assign({corners.a, corners.b, corners.c});
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
  ScratchVector<Index> inside(&sides.memory());
  ScratchVector<Vec3d> areas(&sides.memory());
  removal.area_posed = FacesInside(sides, faces, imprint.has_turned_edges).find(inside, areas);
  if (inside.empty()) return removal;
  removal.faces_removed = static_cast<Index>(inside.size());
  if (rim == nullptr) {
    RemovedFaces(inside, editor).remove(editor, sides.posed());
    return removal;
  }
  DisjointSets sets(removal.faces_removed, sides.memory());
  const RemovedFaces removed(inside, editor, &sets);
  const RemovedParts parts(areas, sets, sides.memory(), *rim);
  removed.remove(editor, sides.posed());
  describe_rim(removed, parts, sides, *rim);
  return removal;
}

}  // namespace sunder::tear
