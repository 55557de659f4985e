#include "tear/sheet/imprint_sheets.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <memory_resource>

#include "core/internal/ordered.h"
#include "tear/geometry/tolerances.h"
#include "tear/internal/surface.h"
#include "tear/path/snapping.h"
#include "tear/sheet/face_lines.h"
#include "tear/surface/split.h"

namespace sunder::tear {
namespace {

/// The place where the plane of a sheet crosses an edge. The edge has the direction of its lower
/// half-edge, so that both faces compute the same numbers.
struct SheetCrossing {
  Index half_edge = kNone;
  Index sheet = kNone;
  double fraction = 0;
  Vec3d position = Vec3d::Zero();
  /// Distance along the edge per distance from the sheet. The greater it is, the less precise is
  /// the crossing.
  double slant = 1;
  Index point = kNone;  ///< Set when the crossing is imprinted.

  [[nodiscard]] bool is_before(const SheetCrossing& other) const {
    if (half_edge != other.half_edge) return half_edge < other.half_edge;
    return sheet < other.sheet;
  }
};

/// A face as it was before any edge was split.
struct SheetFace {
  Index triangle = kNone;
  std::array<Index, 3> points = {};
  std::array<Index, 3> edges = {};       ///< The half-edges, or their twins if those are lower.
  std::array<bool, 3> is_reversed = {};  ///< Whether the edge runs against the face's half-edge.
};

/// Per corner of a face: 1 inside the plane of a sheet, -1 outside, 0 on it.
using CornerSides = std::array<int, 3>;

/// One end of a line in a face: at a corner on the plane, at a crossing of one of its edges, or at
/// a place where the sheet meets a bound.
struct SheetLineEnd {
  Vec3d position = Vec3d::Zero();
  Index corner = kNone;  ///< Point.
  Index crossed_edge = kNone;
  Index bound = kNone;  ///< Index in Sheet::bounds.
};

class SheetImprinter {
 public:
  SheetImprinter(std::span<const Sheet> sheets, SurfaceEditor& editor, PosedPoints& posed)
      : sheets_(sheets),
        editor_(editor),
        posed_(posed),
        faces_(&editor.scratch()),
        crossings_(&editor.scratch()),
        children_(&editor.scratch()),
        corners_(&editor.scratch()),
        result_{ScratchVector<ScratchVector<PointEdge>>(&editor.scratch())} {
    result_.edges.resize(sheets.size());
  }

  SheetImprint run(std::span<const Index> faces) {
    editor_.stage.begin();
    faces_.reserve(faces.size());
    crossings_.reserve(2 * sheets_.size() * faces.size());
    for (auto& edges : result_.edges) edges.reserve(2 * faces.size());
    for (const Index face : faces) add_face(face);
    split_edges();
    index_children();
    for (const SheetFace& face : faces_) draw_lines(face);
    return std::move(result_);
  }

 private:
  void add_face(Index triangle) {
    const Surface& surface = editor_.surface();
    SheetFace face{triangle, {}, {}, {}};
    bool is_met = false;
    for (Index k = 0; k < 3; ++k) {
      const Index h = 3 * triangle + k, twin = surface.twin[h];
      face.points[k] = surface.corner_point[h];
      face.edges[k] = std::min(h, twin);  // kNone is the highest
      face.is_reversed[k] = twin < h;
    }
    for (Index sheet = 0; sheet < sheets_.size(); ++sheet) {
      const CornerSides sides = sides_of(face, sheet);
      is_met = is_met || is_outside(face, sheet, sides) || is_across(sides);
      for (Index k = 0; k < 3; ++k) {
        if (sides[k] * sides[(k + 1) % 3] >= 0) continue;
        const SheetCrossing crossing = crossing_of(face, k, sheet);
        if (is_within_bounds(sheet, crossing.position)) crossings_.push_back(crossing);
      }
    }
    if (is_met) faces_.push_back(face);
  }

