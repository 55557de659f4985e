#include "tear/sheet/gap.h"

#include <algorithm>
#include <limits>
#include <unordered_set>

#include "core/internal/ordered.h"
#include "tear/geometry/tolerances.h"
#include "tear/internal/surface.h"
#include "tear/surface/disconnect.h"
#include "tear/surface/disjoint_sets.h"

namespace sunder::tear {
namespace {

using Corners = std::array<Vec3d, 3>;

Corners posed_corners(Index face, const SurfaceEditor& editor, PosedPoints& posed) {
  const Index* points = &editor.surface().corner_point[3 * face];
  return {posed.position(editor, points[0]), posed.position(editor, points[1]),
          posed.position(editor, points[2])};
}

bool is_edge_in_cell(const Cell& cell, const Vec3d& a, const Vec3d& b) {
  double begin = 0, end = 1;
  for (const PlaneSide& side : cell) {
    const double at_a = side.value(a), at_b = side.value(b);
    if (at_a < 0 && at_b < 0) return false;
    if (at_a < 0) begin = std::max(begin, at_a / (at_a - at_b));
    if (at_b < 0) end = std::min(end, at_a / (at_a - at_b));
  }
  return end - begin > kInCellEdges;
}

/// Whether the intersection of a triangle and a cell is more than a border. Sutherland and Hodgman
/// 1974.
bool is_face_in_cell(const Cell& cell, const Corners& corners, std::vector<Vec3d>& polygon,
                     std::vector<Vec3d>& clipped) {
  for (const PlaneSide& side : cell)
    if (std::none_of(corners.begin(), corners.end(),
                     [&](const Vec3d& corner) { return side.value(corner) > 0; }))
      return false;
  polygon.assign(corners.begin(), corners.end());
  for (const PlaneSide& side : cell) {
    clipped.clear();
    for (std::size_t i = 0; i < polygon.size(); ++i) {
      const Vec3d &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
      const double at_a = side.value(a), at_b = side.value(b);
      if (at_a > 0) clipped.push_back(a);
      if ((at_a > 0) != (at_b > 0)) clipped.push_back(a + at_a / (at_a - at_b) * (b - a));
    }
    polygon.swap(clipped);
    if (polygon.size() < 3) return false;
  }
  return true;
}

std::vector<Sheet> sheets_of(const Cell& cell) {
  std::vector<Sheet> sheets(cell.size());
  for (std::size_t i = 0; i < cell.size(); ++i) {
    sheets[i].plane = cell[i];
    for (std::size_t j = 0; j < cell.size(); ++j)
      if (j != i) sheets[i].bounds.push_back({cell[j], static_cast<Index>(j)});
  }
  return sheets;
}

/// Retires faces (ascending) and gives each remaining fan at their points a point of its own.
void remove_faces(const std::vector<Index>& faces, SurfaceEditor& editor, PosedPoints& posed) {
  const Surface& surface = editor.surface();
  const auto stays = [&](Index face) {
    return !std::binary_search(faces.begin(), faces.end(), face);
  };

  // (point, corner) for each remaining corner at the points of the removed faces.
  std::vector<std::array<Index, 2>> remaining;
  for (const Index face : faces)
    for (Index corner = 3 * face; corner < 3 * face + 3; ++corner)
      surface.for_each_in_fan(corner, [&](Index c) {
        if (stays(c / 3)) remaining.push_back({surface.corner_point[c], c});
      });
  std::sort(remaining.begin(), remaining.end());
  remaining.erase(std::unique(remaining.begin(), remaining.end()), remaining.end());

  std::vector<Index> points;
  for (const Index face : faces) {
    for (Index corner = 3 * face; corner < 3 * face + 3; ++corner) {
      points.push_back(surface.corner_point[corner]);
      cut_edge(corner, editor);
    }
    retire_triangle(face, editor);
  }
  std::sort(points.begin(), points.end());
  points.erase(std::unique(points.begin(), points.end()), points.end());
  std::vector<Index> fans, others;
  for (const Index point : points) {
    fans.clear();
    for (auto at =
             std::lower_bound(remaining.begin(), remaining.end(), std::array<Index, 2>{point, 0});
         at != remaining.end() && (*at)[0] == point; ++at) {
      const Index fan = surface.first_of_fan((*at)[1]);
      if (std::find(fans.begin(), fans.end(), fan) == fans.end()) fans.push_back(fan);
    }
    editor.connectivity.set_point_corner(point, fans.empty() ? kNone : fans.front());
    for (std::size_t fan = 1; fan < fans.size(); ++fan) {
      others = fans;
      others.erase(others.begin() + static_cast<std::ptrdiff_t>(fan));
      std::vector<Index> corners;
      surface.for_each_in_fan(fans[fan], [&](Index corner) { corners.push_back(corner); });
      posed.pin(separate_fan(corners, others, editor), Vec3d(posed.position(editor, point)));
    }
  }
}

/// The half-space on whose plane an edge lies, the first if there are two; kNone if there is none.
Index side_of_edge(const Cell& cell, const Vec3d& a, const Vec3d& b) {
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

/// The border between removed and remaining faces. It is collected before the removal and described
/// after it, when points have their final indices.
class RimOfRemoved {
 public:
  /// @param faces  the faces to be removed, ascending.
  RimOfRemoved(const std::vector<Index>& faces, const SurfaceEditor& editor, PosedPoints& posed) {
    const Surface& surface = editor.surface();
    const auto count = static_cast<Index>(faces.size());
    DisjointSets parts(count, *std::pmr::get_default_resource());
    for (Index i = 0; i < count; ++i)
      for (Index h = 3 * faces[i]; h < 3 * faces[i] + 3; ++h) {
        const Index twin = surface.twin[h];
        if (twin == kNone) continue;
        const auto other = std::lower_bound(faces.begin(), faces.end(), twin / 3);
        if (other != faces.end() && *other == twin / 3)
          parts.unite_with_lesser(i, static_cast<Index>(other - faces.begin()));
        else
          staying_.push_back({twin, i});
      }
    std::vector<Index> part_of_root(count, kNone);
    for (Index i = 0; i < count; ++i) {
      Index& part = part_of_root[parts.find(i)];
      if (part == kNone) {
        part = static_cast<Index>(areas_.size());
        areas_.push_back(Vec3d::Zero());
      }
      const Corners corners = posed_corners(faces[i], editor, posed);
      areas_[part] += 0.5 * (corners[1] - corners[0]).cross(corners[2] - corners[0]);
    }
    for (auto& [half_edge, face] : staying_) face = part_of_root[parts.find(face)];
  }

  void tell(const Cell& cell, const SurfaceEditor& editor, PosedPoints& posed, CellRim& rim) const {
    const Surface& surface = editor.surface();
    rim = {};
    for (const auto& [half_edge, part] : staying_) {
      const Index from = surface.corner_point[half_edge],
                  to = surface.corner_point[Surface::next(half_edge)];
      rim.edges.push_back(
          {{from, to},
           side_of_edge(cell, posed.position(editor, from), posed.position(editor, to)),
           part});
    }
    rim.areas = areas_;
  }

 private:
  /// (remaining half-edge, removed part on its other side)
  std::vector<std::array<Index, 2>> staying_;
  std::vector<Vec3d> areas_;
};

}  // namespace

std::vector<Index> faces_in_cell(const Cell& cell, const SurfaceEditor& editor,
                                 PosedPoints& posed) {
  std::vector<Index> faces;
  std::vector<Vec3d> polygon, clipped;
  const Frame frame = posed.frame_along(
      cell.size() < 2 ? axes_along(Vec3d::Zero()) : axes_along(cell[0].normal, cell[1].normal),
      editor);
  std::vector<FramedPlaneSide> sides;
  for (const PlaneSide& side : cell) sides.emplace_back(frame, side);
  const auto may_hold_any = [&](const FrameBox& box) {
    return std::none_of(sides.begin(), sides.end(),
                        [&](const FramedPlaneSide& side) { return side.is_beside(box); });
  };
  posed.for_each_face(editor, frame, may_hold_any, [&](Index face) {
    if (is_face_in_cell(cell, posed_corners(face, editor, posed), polygon, clipped))
      faces.push_back(face);
  });
  std::sort(faces.begin(), faces.end());
  return faces;
}

std::vector<Index> faces_in_cell(const Cell& cell, const std::vector<Index>& seeds,
                                 const std::function<bool(Index)>& is_wanted,
                                 const SurfaceEditor& editor, PosedPoints& posed) {
  const Surface& surface = editor.surface();
  std::vector<Index> faces, open;
  std::unordered_set<Index> seen;  // lookups only, never iterated
  std::vector<Vec3d> polygon, clipped;
  const auto visit = [&](Index face) {
    if (seen.insert(face).second && is_wanted(face)) open.push_back(face);
  };
  for (const Index seed : seeds)
    if (!surface.has_repeated_point(seed) &&
        is_face_in_cell(cell, posed_corners(seed, editor, posed), polygon, clipped))
      visit(seed);
  while (!open.empty()) {
    const Index face = open.back();
    open.pop_back();
    faces.push_back(face);
    const Corners corners = posed_corners(face, editor, posed);
    for (Index k = 0; k < 3; ++k) {
      const Index twin = surface.twin[3 * face + k];
      if (twin != kNone && is_edge_in_cell(cell, corners[k], corners[(k + 1) % 3])) visit(twin / 3);
    }
  }
  std::sort(faces.begin(), faces.end());
  return faces;
}

GapRemoval remove_cell(const Cell& cell, const std::vector<Index>& faces, SurfaceEditor& editor,
                       PosedPoints& posed, CellRim* rim) {
  GapRemoval removal;
  if (faces.empty()) return removal;
  const std::vector<Sheet> sheets = sheets_of(cell);
  const SheetImprint imprint = imprint_sheets(sheets, faces, editor, posed);
  removal.faces_crossed = imprint.faces_crossed;
  removal.blocked = imprint.blocked;

  std::vector<Index> candidates = faces;
  for (Index t = editor.stage.first_triangle(); t < editor.surface().triangle_count(); ++t)
    if (std::binary_search(faces.begin(), faces.end(), editor.stage.ancestor(t)))
      candidates.push_back(t);
  std::vector<Index> inside;
  for (const Index face : candidates) {
    const Corners corners = posed_corners(face, editor, posed);
    const Vec3d middle = (corners[0] + corners[1] + corners[2]) / 3;
    if (!std::all_of(cell.begin(), cell.end(),
                     [&](const PlaneSide& side) { return side.value(middle) > 0; }))
      continue;
    inside.push_back(face);
    removal.area_posed += 0.5 * norm((corners[1] - corners[0]).cross(corners[2] - corners[0]));
  }
  if (inside.empty()) return removal;
  removal.faces_removed = static_cast<Index>(inside.size());
  if (rim == nullptr) {
    remove_faces(inside, editor, posed);
  } else {
    const RimOfRemoved of_removed(inside, editor, posed);
    remove_faces(inside, editor, posed);
    of_removed.tell(cell, editor, posed, *rim);
  }
  return removal;
}

}  // namespace sunder::tear
