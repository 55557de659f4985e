#pragma once

#include <sunder/skinning/pose.h>
#include <sunder/validation/validation.h>

#include <memory>
#include <string_view>
#include <vector>

namespace sunder::validation {

/// Poses of the source's skeleton: per pose and bone model_from_bind, the identity in bind.
struct PoseBatch {
  std::string_view name;
  bool is_independent = false;  ///< Random samples of one distribution.
  std::vector<std::vector<Affine3d>> poses;
};

/// Samples of all clips, as many poses of a range of motion as are worth it, and random poses.
/// @return an empty batch where a model has no clips or no bending.
[[nodiscard]] std::vector<PoseBatch> make_pose_batches(
    const std::shared_ptr<const Character>& source, const ModelPose& bind,
    const ValidationOptions& options);

/// The random poses alone: every bone turns about its origin, from its place in the rest pose, by
/// an angle up to `options.random_angle`, half of the time by exactly that angle.
[[nodiscard]] PoseBatch make_random_poses(const Character& source, const ModelPose& bind,
                                          const ValidationOptions& options);

/// The pose as other parts of the library take it.
[[nodiscard]] ModelPose model_pose(const std::vector<Affine3d>& model_from_bind,
                                   const ModelPose& bind);

}  // namespace sunder::validation
