#include "tear/path/imprint.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "tear/internal/surface.h"
#include "tear/path/edge_crossing.h"
#include "tear/path/leap.h"
#include "tear/surface/crossing.h"

namespace sunder::tear {
namespace {

/// Four units in the last place of a stored coordinate.
constexpr double kStored = 0x1p-22;

/// A length as a part of another, that of a place which is not stored apart.
double part_of(double length, double whole) { return whole > 0 ? std::clamp(length / whole, kTightSnap, 0.25) : kTightSnap; }

double largest_coordinate(const Vec3f& a, const Vec3f& b) {
  return static_cast<double>(std::max(a.cwiseAbs().maxCoeff(), b.cwiseAbs().maxCoeff()));
}

/// Part of the height on a corner nearer than which to the far edge a place would be stored on it, give or take a few units in the
/// last place.
double stored_height(Index corner, const SurfaceEditor& editor) {
  const Index mesh = editor.surface().triangle(corner / 3).mesh;
  const auto at = [&](Index c) -> const Vec3f& { return editor.born_position(mesh, editor.vertex_at(c)); };
  const Vec3f &apex = at(corner), &a = at(Surface::next(corner)), &b = at(Surface::previous(corner));
  const Eigen::Vector3d base = b.cast<double>() - a.cast<double>(), side = apex.cast<double>() - a.cast<double>();
  const double length = base.norm();
  return part_of(kStored * std::max(largest_coordinate(a, b), largest_coordinate(apex, apex)),
                 length > 0 ? base.cross(side).norm() / length : 0);
}

}  // namespace

Index split_posed_edge(Index half_edge, double fraction, SurfaceEditor& editor, PosedPoints& posed) {
  const auto& points = editor.surface().corner_point;
  const Vec3d from = posed.position(editor, points[half_edge]);
  const Vec3d to = posed.position(editor, points[Surface::next(half_edge)]);
  const Index point = editor.split_edge(half_edge, fraction);
  if (point != kNone) posed.pin(point, from + fraction * (to - from));
  return point;
}

double stored_part(Index half_edge, const SurfaceEditor& editor) {
  const Index mesh = editor.surface().triangle(half_edge / 3).mesh;
  const Vec3f &from = editor.born_position(mesh, editor.vertex_at(half_edge)),
              &to = editor.born_position(mesh, editor.vertex_at(Surface::next(half_edge)));
  return part_of(kStored * largest_coordinate(from, to), (to.cast<double>() - from.cast<double>()).norm());
}

double snapped_part(Index half_edge, Snapping snapping, const SurfaceEditor& editor, PosedPoints& posed) {
  if (snapping == Snapping::tight) return stored_part(half_edge, editor);
  if (snapping == Snapping::near) return kSnap;
  if (editor.is_source_vertex(half_edge) && editor.is_source_vertex(Surface::next(half_edge))) return kSnap;
  const Surface& surface = editor.surface();
  double length_squared = 0, longest_squared = 0;
  for (const Index side : {half_edge, surface.twin[half_edge]}) {
    if (side == kNone) continue;
    const Vec3d a = posed.position(editor, surface.corner_point[side]);
    const Vec3d b = posed.position(editor, surface.corner_point[Surface::next(side)]);
    const Vec3d c = posed.position(editor, surface.corner_point[Surface::previous(side)]);
    length_squared = (b - a).squaredNorm();
    longest_squared = std::max({longest_squared, length_squared, (c - a).squaredNorm(), (c - b).squaredNorm()});
  }
  return length_squared > 0 ? std::min(0.5, kSliver * std::sqrt(longest_squared / length_squared)) : 0.5;
}

Step find_step(const BladePlane& plane, Index point, Snapping snapping, const SurfaceEditor& editor, PosedPoints& posed) {
  const Surface& surface = editor.surface();
  posed.cover(surface.point_count());
  const Vec3d& from = posed.position(editor, point);
  const double progress_here = plane.progress(from);
  Step best;
  double best_progress = 0;
  const auto slope = [&](const Step& step, double progress) {
    const double part = std::max(reach_between(plane, from, step.position).fraction, kSnap);
    const Vec3d reached = from + part * (step.position - from);
    return (plane.sweep_coordinates(plane.project(reached)).depth - plane.sweep_coordinates(plane.project(from)).depth) / progress;
  };
  const auto consider = [&](Index corner, const Vec3d& at_a, double distance_a, const Vec3d& at_b, double distance_b) {
    Step step;
    step.corner = corner;
    step.fraction = distance_a / (distance_a - distance_b);
    step.position = at_a + step.fraction * (at_b - at_a);
    step.crossing_progress = plane.progress(step.position);
    const bool is_at_a = step.fraction < 0.5;
    bool snaps = std::min(step.fraction, 1 - step.fraction) < kTightSnap;
    if (!snaps) {
      const double snap = snapped_part(Surface::next(corner), snapping, editor, posed);
      if (step.fraction < snap || step.fraction > 1 - snap) {
        // In a sliver an end may be near and yet lie in another direction, as that from which a tear came to its tip.
        const Vec3d way = step.position - from, snapped_way = (is_at_a ? at_a : at_b) - from;
        snaps = way.dot(snapped_way) > 0.5 * way.norm() * snapped_way.norm();
      }
    }
    if (snaps) {
      step.fraction = is_at_a ? 0 : 1;
      step.position = is_at_a ? at_a : at_b;
    }
    const double progress = progress_towards(plane, from, step.position) - progress_here;
    if (!(progress > 1e-12)) return;
    if (best.corner != kNone && slope(step, progress) >= slope(best, best_progress)) return;
    best = step;
    best_progress = progress;
  };
  // The far edges around the point are a chain: each of its points is looked at once.
  const Index first = surface.first_of_fan(surface.point_corner[point]);
  const Vec3d* at_a = &posed.position(editor, surface.corner_point[Surface::next(first)]);
  double distance_a = plane.distance(*at_a);
  for (Index corner = first; corner != kNone;) {
    const Vec3d* at_b = &posed.position(editor, surface.corner_point[Surface::previous(corner)]);
    const double distance_b = plane.distance(*at_b);
    if ((distance_a >= 0) != (distance_b >= 0)) consider(corner, *at_a, distance_a, *at_b, distance_b);
    at_a = at_b;
    distance_a = distance_b;
    corner = surface.rotate_ccw(corner);
    if (corner == first) break;
  }
  return best;
}

Reach reach_between(const BladePlane& plane, const Vec3d& from, const Vec3d& to) {
  const Vec2d a = plane.project(from), b = plane.project(to);
  Reach reach;
  for (std::size_t i = 0; i < plane.reach().size(); ++i) {
    const double at_b = plane.reach()[i].value(b);
    if (at_b > 0) continue;  // inside
    const double at_a = plane.reach()[i].value(a);
    if (at_b >= at_a) continue;  // coming back in
    const double fraction = std::clamp(at_a / (at_a - at_b), 0.0, 1.0);
    if (fraction < reach.fraction || (fraction == reach.fraction && i == 2)) reach = {fraction, i == 2};
  }
  return reach;
}

double progress_towards(const BladePlane& plane, const Vec3d& from, const Vec3d& to) {
  return progress_towards(plane, from, to, reach_between(plane, from, to));
}

double progress_towards(const BladePlane& plane, const Vec3d& from, const Vec3d& to, const Reach& reach) {
  const double part = reach.fraction;
  const Vec2d b = plane.project(to);
  const double at_b = plane.not_before().value(b);
  if (part == 1 && at_b >= 0) return plane.progress(b);
  const Vec2d a = plane.project(from);
  const double at_a = plane.not_before().value(a);
  if (at_b < 0 && at_b < at_a && at_a / (at_a - at_b) < part) return -std::numeric_limits<double>::infinity();
  return plane.progress(Vec2d(a + std::max(part, kSnap) * (b - a)));
}

namespace {

/// The end of the far edge that a step goes to, where it goes to one.
Index step_corner(const Step& step) {
  if (step.fraction == 0) return Surface::next(step.corner);
  if (step.fraction == 1) return Surface::previous(step.corner);
  return kNone;
}

/// A path that grows.
class GrowingPath {
 public:
  GrowingPath(const BladePlane& plane, Index start, SurfaceEditor& editor, PosedPoints& posed)
      : path(editor.scratch()), plane_(plane), editor_(editor), posed_(posed), here_(posed.position(editor, start)) {
    constexpr std::size_t kMany = 128;
    path.points.reserve(kMany);
    path.half_edges.reserve(kMany);
    path.points.push_back(start);
    path.progress = plane.progress(here_);
  }

