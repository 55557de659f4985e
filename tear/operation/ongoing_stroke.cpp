#include "tear/operation/ongoing_stroke.h"

#include <algorithm>

#include "tear/filling/lip_walls.h"
#include "tear/internal/surface.h"
#include "tear/operation/all_layers.h"
#include "tear/operation/nearest_layer.h"
#include "tear/path/crack_points.h"
#include "tear/path/entry.h"
#include "tear/surface/improve.h"

namespace sunder::tear {
namespace {

// Walls keep this distance from the blade, because the tear may still change there: in units of
// their depth and of the gap's width.
constexpr double kHoldDepths = 1.5, kHoldWidths = 2;

// Walls are added once the blade has moved by this part of their depth, because each time the lips
// that are held back are looked at again.
constexpr double kStepDepths = 0.5;

double distance(const Blade& a, const Blade& b) {
  return std::max(norm(Vec3d(a.base - b.base)), norm(Vec3d(a.tip - b.tip)));
}

}  // namespace

void OngoingStroke::begin(const Blade& first, const TearOptions& options) {
  options_ = options;
  blade_ = first;
  blades_.assign(1, first);
  walls_front_ = first;
  walls_.clear();
  tip_ = {};
  gap_.begin(options.width, options.layers);
  hold_.hit.reset();
}

void OngoingStroke::leave_pose(const Workpiece& work, Outcome& outcome) {
  gap_.catch_up(work, outcome);
  hold_.hit.reset();
  if (tip_.is_on_surface(work))
    hold_.place = work.posed.position(work.editor, tip_.point);
  else if (hold_.hit = first_hit(blade_, work.editor, work.posed); hold_.hit)
    hold_.place = hold_.hit->position;
}

void OngoingStroke::enter_pose(const Workpiece& work) {
  gap_.enter_pose();
  Vec3d moved = -hold_.place;
  if (tip_.is_on_surface(work)) {
    moved += work.posed.position(work.editor, tip_.point);
  } else if (hold_.hit) {
    const Index* points = &work.editor.surface().corner_point[3 * hold_.hit->triangle];
    for (Index k = 0; k < 3; ++k)
      moved += hold_.hit->barycentric[k] * work.posed.position(work.editor, points[k]);
  } else {
    return;
  }
  blade_ = {blade_.base + moved, blade_.tip + moved};
}

void OngoingStroke::extend(const Blade& to, const Workpiece& work, Outcome& outcome) {
  ++outcome.report.segments;
  if (options_.wall_depth > 0) blades_.push_back(to);
  const Blade from = blade_;
  blade_ = to;
  if (!tip_.is_on_surface(work)) tip_.point = kNone;
  Vec3d anchor = 0.5 * (from.base + from.tip);
  tip_.hit.reset();
  if (options_.layers == Layers::nearest) {
    if (tip_.point != kNone)
      anchor = work.posed.position(work.editor, tip_.point);
    else if (tip_.hit = first_hit(from, work.editor, work.posed); tip_.hit)
      anchor = tip_.hit->position;
  }
  const auto plane = BladePlane::through(anchor, from, to);
  if (!plane) return;  // the blade stands still; so does the tip

  const EditLog::Mark before = work.editor.mark();
  if (options_.width > 0)
    gap_.sweep({*plane, from, to}, work, tip_, outcome);
  else if (options_.layers == Layers::all)
    tear_all_layers(*plane, work, outcome);
  else
    tear_nearest_layer(*plane, work, tip_, outcome);
  outcome.report.blocked += match_crack_points(before, work);
  improve_faces(before, work.editor);
  outcome.before_walls.reset();
  if (outcome.report.segments == 1) outcome.before_walls = work.editor.log.extent();
  add_walls(options_.width > 0 ? &from : &to, work);  // a gap is one segment behind
}

void OngoingStroke::add_walls(const Blade* front, const Workpiece& work) {
  if (!(options_.wall_depth > 0)) return;
  LipWallOptions walls;
  walls.depth = options_.wall_depth;
  walls.width = options_.width;
  walls.roll = options_.lip_roll;
  walls.material = options_.wall_material;
  walls.all_layers = options_.layers == Layers::all;
  if (front != nullptr) {
    if (distance(*front, walls_front_) < kStepDepths * options_.wall_depth) return;
    walls_front_ = *front;
    walls.front = *front;
    walls.hold = kHoldDepths * options_.wall_depth + kHoldWidths * options_.width;
  }
  ScratchVector<Index> lips(&work.editor.scratch());
  for (const Index half_edge : work.editor.opened_edges.borders())
    if (!work.editor.is_wall(half_edge / 3)) lips.push_back(half_edge);
  add_lip_walls(lips, blades_, walls, walls_, work);
}

void OngoingStroke::finish(const Workpiece& work, Outcome& outcome) {
  gap_.catch_up(work, outcome);
  outcome.before_walls.reset();
  add_walls(nullptr, work);
}

}  // namespace sunder::tear
