#include "tear/sheet/walk_sheet.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/internal/ordered.h"
#include "tear/geometry/face_shape.h"
#include "tear/geometry/tolerances.h"
#include "tear/internal/surface.h"
#include "tear/path/snapping.h"
#include "tear/surface/flip_cap_edge.h"
#include "tear/surface/flip_edge.h"

namespace sunder::tear {
namespace {

double squared_height(const Place& a, const Place& b, const Place& c) {
  const Place ab = way(a, b), ac = way(a, c), bc = way(b, c), area = normal(a, b, c);
  const double longest = std::max({dot(ab, ab), dot(ac, ac), dot(bc, bc)});
  return longest > 0 ? dot(area, area) / longest : 0.0;
}

}  // namespace

SheetWalk::SheetWalk(const PlaneSide& plane, SurfaceEditor& editor, PosedPoints& posed)
    : plane_(plane),
      editor_(editor),
      posed_(posed),
      first_new_point_(editor.surface().point_count()),
      faces_(&editor.scratch()),
      edges_(&editor.scratch()),
      half_edges_(&editor.scratch()),
      left_over_(&editor.scratch()) {
  posed.compare_with(plane);
}

void SheetWalk::cross(std::span<const Index> faces) {
  edges_.reserve(2 * faces.size());
  half_edges_.reserve(2 * faces.size());
  left_over_.reserve(2 * faces.size());
  faces_.assign(faces.begin(), faces.end());
  for (const Index face : faces) turn_needle(face);
  for (std::size_t i = 0; i < faces_.size(); ++i) turn_edges_at(faces_[i]);
  editor_.stage.begin();
  for (const Index face : faces_) {
    if (has_edge_on_plane(face)) {
      left_over_.push_back(face);
      are_whole_ = false;
    } else if (lone_corner(face) != kNone) {
      walk_from(face);
    }
  }
  std::sort(left_over_.begin(), left_over_.end());
  left_over_.erase(std::unique(left_over_.begin(), left_over_.end()), left_over_.end());
}

bool SheetWalk::has_edge_on_plane(Index face) {
  int count = 0;
  for (Index k = 0; k < 3; ++k) {
    const Index point = editor_.surface().corner_point[3 * face + k];
    if (point >= first_new_point_) return false;
    count += posed_.is_on_plane(editor_, point) ? 1 : 0;
  }
  return count >= 2;
}

/// New points lie on the plane and tell nothing, so a face that was split has none. Nor has a
/// retired one.
Index SheetWalk::lone_corner(Index face) {
  std::array<bool, 3> inside;
  for (Index k = 0; k < 3; ++k) {
    const Index point = editor_.surface().corner_point[3 * face + k];
    if (point >= first_new_point_) return kNone;  // kNone is the highest
    inside[k] = is_inside(point);
  }
  if (inside[0] == inside[1] && inside[1] == inside[2]) return kNone;
  for (Index k = 0; k < 3; ++k)
    if (inside[(k + 1) % 3] == inside[(k + 2) % 3]) return 3 * face + k;
  return kNone;
}

/// Whether a face and all of its neighbours are triangles of the source, if only in part.
bool SheetWalk::is_among_source_faces(Index face) const {
  const Surface& surface = editor_.surface();
  const Index end = 3 * surface.first_triangle.back(), *twins = &surface.twin[3 * face];
  return 3 * face < end &&
         std::all_of(twins, twins + 3, [&](Index twin) { return twin == kNone || twin < end; });
}

/// Edges between parts of one origin, and within a flat cap, only belong to the triangulation that
/// earlier operations left. Where the plane crosses one on its way round a point, the edge is
/// flipped, so that it need not be split.
void SheetWalk::turn_edges_at(Index face) {
  const auto turn = [&](Index half_edge, bool is_lone_inside) {
    const Surface& surface = editor_.surface();
    const Index twin = surface.twin[half_edge];
    // Between triangles of the source nothing can be turned.
    if (twin == kNone || std::max(half_edge, twin) / 3 < surface.first_triangle.back())
      return false;
    const Index beyond = surface.corner_point[Surface::previous(twin)];
    return is_inside(beyond) != is_lone_inside && turn_edge(half_edge);
  };
  if (is_among_source_faces(face)) return;
  for (bool has_turned = true; has_turned;) {
    const Index lone = lone_corner(face);
    if (lone == kNone) return;
    const bool is_lone_inside = is_inside(editor_.surface().corner_point[lone]);
    has_turned = turn(lone, is_lone_inside) || turn(Surface::previous(lone), is_lone_inside);
  }
}

bool SheetWalk::turn_edge(Index half_edge) {
  if (!editor_.origins.is_inner_edge(half_edge))
    return turn_cap_edge(half_edge, kWorseCapShapeFactor);
  return !makes_needle(half_edge) && flip_edge(half_edge, editor_);
}

/// The points of a lip that an older plane left lie on one line: their edges to points within the
/// surface have to stay, or nothing splits the face between them.
bool SheetWalk::makes_needle(Index half_edge) const {
  const Surface& surface = editor_.surface();
  const Index mesh = surface.triangle(half_edge / 3).mesh, twin = surface.twin[half_edge];
  float largest = 0;
  const auto place = [&](Index corner) {
    const Vec3f& position = editor_.births.position(mesh, editor_.vertex_at(corner));
    largest = std::max(largest, position.cwiseAbs().maxCoeff());
    return place_of(position);
  };
  const Place a = place(half_edge), b = place(twin), c = place(Surface::previous(half_edge)),
              d = place(Surface::previous(twin));
  const double stored = kStoredCoordinates * static_cast<double>(largest);
  const double after = std::min(squared_height(a, d, c), squared_height(b, c, d));
  return after < stored * stored &&
         after < std::min(squared_height(a, b, c), squared_height(b, a, d));
}

bool SheetWalk::turn_cap_edge(Index half_edge, double least_shape_factor) {
  const auto fresh = flip_cap_edge(half_edge, least_shape_factor, editor_);
  if (fresh) faces_.insert(faces_.end(), fresh->begin(), fresh->end());
  return fresh.has_value();
}

/// Three points of a rim on one line leave a cap a face that nothing can split.
void SheetWalk::turn_needle(Index face) {
  const Surface& surface = editor_.surface();
  if (face < surface.first_triangle.back() || surface.has_repeated_point(face)) return;
  const Index mesh = surface.triangle(face).mesh;
  std::array<Place, 3> at;
  for (Index k = 0; k < 3; ++k)
    at[k] = place_of(editor_.births.position(mesh, editor_.vertex_at(3 * face + k)));
  if (!(shape_squared(at[0], at[1], at[2]) < kNeedleShape * kNeedleShape)) return;
  Index longest = 0;
  double squared_length = -1;
  for (Index k = 0; k < 3; ++k) {
    const Place along = way(at[k], at[(k + 1) % 3]);
    if (!(dot(along, along) > squared_length)) continue;
    squared_length = dot(along, along);
    longest = k;
  }
  turn_cap_edge(3 * face + longest, kBetterShapeFactor);
}

/// Computed in the direction of the lower half-edge; an end that lies on the plane or would be
/// stored as the crossing is the crossing.
SheetWalk::Crossing SheetWalk::crossing(Index half_edge) {
  const Surface& surface = editor_.surface();
  const Index h = std::min(half_edge, surface.twin[half_edge]);  // kNone is the highest
  const Vec3d &from = posed_.position(editor_, surface.corner_point[h]),
              &to = posed_.position(editor_, surface.corner_point[Surface::next(h)]);
  const double at_from = plane_.value(from), at_to = plane_.value(to);
  const double fraction =
      at_from == at_to ? 0.0 : std::clamp(at_from / (at_from - at_to), 0.0, 1.0);
  const Vec3d way = to - from;
  double snap = 0;
  if (std::min(fraction, 1 - fraction) <= kFarthestSnapEdges) {
    const double slant =
        norm(way) / std::max(std::abs(at_from - at_to), std::numeric_limits<double>::min());
    snap = std::min(kFarthestSnapEdges, stored_part(h, editor_) * slant);
  }
  const bool is_begin = posed_.is_on_plane(editor_, surface.corner_point[h]) || fraction <= snap;
  const bool is_end =
      posed_.is_on_plane(editor_, surface.corner_point[Surface::next(h)]) || fraction >= 1 - snap;
  const At at = is_begin ? At::begin : is_end ? At::end : At::inside;
  if (h == half_edge) return {at, fraction, from + fraction * way};
  return {at == At::begin ? At::end
          : at == At::end ? At::begin
                          : at,
          1 - fraction, from + fraction * way};
}

void SheetWalk::add(Index from, Index to, Index half_edge) {
  edges_.push_back({from, to});
  half_edges_.push_back(half_edge);
}

bool SheetWalk::go(LineSplitter& splitter, Index start) {
  const Surface& surface = editor_.surface();
  for (;;) {
    const Index entry = splitter.ahead();
    if (entry == kNone) return false;  // a border
    const Index opposite = surface.corner_point[Surface::previous(entry)];
    const Index along = Surface::next(entry);  // after end(): from the newest point to the corner
    if (opposite == start) {
      splitter.end();
      add(newest_, start, along);
      return true;
    }
    const Index origin = editor_.stage.ancestor(entry / 3);
    const std::array<Index, 3> corners = {surface.corner_point[entry],
                                          surface.corner_point[Surface::next(entry)], opposite};
    if (std::any_of(corners.begin(), corners.end(),
                    [&](Index point) { return point >= first_new_point_; })) {
      splitter.end();
      left_over_.push_back(origin);
      are_whole_ = false;
      return false;
    }
    const bool leaves_at_next = is_inside(opposite) == is_inside(corners[0]);
    const Index exit = leaves_at_next ? Surface::next(entry) : Surface::previous(entry);
    if (const Index twin = surface.twin[exit]; twin != kNone) editor_.fetch(twin / 3);
    const Crossing at = crossing(exit);
    if (at.at == (leaves_at_next ? At::end : At::begin)) {  // the opposite corner
      splitter.end();
      add(newest_, opposite, along);
      ++faces_crossed_;
      are_whole_ = false;
      return false;
    }
    const Index point = at.at == At::inside ? splitter.go_on(exit, at.fraction) : kNone;
    if (point == kNone) {
      splitter.end();
      left_over_.push_back(origin);
      are_whole_ = false;
      return false;
    }
    ++faces_crossed_;
    posed_.pin(point, at.position);
    add(newest_, point, splitter.half_edge());
    newest_ = point;
  }
}

void SheetWalk::walk_from(Index face) {
  const Surface& surface = editor_.surface();
  const Index lone = lone_corner(face), leaving = lone, arriving = Surface::previous(lone);
  Crossing first = crossing(leaving), second = crossing(arriving);
  Index h = leaving, other = arriving;
  if (first.at != At::inside) {
    std::swap(first, second);
    std::swap(h, other);
  }
  const bool is_through_corner =
      second.at == (other == arriving ? At::begin : At::end);  // opposite of h
  if (first.at != At::inside || (second.at != At::inside && !is_through_corner)) {
    left_over_.push_back(face);
    are_whole_ = false;
    return;
  }
  const bool is_inside_left = is_inside(surface.corner_point[Surface::next(h)]);
  const Index opposite = surface.corner_point[Surface::previous(h)];
  // The part behind the first point, on whose other edge the walk comes back.
  const Index other_in_part = other == Surface::next(h) ? 3 * surface.triangle_count() + 1 : other;
  LineSplitter splitter(editor_);
  const Index start = splitter.begin(h, first.fraction);
  if (start == kNone) {
    left_over_.push_back(face);
    are_whole_ = false;
    return;
  }
  ++faces_crossed_;
  posed_.pin(start, first.position);
  newest_ = start;
  const std::size_t begin = edges_.size();
  if (is_through_corner) add(opposite, start, splitter.half_edge());
  are_whole_ = are_whole_ && !is_through_corner;
  const bool is_closed = go(splitter, start);
  const std::size_t middle = edges_.size();
  if (!is_closed && !is_through_corner && !go_back(other_in_part, second, start)) {
    left_over_.push_back(face);
    are_whole_ = false;
  }
  end_run(begin, middle, is_inside_left);
}

bool SheetWalk::go_back(Index half_edge, const Crossing& at, Index start) {
  LineSplitter splitter(editor_);
  const Index point = splitter.begin(half_edge, at.fraction);
  if (point == kNone) return false;
  posed_.pin(point, at.position);
  add(start, point, splitter.half_edge());
  newest_ = point;
  static_cast<void>(go(splitter, kNone));
  return true;
}

void SheetWalk::end_run(std::size_t first, std::size_t middle, bool is_inside_left) {
  if (edges_.size() == first) return;
  ++runs_;
  const auto at = [&](auto& of, std::size_t i) {
    return of.begin() + static_cast<std::ptrdiff_t>(i);
  };
  const auto reverse = [&](std::size_t begin, std::size_t end) {
    std::reverse(at(edges_, begin), at(edges_, end));
    std::reverse(at(half_edges_, begin), at(half_edges_, end));
    for (std::size_t i = begin; i < end; ++i) {
      std::swap(edges_[i][0], edges_[i][1]);
      const Index h = half_edges_[i];
      half_edges_[i] = h == kNone ? kNone : editor_.surface().twin[h];
    }
  };
  // The part that goes back comes first, from its end on.
  if (middle < edges_.size()) {
    reverse(middle, edges_.size());
    std::rotate(at(edges_, first), at(edges_, middle), edges_.end());
    std::rotate(at(half_edges_, first), at(half_edges_, middle), half_edges_.end());
  }
  if (!is_inside_left) reverse(first, edges_.size());
}

}  // namespace sunder::tear