  [[nodiscard]] Index point() const { return path.points.back(); }
  [[nodiscard]] const Vec3d& here() const { return here_; }
  void come_to(double progress) { path.progress = std::max(path.progress, progress); }
  void go_to(Index point, Index half_edge) {
    const Vec3d there = posed_.position(editor_, point);
    path.length_posed += (there - here_).norm();
    path.points.push_back(point);
    path.half_edges.push_back(half_edge);
    here_ = there;
  }

  /// Goes to the place of a step, splitting the far edge, and on across what faces of the source are whole; where that edge cannot
  /// be split, to its nearer end. @param goes_on  the path does not end there. @return whether it went anywhere.
  bool take(const Step& step, bool goes_on) {
    const Surface& surface = editor_.surface();
    const auto& points = surface.corner_point;
    if (const Index corner = step_corner(step); corner != kNone) {
      go_to(points[corner], step.fraction == 0 ? step.corner : surface.twin[corner]);
      return true;
    }
    const Index far_edge = Surface::next(step.corner);
    const Index nearer_end = points[step.fraction < 0.5 ? far_edge : Surface::next(far_edge)];
    SurfaceEditor::Crossing crossing(editor_);
    if (const Index made = crossing.begin(far_edge, step.fraction); made != kNone) {
      posed_.pin(made, step.position);
      go_to(made, crossing.half_edge());
      for (double progress = plane_.progress(here_); goes_on && cross_next(progress, crossing);) ++path.faces_crossed;
      crossing.end();
      return true;
    }
    if (!(plane_.progress(posed_.position(editor_, nearer_end)) > plane_.progress(here_))) return false;
    go_to(nearer_end, kNone);
    return true;
  }