  [[nodiscard]] CornerSides sides_of(const SheetFace& face, Index sheet) {
    posed_.compare_with(sheets_[sheet].plane);
    CornerSides sides;
    for (std::size_t k = 0; k < 3; ++k)
      sides[k] = posed_.is_on_plane(editor_, face.points[k]) ? 0
                 : posed_.is_inside(editor_, face.points[k]) ? 1
                                                             : -1;
    return sides;
  }
  static bool is_across(const CornerSides& sides) {
    return *std::min_element(sides.begin(), sides.end()) < 0 &&
           *std::max_element(sides.begin(), sides.end()) > 0;
  }
  /// Whether a face that is not across belongs to the outside of the plane. If it lies in the
  /// plane, it belongs to the side of the body behind it.
  [[nodiscard]] bool is_outside(const SheetFace& face, Index sheet, const CornerSides& sides) {
    if (*std::max_element(sides.begin(), sides.end()) > 0) return false;
    if (*std::min_element(sides.begin(), sides.end()) < 0) return true;
    const Vec3d a = posed_.position(editor_, face.points[0]),
                b = posed_.position(editor_, face.points[1]),
                c = posed_.position(editor_, face.points[2]);
    return dot(Vec3d(b - a).cross(Vec3d(c - a)), sheets_[sheet].plane.normal) > 0;
  }

  /// Where the sheet's plane crosses edge k of a face, whose ends are on both sides of it.
  [[nodiscard]] SheetCrossing crossing_of(const SheetFace& face, Index k, Index sheet) {
    const Index from = face.points[face.is_reversed[k] ? (k + 1) % 3 : k],
                to = face.points[face.is_reversed[k] ? k : (k + 1) % 3];
    const Vec3d at_from = posed_.position(editor_, from), at_to = posed_.position(editor_, to);
    const PlaneSide& plane = sheets_[sheet].plane;
    const double value_from = plane.value(at_from), value_to = plane.value(at_to);
    const double fraction =
        value_from == value_to ? 0.0 : std::clamp(value_from / (value_from - value_to), 0.0, 1.0);
    const double slant = norm(at_to - at_from) / std::max(std::abs(value_from - value_to),
                                                          std::numeric_limits<double>::min());
    return {face.edges[k], sheet, fraction, at_from + fraction * (at_to - at_from), slant, kNone};
  }

  bool is_within_bounds(Index sheet, const Vec3d& position) const {
    const auto& bounds = sheets_[sheet].bounds;
    return std::all_of(bounds.begin(), bounds.end(),
                       [&](const Sheet::Bound& bound) { return bound.side.contains(position); });
  }

  void split_edges() {
    std::sort(crossings_.begin(), crossings_.end(),
              [](const SheetCrossing& a, const SheetCrossing& b) { return a.is_before(b); });
    crossings_.erase(std::unique(crossings_.begin(), crossings_.end(),
                                 [](const SheetCrossing& a, const SheetCrossing& b) {
                                   return !a.is_before(b) && !b.is_before(a);
                                 }),
                     crossings_.end());
    // The end points of all edges are collected first, because splitting one edge changes
    // half-edges.
    struct Edge {
      std::size_t begin, end;
      Index from, to;
      double stored;  ///< stored_part()
    };
    ScratchVector<Edge> edges(&editor_.scratch());
    edges.reserve(crossings_.size());
    for (std::size_t begin = 0, end = 0; begin < crossings_.size(); begin = end) {
      const Index h = crossings_[begin].half_edge;
      while (end < crossings_.size() && crossings_[end].half_edge == h) ++end;
      edges.push_back({begin, end, editor_.surface().corner_point[h],
                       editor_.surface().corner_point[Surface::next(h)], stored_part(h, editor_)});
    }
    ScratchVector<SheetCrossing*> along(&editor_.scratch());
    along.reserve(sheets_.size());
    for (const Edge& edge : edges) {
      along.clear();
      for (std::size_t i = edge.begin; i < edge.end; ++i) along.push_back(&crossings_[i]);
      std::sort(along.begin(), along.end(), [](const SheetCrossing* a, const SheetCrossing* b) {
        return a->fraction != b->fraction ? a->fraction < b->fraction : a->sheet < b->sheet;
      });
      split_edge(edge.from, edge.to, edge.stored, along);
    }
  }

