#include "tools/transfer/place_question.h"

#include <sunder/skinning/pose.h>

#include <cmath>

#include "tools/messages/printed.h"
#include "tools/model/posed_model.h"

namespace sunder::tools {
namespace {

/// The same model in another unit may have other details: hair, a base.
constexpr double kLeastRatio = 3;

Bounds bind_bounds(const Character& character) {
  const Result<ModelPose> pose = bind_pose(character);
  const auto posed =
      pose ? pose_positions(character, *pose) : Result<std::vector<DeformedMesh>>(pose.error());
  return posed ? bounds_of(character, *posed) : Bounds();
}

std::string span_text(const Bounds& bounds) {
  return "spans " + point_text(bounds.least) + " to " + point_text(bounds.greatest);
}

}  // namespace

std::string question_of_place(const Character& source, const Character& target) {
  const Bounds of_source = bind_bounds(source), of_target = bind_bounds(target);
  if (of_source.is_empty() || of_target.is_empty()) return {};
  const double ratio = of_target.size().norm() / of_source.size().norm();
  std::string question =
      "the source " + span_text(of_source) + ", the target " + span_text(of_target) + ": ";
  if (ratio >= kLeastRatio || ratio <= 1 / kLeastRatio)
    return question + printed(
                          "it is %.3g times as large; are both in the same unit, and in the "
                          "same place?",
                          ratio);
  const Vec3d apart = of_target.centre() - of_source.centre();
  return question + printed(
                        "its middle is %.3g m away; do both stand in the same place and bind "
                        "pose, and have they the same unit?",
                        apart.norm());
}

}  // namespace sunder::tools