  Path path;

 private:
  /// Crosses the face ahead, unless there is anything about it that has to be looked at. @param progress_here  becomes that there.
  bool cross_next(double& progress_here, SurfaceEditor::Crossing& crossing) {
    const Index entry = crossing.ahead();
    if (entry == kNone || !editor_.is_whole(entry / 3)) return false;
    const EdgeCrossing exit = find_exit(plane_, entry, editor_, posed_);
    if (!(exit.fraction > kSnap && exit.fraction < 1 - kSnap)) return false;
    const Index after = editor_.surface().twin[exit.half_edge];
    if (after != kNone) editor_.fetch(after / 3);
    const Reach reach = reach_between(plane_, here_, exit.position);
    if (reach.fraction < 1 || reach.ends_at_blade) return false;
    const double progress = progress_towards(plane_, here_, exit.position, reach);
    if (!(progress > progress_here + 1e-12)) return false;
    const Index made = crossing.go_on(exit.half_edge, exit.fraction);
    if (made == kNone) return false;
    if (after != kNone) posed_.fetch(editor_, editor_.surface().corner_point[Surface::previous(after)]);
    posed_.pin(made, exit.position);
    come_to(progress);
    progress_here = progress;
    go_to(made, crossing.half_edge());
    return true;
  }

  const BladePlane& plane_;
  SurfaceEditor& editor_;
  PosedPoints& posed_;
  Vec3d here_;
};

/// Whether a way along an edge ends so near to its end, a point of a border, that only a sliver would hold the two together.
bool stops_short_of_border(const Step& step, const Reach& reach, const SurfaceEditor& editor, PosedPoints& posed) {
  const Index corner = step_corner(step);
  if (corner == kNone || !editor.surface().is_on_border(editor.surface().corner_point[corner])) return false;
  const Index edge = step.fraction == 0 ? step.corner : corner;
  return reach.fraction > 1 - snapped_part(edge, Snapping::by_shape, editor, posed);
}

/// Ends a path within the face that a step would cross, `fraction` of the way to its place.
Index stop_within(const Step& step, double fraction, SurfaceEditor& editor, PosedPoints& posed) {
  SurfaceHit hit;
  hit.triangle = step.corner / 3;
  hit.barycentric[step.corner % 3] = 1 - fraction;
  hit.barycentric[Surface::next(step.corner) % 3] = fraction * (1 - step.fraction);
  hit.barycentric[Surface::previous(step.corner) % 3] = fraction * step.fraction;
  const Vec3d here = posed.position(editor, editor.surface().corner_point[step.corner]);
  hit.position = here + fraction * (step.position - here);
  return imprint_point(hit, Snapping::near, editor, posed);
}

}  // namespace

Index imprint_point(const SurfaceHit& hit, Snapping snapping, SurfaceEditor& editor, PosedPoints& posed) {
  const Index first = 3 * hit.triangle;
  std::array<double, 3> weight = hit.barycentric;
  double sum = 0;
  for (Index k = 0; k < 3; ++k) {
    if (weight[k] < (snapping == Snapping::tight ? stored_height(first + k, editor) : kSnap)) weight[k] = 0;
    sum += weight[k];
  }
  for (double& w : weight) w /= sum;
  const auto largest = static_cast<Index>(std::max_element(weight.begin(), weight.end()) - weight.begin());
  const auto smallest = static_cast<Index>(std::min_element(weight.begin(), weight.end()) - weight.begin());
  if (weight[largest] == 1) return editor.surface().corner_point[first + largest];

  if (weight[smallest] > 0) {
    const Index point = editor.split_triangle(hit.triangle, weight);
    if (point != kNone) {
      posed.pin(point, hit.position);
      return point;
    }
  }
  // On the edge opposite of the smallest coordinate, or as near to it as the face allows.
  const Index edge = Surface::next(first + smallest);
  const double along = weight[Surface::next(edge) % 3] / (weight[edge % 3] + weight[Surface::next(edge) % 3]);
  const double snap = snapped_part(edge, snapping, editor, posed);
  if (along > snap && along < 1 - snap)
    if (const Index point = split_posed_edge(edge, along, editor, posed); point != kNone) return point;
  return editor.surface().corner_point[along < 0.5 ? edge : Surface::next(edge)];
}

Path imprint_path(const BladePlane& plane, Index start, SurfaceEditor& editor, PosedPoints& posed) {
  GrowingPath growing(plane, start, editor, posed);
  Path& path = growing.path;
  for (;;) {
    const Index here = growing.point();
    const Vec3d from = growing.here();
    const Step step = find_step(plane, here, Snapping::by_shape, editor, posed);
    if (step.corner == kNone) return std::move(path);
    const bool along_edge = step_corner(step) != kNone;
    const Reach reach = reach_between(plane, from, step.position);
    // Where the curve itself ends; the path may snap to a point before it.
    growing.come_to(plane.progress(Vec3d(from + reach.fraction * (step.position - from))));
    if (reach.fraction == 1) growing.come_to(step.crossing_progress);
    const Path::End end_of_reach = reach.ends_at_blade ? Path::End::blade : Path::End::surface;
    if (reach.fraction < kSnap) {
      path.end = end_of_reach;
      return std::move(path);
    }
    if (!along_edge) ++path.faces_crossed;
    if (!along_edge && reach.fraction == 1 && !reach.ends_at_blade) {
      const Leap leap = find_leap(plane, step, editor, posed);
      if (const Index landing = take_leap(plane, here, leap, editor, posed); landing != kNone) {
        path.faces_crossed += leap.edges;
        growing.come_to(leap.progress);
        growing.go_to(landing, kNone);
        if (!leap.end) continue;
        path.end = *leap.end;
        return std::move(path);
      }
    }
    if (reach.fraction < 1 - kSnap && !stops_short_of_border(step, reach, editor, posed)) {
      const SurfaceEditor::Mark before = editor.mark();
      const Index stop = stop_within(step, reach.fraction, editor, posed);
      if (plane.progress(posed.position(editor, stop)) > plane.progress(from)) {
        growing.go_to(stop, kNone);
      } else {  // it snapped to what lies behind
        editor.roll_back(before);
        posed.forget_from(before.points);
      }
      path.end = end_of_reach;
      return std::move(path);
    }
    const bool ends_here = reach.ends_at_blade || reach.fraction < 1;
    if (!growing.take(step, !ends_here)) {
      path.end = Path::End::blocked;
      return std::move(path);
    }
    if (ends_here) {
      path.end = end_of_reach;
      return std::move(path);
    }
  }
}

}  // namespace sunder::tear