  /// @param stored  the least fraction of the edge between two places that are stored as different
  ///         ones.
  void split_edge(Index from, Index to, double stored, std::span<SheetCrossing* const> along) {
    Index last = from;
    double last_fraction = 0;
    for (SheetCrossing* crossing : along) {
      const double snap =
          std::min(kFarthestSnapEdges,
                   stored * crossing->slant);  // ends nearer than this are stored on the sheet
      if (crossing->fraction - last_fraction <= snap) {
        crossing->point = last;
      } else if (crossing->fraction >= 1 - snap) {
        crossing->point = to;
      } else {
        const double fraction = (crossing->fraction - last_fraction) / (1 - last_fraction);
        Index h = editor_.surface().find_half_edge(last, to);
        Index point = kNone;
        if (h != kNone) {
          point = tear::split_edge(h, fraction, editor_, Rounding::as_fits);
        } else if (h = editor_.surface().find_half_edge(to, last); h != kNone) {
          point = tear::split_edge(h, 1 - fraction, editor_, Rounding::as_fits);
        }
        if (point == kNone) {
          // The faces are too small for another point. An end nearby is used instead; one that is
          // far off is not on the line, and the crossing is blocked.
          const double near = std::max(kSnapEdges, 4 * snap);
          if (fraction <= near || fraction >= 1 - near)
            crossing->point = fraction < 0.5 ? last : to;
          continue;
        }
        posed_.pin(point, crossing->position);
        crossing->point = last = point;
        last_fraction = crossing->fraction;
      }
    }
  }

  [[nodiscard]] Index point_at_crossing(Index half_edge, Index sheet) const {
    const SheetCrossing wanted{half_edge, sheet, 0, Vec3d::Zero(), 1, kNone};
    const auto found = std::lower_bound(
        crossings_.begin(), crossings_.end(), wanted,
        [](const SheetCrossing& a, const SheetCrossing& b) { return a.is_before(b); });
    return found != crossings_.end() && !wanted.is_before(*found) ? found->point : kNone;
  }

  void index_children() {
    children_.reserve(editor_.surface().triangle_count() - editor_.stage.first_triangle());
    for (Index t = editor_.stage.first_triangle(); t < editor_.surface().triangle_count(); ++t) {
      const Index ancestor = editor_.stage.ancestor(t);
      if (ancestor < editor_.stage.first_triangle()) children_.push_back({ancestor, t});
    }
    std::sort(children_.begin(), children_.end());
  }

  /// Calls visit(from, to, edge) for each line in which a sheet meets a face, directed so that the
  /// inside of its plane is on the left: the line across the face, or, if it belongs to the
  /// outside, its edges on the plane. Those of two faces outside cancel each other.
  template <class Visit>
  void for_each_line(const SheetFace& face, Index sheet, Visit visit) {
    const CornerSides sides = sides_of(face, sheet);
    SheetLineEnd from, to;
    if (is_across(sides)) {
      for (Index k = 0; k < 3; ++k) {
        const int next = sides[(k + 1) % 3], previous = sides[(k + 2) % 3];
        if (sides[k] == 0)
          (previous > 0 ? from : to) = at_corner(face, k);
        else if (sides[k] * next < 0)
          (next < 0 ? from : to) =
              SheetLineEnd{crossing_of(face, k, sheet).position, kNone, face.edges[k], kNone};
      }
      if (clip(sheet, from, to)) visit(from, to, kNone);
    } else if (is_outside(face, sheet, sides)) {
      for (Index k = 0; k < 3; ++k) {
        if (sides[k] != 0 || sides[(k + 1) % 3] != 0) continue;
        from = at_corner(face, (k + 1) % 3);
        to = at_corner(face, k);
        if (clip(sheet, from, to)) visit(from, to, face.edges[k]);
      }
    }
  }
  [[nodiscard]] SheetLineEnd at_corner(const SheetFace& face, Index k) {
    return {posed_.position(editor_, face.points[k]), face.points[k], kNone, kNone};
  }

