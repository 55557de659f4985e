#include "tear/path/wall_path.h"

#include <algorithm>
#include <limits>
#include <optional>

#include "tear/internal/surface.h"
#include "tear/path/edge_crossing.h"
#include "tear/path/imprint_point.h"

namespace sunder::tear {
namespace {

/// Walls have few rows, each of two triangles; splits add some.
constexpr int kMostSteps = 256;

/// A plane across a lip, in which the wall below is cut the shortest way down, however small the
/// angle is at which the blade crosses the lip.
struct LipPlane {
  Vec3d origin, normal;

  [[nodiscard]] double distance(const Vec3d& point) const { return dot(normal, point - origin); }
};

/// The plane at a point of a lip; none if no wall begins there.
std::optional<LipPlane> plane_across_lip(Index point, const SurfaceEditor& editor,
                                         PosedPoints& posed) {
  const Surface& surface = editor.surface();
  const Vec3d at = posed.position(editor, point);
  LipPlane plane{at, Vec3d::Zero()};
  surface.for_each_in_fan(surface.point_corner[point], [&](Index corner) {
    const bool is_wall = editor.is_wall(corner / 3);
    const Index out = corner, in = Surface::previous(corner);
    for (const Index edge : {out, in}) {
      const Index across = surface.twin[edge];
      if (!is_wall || across == kNone || editor.is_wall(across / 3)) continue;
      const Index end = surface.corner_point[edge == out ? Surface::next(corner) : in];
      const Vec3d way = posed.position(editor, end) - at;
      if (norm(way) > 0) plane.normal += (edge == out ? 1 : -1) / norm(way) * way;
    }
  });
  const double length = norm(plane.normal);
  if (!(length > 0)) return std::nullopt;
  plane.normal /= length;
  return plane;
}

/// Goes down a wall.
class WallDescent {
 public:
  WallDescent(const BladePlane& blade, const LipPlane& plane, SurfaceEditor& editor,
              PosedPoints& posed)
      : blade_(blade), plane_(plane), editor_(editor), posed_(posed) {}

  /// @return the next point below; kNone if there is none within the blade's reach.
  Index step(Index before, Index here) {
    const auto& points = editor_.surface().corner_point;
    const Crossing to = find_crossing(before, here);
    const auto& [below_base, above_tip, before_blade] = blade_.reach();
    if (to.edge == kNone || above_tip.value(blade_.project(to.position)) < 0) return kNone;
    const double snap = snapped_part(to.edge, Snapping::by_shape, editor_, posed_);
    if (to.fraction >= snap && to.fraction <= 1 - snap)
      if (const Index made = split_posed_edge(to.edge, to.fraction, editor_, posed_); made != kNone)
        return made;
    return points[to.fraction < 0.5 ? to.edge : Surface::next(to.edge)];
  }

 private:
  struct Crossing {
    Index edge = kNone;
    double fraction = 0;
    Vec3d position = Vec3d::Zero();
  };

  /// The lowest crossing with the far edges of the faces of the wall around `here`, away from
  /// `before`.
  [[nodiscard]] Crossing find_crossing(Index before, Index here) {
    const Surface& surface = editor_.surface();
    Crossing found;
    double lowest = 0;
    surface.for_each_in_fan(surface.point_corner[here], [&](Index corner) {
      const Index edge = Surface::next(corner);
      const Index a = surface.corner_point[edge], b = surface.corner_point[Surface::next(edge)];
      if (!editor_.is_wall(corner / 3) || a == before || b == before) return;
      const Vec3d at_a = posed_.position(editor_, a), at_b = posed_.position(editor_, b);
      const double of_a = plane_.distance(at_a), of_b = plane_.distance(at_b);
      if ((of_a >= 0) == (of_b >= 0)) return;
      const double fraction = of_a / (of_a - of_b);
      const Vec3d position = at_a + fraction * (at_b - at_a);
      const double down = blade_.project(position).y();
      if (found.edge != kNone && down <= lowest) return;
      found = {edge, fraction, position};
      lowest = down;
    });
    return found;
  }

  const BladePlane& blade_;
  const LipPlane& plane_;
  SurfaceEditor& editor_;
  PosedPoints& posed_;
};

}  // namespace

ScratchVector<Index> imprint_wall(const BladePlane& plane, Index point, SurfaceEditor& editor,
                                  PosedPoints& posed) {
  ScratchVector<Index> points(&editor.scratch());
  const std::optional<LipPlane> across = plane_across_lip(point, editor, posed);
  if (!across) return points;
  WallDescent descent(plane, *across, editor, posed);
  Index before = kNone, here = point;
  for (int i = 0; i < kMostSteps; ++i) {
    const Index next = descent.step(before, here);
    if (next == kNone || next == point || std::ranges::find(points, next) != points.end()) break;
    points.push_back(next);
    before = here;
    here = next;
    if (editor.surface().is_on_border(here)) break;
  }
  return points;
}

double lowest_of_wall(const BladePlane& plane, Index face, const SurfaceEditor& editor,
                      PosedPoints& posed) {
  const Surface& surface = editor.surface();
  const auto depth_of = [&](const EdgeCrossing& crossing) {
    return plane.project(crossing.position).y();
  };
  EdgeCrossing lowest;
  for (Index h = 3 * face; h < 3 * face + 3; ++h) {
    const EdgeCrossing crossing = cross_edge(plane, h, editor, posed);
    if (!(crossing.fraction > 0 && crossing.fraction < 1)) continue;
    if (lowest.half_edge == kNone || depth_of(crossing) > depth_of(lowest)) lowest = crossing;
  }
  if (lowest.half_edge == kNone) return -std::numeric_limits<double>::infinity();
  for (int i = 0; i < kMostSteps; ++i) {
    const Index across = surface.twin[lowest.half_edge];
    if (across == kNone || !editor.is_wall(across / 3)) break;
    const EdgeCrossing next = find_exit(plane, across, editor, posed);
    if (!(depth_of(next) > depth_of(lowest))) break;
    lowest = next;
  }
  return depth_of(lowest);
}

}  // namespace sunder::tear
