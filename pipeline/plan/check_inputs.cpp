#include "pipeline/plan/check_inputs.h"

#include <algorithm>
#include <cmath>

namespace sunder::plan {
namespace {

constexpr double kMostSeconds = 3600;

Status check_seconds(double seconds, const char* name) {
  if (seconds > 0 && seconds <= kMostSeconds) return {};
  return Status::failure(StatusCode::invalid_argument, kNone,
                         "%s takes %g s; it must be above 0 and at most %g", name, seconds,
                         kMostSeconds);
}

}  // namespace

Status check_timing(const PlanTiming& timing, const PlanOptions& options) {
  if (const Status status = check_seconds(timing.approach, "the approach"); !status) return status;
  if (const Status status = check_seconds(timing.cut, "the cut"); !status) return status;
  if (const Status status = check_seconds(timing.retreat, "the retreat"); !status) return status;
  if (!(timing.standoff >= 0) || !std::isfinite(timing.standoff))
    return Status::failure(StatusCode::invalid_argument, kNone,
                           "the standoff is %g; it must be at least 0", timing.standoff);
  if (!(timing.clip_speed >= 0) || !std::isfinite(timing.clip_speed))
    return Status::failure(StatusCode::invalid_argument, kNone,
                           "the clip's speed is %g; it must be at least 0", timing.clip_speed);
  if (timing.clip_speed > 0 && !std::holds_alternative<ClipPose>(timing.pose))
    return Status::failure(StatusCode::invalid_argument, kNone,
                           "clip speed is %g, but the pose is none of a clip", timing.clip_speed);
  if (!(options.tolerance >= 0) || !std::isfinite(options.tolerance))
    return Status::failure(StatusCode::invalid_argument, kNone,
                           "the tolerance is %g; it must be at least 0", options.tolerance);
  if (!(options.clearance > 0) || !std::isfinite(options.clearance))
    return Status::failure(StatusCode::invalid_argument, kNone,
                           "the clearance is %g; it must be above 0", options.clearance);
  if (!(options.maximum_acceleration >= 0) || !std::isfinite(options.maximum_acceleration))
    return Status::failure(StatusCode::invalid_argument, kNone,
                           "the greatest acceleration is %g; it must be at least 0",
                           options.maximum_acceleration);
  return {};
}

Status check_blade(const WoundTarget& target, const BladeChain& chain) {
  const double depth = *std::max_element(target.depth.begin(), target.depth.end());
  if (chain.blade_length() > depth) return {};
  return Status::failure(StatusCode::invalid_argument, kNone,
                         "the blade is %g m long; it cannot reach %g m below the surface",
                         chain.blade_length(), depth);
}

Status check_shapes(const PlanTool& tool) {
  for (std::uint32_t i = 0; i < tool.shapes.size(); ++i) {
    if (tool.shapes[i].bone >= tool.robot.links.size())
      return Status::failure(StatusCode::index_out_of_range, i,
                             "shape %u: link %u does not exist; the robot has %zu", i,
                             tool.shapes[i].bone, tool.robot.links.size());
    if (const Status status = validate_collider(tool.shapes[i].collider); !status) return status;
  }
  return {};
}

}  // namespace sunder::plan