  /// Clips a line by the bounds of its sheet. @return false if nothing is left.
  [[nodiscard]] bool clip(Index sheet, SheetLineEnd& from, SheetLineEnd& to) const {
    ClippedLine clipped{from.position, to.position - from.position};
    const auto& bounds = sheets_[sheet].bounds;
    for (Index i = 0; i < bounds.size(); ++i) switch (clipped.clip(bounds[i].side)) {
        case ClippedLine::Change::none: break;
        case ClippedLine::Change::all: return false;
        case ClippedLine::Change::first:
          from = {clipped.place(clipped.first), kNone, kNone, i};
          break;
        case ClippedLine::Change::last: to = {clipped.place(clipped.last), kNone, kNone, i}; break;
      }
    return clipped.first < clipped.last;
  }

  /// @param edge  along which the line goes; kNone for a line across the face.
  Index point_of(const SheetLineEnd& end, const SheetFace& face, Index sheet, Index edge,
                 FaceLines& lines) {
    if (end.corner != kNone) return end.corner;
    if (end.bound == kNone) return point_at_crossing(end.crossed_edge, sheet);
    const Index other = sheets_[sheet].bounds[end.bound].sheet;
    if (other == kNone && edge == kNone) return lines.imprint(end.position);
    // The line of the other sheet, or of the face beyond the edge, ends in the same point.
    const std::array<Index, 3> key =
        edge != kNone ? std::array{edge, sheet, static_cast<Index>(sheets_.size()) + end.bound}
                      : std::array{face.triangle, std::min(sheet, other), std::max(sheet, other)};
    const auto known = corners_.find(key);
    if (known != corners_.end()) return known->second;
    return corners_[key] = lines.imprint(end.position);
  }

  void draw_lines(const SheetFace& face) {
    const auto begin = std::lower_bound(children_.begin(), children_.end(),
                                        std::array<Index, 2>{face.triangle, 0});
    const auto end =
        std::lower_bound(begin, children_.end(), std::array<Index, 2>{face.triangle + 1, 0});
    FaceLines lines(face.triangle, face.points, std::span<const std::array<Index, 2>>(begin, end),
                    editor_, posed_);
    bool is_crossed = false, is_blocked = false;
    for (Index sheet = 0; sheet < sheets_.size(); ++sheet)
      for_each_line(face, sheet, [&](const SheetLineEnd& from, const SheetLineEnd& to, Index edge) {
        is_crossed = true;
        const Index first = point_of(from, face, sheet, edge, lines),
                    last = point_of(to, face, sheet, edge, lines);
        if (first == kNone || last == kNone || !lines.draw(first, last, result_.edges[sheet]))
          is_blocked = true;
      });
    result_.faces_crossed += is_crossed ? 1 : 0;
    result_.blocked += is_blocked ? 1 : 0;
  }

  std::span<const Sheet> sheets_;
  SurfaceEditor& editor_;
  PosedPoints& posed_;
  ScratchVector<SheetFace> faces_;
  ScratchVector<SheetCrossing> crossings_;
  ScratchVector<std::array<Index, 2>> children_;  ///< (face, child), without the face itself.
  std::pmr::map<std::array<Index, 3>, Index> corners_;
  SheetImprint result_;
};

}  // namespace

SheetImprint imprint_sheets(std::span<const Sheet> sheets, std::span<const Index> faces,
                            SurfaceEditor& editor, PosedPoints& posed) {
  return SheetImprinter(sheets, editor, posed).run(faces);
}

}  // namespace sunder::tear
