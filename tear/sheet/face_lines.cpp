#include "tear/sheet/face_lines.h"

#include <algorithm>

#include "core/internal/ordered.h"
#include "tear/geometry/cross.h"
#include "tear/geometry/tolerances.h"
#include "tear/internal/surface.h"
#include "tear/path/imprint_point.h"
#include "tear/surface/flip_edge.h"

namespace sunder::tear {

FaceLines::FaceLines(Index face, const std::array<Index, 3>& points,
                     std::span<const std::array<Index, 2>> children, SurfaceEditor& editor,
                     PosedPoints& posed)
    : editor_(editor),
      posed_(posed),
      face_(face),
      children_(&editor.scratch()),
      first_new_(editor.surface().triangle_count()),
      drawn_(&editor.scratch()) {
  children_.reserve(children.size() + 8);
  drawn_.reserve(8);
  children_.push_back(face);
  for (const auto& [parent, child] : children) children_.push_back(child);
  origin_ = posed.position(editor, points[0]);
  const Vec3d ab = posed.position(editor, points[1]) - origin_,
              ac = posed.position(editor, points[2]) - origin_;
  const Vec3d normal = ab.cross(ac);
  const double longest =
      std::sqrt(std::max({squared_norm(ab), squared_norm(ac), squared_norm(ac - ab)}));
  if (!(norm(normal) > kFlatSquaredSizes * longest * longest)) return;
  size_ = longest;
  x_ = norm(ab) > norm(ac) ? Vec3d(ab / norm(ab)) : Vec3d(ac / norm(ac));
  y_ = (normal / norm(normal)).cross(x_);
}

Vec2d FaceLines::place(Index point) {
  const Vec3d offset = posed_.position(editor_, point) - origin_;
  return {dot(x_, offset), dot(y_, offset)};
}

bool FaceLines::is_drawn(Index a, Index b) const {
  return std::any_of(drawn_.begin(), drawn_.end(), [&](const PointEdge& edge) {
    return (edge[0] == a && edge[1] == b) || (edge[0] == b && edge[1] == a);
  });
}

Index FaceLines::imprint(const Vec3d& position) {
  if (size_ == 0) return kNone;
  for (Index t = first_new_; t < editor_.surface().triangle_count(); ++t)
    if (is_child(t)) children_.push_back(t);
  first_new_ = editor_.surface().triangle_count();

  const Vec2d at{dot(x_, position - origin_), dot(y_, position - origin_)};
  SurfaceHit best;
  double best_least = 0;
  for (const Index child : children_) {
    std::array<Vec2d, 3> corners;
    for (Index k = 0; k < 3; ++k) corners[k] = place(editor_.surface().corner_point[3 * child + k]);
    const double area = cross(corners[1] - corners[0], corners[2] - corners[0]);
    if (!(area > 0)) continue;
    std::array<double, 3> barycentric;
    for (Index k = 0; k < 3; ++k)
      barycentric[k] = cross(corners[(k + 1) % 3] - at, corners[(k + 2) % 3] - at) / area;
    const double least = *std::min_element(barycentric.begin(), barycentric.end());
    if (best.triangle != kNone && least <= best_least) continue;
    best = {child, barycentric, position, 0};
    best_least = least;
  }
  if (best.triangle == kNone || best_least < -kInFaceBarycentric) return kNone;
  return imprint_point(best, Snapping::tight, editor_, posed_);
}

bool FaceLines::turn(Index half_edge) {
  const Surface& surface = editor_.surface();
  const Index twin = surface.twin[half_edge];
  const Vec2d c = place(surface.corner_point[half_edge]),
              d = place(surface.corner_point[Surface::next(half_edge)]);
  const Vec2d a = place(surface.corner_point[Surface::previous(half_edge)]),
              e = place(surface.corner_point[Surface::previous(twin)]);
  const double least = kOnLineSizes * size_ * norm(e - a);
  return cross(e - a, c - a) < -least && cross(e - a, d - a) > least &&
         flip_edge(half_edge, editor_);
}

bool FaceLines::draw(Index from, Index to, ScratchVector<PointEdge>& edges) {
  const auto first = static_cast<std::ptrdiff_t>(drawn_.size());
  const bool is_drawn = draw(from, to);
  edges.insert(edges.end(), drawn_.begin() + first, drawn_.end());
  return is_drawn;
}

bool FaceLines::draw(Index from, Index to) {
  const Surface& surface = editor_.surface();
  const auto add = [&](Index a, Index b) { drawn_.push_back({a, b}); };
  // Each flip removes one edge that crosses the line; each other step advances along it.
  for (int guard = 0; from != to && guard < 1000; ++guard) {
    if (surface.find_half_edge(from, to) != kNone || surface.find_half_edge(to, from) != kNone) {
      add(from, to);
      return true;
    }
    if (size_ == 0) return false;
    const Vec2d begin = place(from), end = place(to);
    const Vec2d way = end - begin;
    const double length = norm(way);
    if (!(length > 0)) return false;
    const auto left_of_line = [&](Index point) {
      return cross(way, place(point) - begin) / length;
    };

    Index through = kNone, crossed = kNone;
    surface.for_each_in_fan(surface.point_corner[from], [&](Index corner) {
      if (through != kNone || !is_child(corner / 3)) return;
      const Index c = surface.corner_point[Surface::next(corner)],
                  d = surface.corner_point[Surface::previous(corner)];
      for (const Index point : {c, d}) {
        const double along = dot(way, place(point) - begin) / length;
        if (std::abs(left_of_line(point)) <= kOnLineSizes * size_ && along > 0 && along < length)
          through = point;
      }
      if (left_of_line(c) < 0 && left_of_line(d) > 0) crossed = Surface::next(corner);
    });
    if (through != kNone) {
      add(from, through);
      from = through;
      continue;
    }
    if (crossed == kNone || surface.twin[crossed] == kNone || !is_child(surface.twin[crossed] / 3))
      return false;
    const Index c = surface.corner_point[crossed], d = surface.corner_point[Surface::next(crossed)];
    const double right = -left_of_line(c), left = left_of_line(d);
    if (!is_drawn(c, d) && turn(crossed)) continue;
    const Index point = split_posed_edge(crossed, right / (right + left), editor_, posed_);
    if (point == kNone) return false;
    add(from, point);
    from = point;
  }
  return from == to;
}

}  // namespace sunder::tear
