#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <vector>

#include "core/internal/ordered.h"
#include "core/operation/internal/check_ranges.h"
#include "core/operation/internal/describe_aimed.h"
#include "pipeline/aim/limb_rays.h"
#include "pipeline/aim/operations.h"

namespace sunder::aim {
namespace {

constexpr int kRaysPerRing = 16;
/// The share of the way to another surface inside the limb at which a bore ends.
constexpr double kFreeShare = 0.9;

Status check(const Limb& limb, const PunctureOperation& puncture) {
  if (puncture.depth && puncture.is_through)
    return Status::failure(StatusCode::invalid_argument, kNone,
                           "%s: a puncture through the limb has no depth of its own",
                           limb.label.c_str());
  return check_ranges(puncture);
}

/// Places inside a circle of the plane of the view: its middle and three rings.
std::vector<Vec3d> places_inside(const ViewFrame& frame, double radius) {
  std::vector<Vec3d> places = {Vec3d::Zero()};
  for (const double share : {1.0 / 3, 2.0 / 3, 1.0})
    for (int i = 0; i < kRaysPerRing; ++i)
      places.push_back(share * radius * frame.turned(2 * std::numbers::pi * i / kRaysPerRing));
  return places;
}

/// The surfaces that the rays inside the bore meet, all together.
/// @return empty if the ray in the middle misses.
std::optional<RayHit> look_into(const LimbRays& rays, const std::vector<Vec3d>& places) {
  const std::optional<RayHit> middle = rays.cast_at_middle();
  if (!middle) return {};
  std::optional<RayHit> all = middle;
  double other_before = all->near + all->free_before, other_below = all->near - all->free_below,
         other_behind = all->far - all->free_behind;
  for (const Vec3d& place : places) {
    const std::optional<RayHit> hit = rays.cast(place, *middle);
    if (!hit) continue;
    all->near = std::max(all->near, hit->near);
    all->far = std::min(all->far, hit->far);
    other_before = std::min(other_before, hit->near + hit->free_before);
    other_below = std::max(other_below, hit->near - hit->free_below);
    other_behind = std::max(other_behind, hit->far - hit->free_behind);
  }
  all->free_before = std::max(0.0, other_before - all->near);
  all->free_below = std::max(0.0, all->near - other_below);
  all->free_behind = std::max(0.0, all->far - other_behind);
  return all;
}

/// Where a bore begins and ends: heights towards the viewer.
struct BoreEnds {
  double begin = 0, end = 0;
};

BoreEnds ends_of(const PunctureOperation& puncture, const RayHit& middle, const RayHit& all,
                 double width) {
  const double before = std::min(kClearanceWidths * width, 0.5 * all.free_before),
               behind = std::min(kClearanceWidths * width, 0.5 * all.free_behind);
  BoreEnds ends;
  ends.begin = all.near + before;
  // Without a depth, the bore ends before the next surface inside the limb that is not its own.
  ends.end = puncture.is_through ? all.far - behind
             : puncture.depth    ? middle.near - metres(*puncture.depth, width)
                                 : std::max(0.5 * (middle.near + middle.far),
                                            all.near - kFreeShare * all.free_below);
  return ends;
}

}  // namespace

Result<Operation> resolve_puncture(const PosedSurface& surface, const PunctureOperation& puncture) {
  const Result<Limb> limb = find_limb(surface, puncture.place);
  if (!limb) return limb.error();
  if (const Status status = check(*limb, puncture); !status) return status;
  const Result<ViewFrame> frame = view_frame(*limb, puncture.from);
  if (!frame) return frame.error();
  const auto sections = limb_sections(*limb, {frame->along, dot(frame->along, limb->place)});
  if (!sections) return sections.error();

  LimbRays rays(*limb, *frame, *sections);
  const double width = rays.width(), radius = metres(puncture.radius, width);
  if (const Status status =
          check_within_limb(*limb, "radius", radius, width, "the limb is not wider there");
      !status)
    return status;
  if (const Status status = field::check_chord_tolerance(puncture.chord_tolerance, radius); !status)
    return status;
  rays.look_around(radius + width);
  const std::vector<Vec3d> places = places_inside(*frame, radius);
  const std::optional<RayHit> middle = rays.cast_at_middle(), all = look_into(rays, places);
  if (!middle || !all)
    return Status::failure(StatusCode::not_found, limb->bones.bone(),
                           "%s: the limb has no surface there that is seen from this side",
                           limb->label.c_str());
  if (puncture.depth)
    if (const Status status = check_within_limb(*limb, "depth", metres(*puncture.depth, width),
                                                std::max(width, middle->near - middle->far),
                                                "the limb is not thicker there");
        !status)
      return status;
  const BoreEnds ends = ends_of(puncture, *middle, *all, width);
  if (std::any_of(places.begin(), places.end(), [&](const Vec3d& place) {
        return rays.meets_others(place, ends.end, ends.begin);
      }))
    return Status::failure(StatusCode::not_found, limb->bones.bone(),
                           "%s: a surface that is not of the limb lies in the way of the bore; "
                           "try another side, a smaller radius or less depth",
                           limb->label.c_str());
  DrillOperation drill;
  drill.pose = puncture.pose;
  drill.bore.origin = rays.middle() + ends.begin * frame->towards_viewer;
  drill.bore.direction = -frame->towards_viewer;
  drill.bore.radius = radius;
  drill.bore.depth = ends.begin - ends.end;
  drill.bore.chord_tolerance = puncture.chord_tolerance;
  drill.bore.wall = puncture.wall;
  drill.bore.wall_material = puncture.wall_material;
  drill.bore.weights = puncture.weights;
  return Operation(drill);
}

}  // namespace sunder::aim
