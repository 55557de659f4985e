#pragma once

#include <sunder/ragdoll/ragdoll.h>

#include <optional>
#include <vector>

namespace sunder::ragdoll {

/// The nearest rotation and the translation of a bone's matrix; empty if that is singular.
[[nodiscard]] std::optional<Affine3d> rigid_frame(const Affine3d& model_from_bone);

/// The inverse of a rotation and a translation.
[[nodiscard]] Affine3d inverse_of_rigid(const Affine3d& frame);

/// The rotation from the rigid frame of one bone to that of another one; the identity for a
/// singular matrix.
[[nodiscard]] Quatd turn_between(const ModelPose& pose, std::uint32_t from, std::uint32_t to);

/// The joint between two bodies, as far as it does not depend on where they start.
struct Joint {
  Quatd rest = Quatd::Identity();  ///< From the parent's bone to the body's, at rest.
  BoneLimit limit;                 ///< Its axis along the rigid frame of the body's bone.
};

/// A given limit of a bone, for the body of another one that moves with it.
/// @param joint_bone  that of the limit. @param rest  the pose.
[[nodiscard]] Joint given_joint(const Skeleton& skeleton, const ModelPose& rest,
                                const BoneLimit& limit, std::uint32_t parent_bone,
                                std::uint32_t bone);

/// The limit that holds the turns of a joint in all clips.
/// @param turns  from `rest`. @param direction  along the bone, in its rigid frame.
[[nodiscard]] Joint shown_joint(const Quatd& rest, std::vector<Quatd> turns,
                                const Vec3d& direction);

/// Fixes a joint to a body and its parent as they start, and widens its limit to that.
/// @param origin  of the joint, model space.
void set_joint(const Joint& joint, const ModelPose& pose, const Vec3d& origin,
               const RagdollBody& parent, RagdollBody& body);

}  // namespace sunder::ragdoll
