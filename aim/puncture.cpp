#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

#include "aim/limb_rays.h"
#include "aim/operations.h"
#include "core/internal/ordered.h"

namespace sunder::aim {
namespace {

constexpr int kRaysPerRing = 16;

Status check(const Limb& limb, const PunctureOperation& puncture) {
  if (const Status status = check_length(puncture.radius, "radius of the puncture"); !status)
    return status;
  if (!puncture.depth) return {};
  if (puncture.is_through)
    return Status::failure(StatusCode::invalid_argument, kNone,
                           "%s: a puncture through the limb has no depth of its own",
                           limb.label.c_str());
  return check_length(*puncture.depth, "depth of the puncture");
}

/// What all rays inside the bore meet together. @return empty if the one in the middle misses.
std::optional<RayHit> look_into(const LimbRays& rays, const ViewFrame& frame, double radius) {
  std::optional<RayHit> all = rays.cast(Vec3d::Zero());
  if (!all) return all;
  double other_before = all->near + all->free_before, other_behind = all->far - all->free_behind;
  for (const double share : {1.0 / 3, 2.0 / 3, 1.0})
    for (int i = 0; i < kRaysPerRing; ++i) {
      const Vec3d offset = share * radius * frame.turned(2 * std::numbers::pi * i / kRaysPerRing);
      const std::optional<RayHit> hit = rays.cast(offset);
      if (!hit) continue;
      all->near = std::max(all->near, hit->near);
      all->far = std::min(all->far, hit->far);
      other_before = std::min(other_before, hit->near + hit->free_before);
      other_behind = std::max(other_behind, hit->far - hit->free_behind);
    }
  all->free_before = std::max(0.0, other_before - all->near);
  all->free_behind = std::max(0.0, all->far - other_behind);
  return all;
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
  rays.look_around(radius + width);
  const std::optional<RayHit> middle = rays.cast(Vec3d::Zero()),
                              all = look_into(rays, *frame, radius);
  if (!middle || !all)
    return Status::failure(StatusCode::not_found, limb->bones.bone(),
                           "%s: the limb has no surface there that is seen from this side",
                           limb->label.c_str());
  const double before = std::min(kClearanceWidths * width, 0.5 * all->free_before),
               behind = std::min(kClearanceWidths * width, 0.5 * all->free_behind);
  const double end = puncture.is_through ? all->far - behind
                     : puncture.depth    ? middle->near - metres(*puncture.depth, width)
                                         : 0.5 * (middle->near + middle->far);
  DrillOperation drill;
  drill.pose = puncture.pose;
  drill.bore.origin = rays.middle() + (all->near + before) * frame->towards_viewer;
  drill.bore.direction = -frame->towards_viewer;
  drill.bore.radius = radius;
  drill.bore.depth = all->near + before - end;
  drill.bore.chord_tolerance = puncture.chord_tolerance;
  drill.bore.wall = puncture.wall;
  drill.bore.weights = puncture.weights;
  return Operation(drill);
}

}  // namespace sunder::aim
