#include <sunder/animation/edit_pose.h>

#include <cmath>

#include "core/internal/ordered.h"
#include "skinning/internal/bone_tree.h"
#include "skinning/internal/rotation.h"

namespace sunder {
namespace {

Status check_bone(const Skeleton& skeleton, std::uint32_t bone, const Pose& pose) {
  if (pose.parent_from_bone.size() != skeleton.bones.size())
    return Status::failure(StatusCode::size_mismatch, kNone,
                           "the pose has %zu bones, the skeleton has %zu",
                           pose.parent_from_bone.size(), skeleton.bones.size());
  if (bone >= skeleton.bones.size())
    return Status::failure(StatusCode::index_out_of_range, bone,
                           "bone %u does not exist; the skeleton has %zu", bone,
                           skeleton.bones.size());
  return {};
}

Status not_finite(std::uint32_t bone, const char* what) {
  return Status::failure(StatusCode::non_finite_value, bone, "the %s of bone %u is not finite",
                         what, bone);
}

/// A unit quaternion from one that the caller gave.
Result<Quatd> checked_rotation(std::uint32_t bone, const Quatd& rotation) {
  const double length = norm(rotation);
  if (!std::isfinite(length)) return not_finite(bone, "new rotation");
  if (!(length > 0.0))
    return Status::failure(StatusCode::invalid_argument, bone,
                           "the new rotation of bone %u has no length", bone);
  return Quatd(rotation.coeffs() / length);
}

Affine3d model_from(const Skeleton& skeleton, const Pose& pose, std::uint32_t bone) {
  Affine3d result = Affine3d::Identity();
  for (; bone != kNone; bone = skeleton.bones[bone].parent)
    result = multiply(skinning::to_matrix(pose.parent_from_bone[bone]), result);
  return result;
}

Affine3d model_from_parent(const Skeleton& skeleton, const Pose& pose, std::uint32_t bone) {
  return model_from(skeleton, pose, skeleton.bones[bone].parent);
}

Status scaled_to_nothing(std::uint32_t bone) {
  return Status::failure(StatusCode::invalid_argument, bone,
                         "bone %u is below one that is scaled to nothing or not finite", bone);
}

/// The rotation relative to the parent that comes nearest to a rotation of the bone's present axes
/// in model space.
Result<Quatd> rotation_in_parent(const Mat3d& model_from_parent, const Mat3d& model_axes,
                                 std::uint32_t bone) {
  const Mat3d relative = multiply(inverse(model_from_parent), model_axes);
  if (!relative.allFinite()) return scaled_to_nothing(bone);
  const auto nearest = nearest_rotation(relative);
  if (!nearest) return scaled_to_nothing(bone);
  return *nearest;
}

}  // namespace

Result<Affine3d> model_from_bone(const Skeleton& skeleton, const Pose& pose, std::uint32_t bone) {
  if (const Status status = check_bone(skeleton, bone, pose); !status) return status;
  return model_from(skeleton, pose, bone);
}

Status rotate_bone(const Skeleton& skeleton, std::uint32_t bone, const Quatd& rotation,
                   EditSpace space, Pose& pose) {
  if (const Status status = check_bone(skeleton, bone, pose); !status) return status;
  const Result<Quatd> turn = checked_rotation(bone, rotation);
  if (!turn) return turn.error();
  Quatf& local = pose.parent_from_bone[bone].rotation;
  const Quatd before = unit(Quatd(local.cast<double>()));
  if (!before.coeffs().allFinite()) return not_finite(bone, "rotation");
  Quatd after = before;
  if (space == EditSpace::bone) {
    after = multiply(before, *turn);
  } else if (space == EditSpace::parent) {
    after = multiply(*turn, before);
  } else {
    const Mat3d parent = model_from_parent(skeleton, pose, bone).linear();
    const Mat3d axes =
        multiply(turn->toRotationMatrix(), multiply(parent, before.toRotationMatrix()));
    const Result<Quatd> found = rotation_in_parent(parent, axes, bone);
    if (!found) return found.error();
    after = *found;
  }
  local = unit(after).cast<float>();
  return {};
}

Status move_bone(const Skeleton& skeleton, std::uint32_t bone, const Vec3d& offset, EditSpace space,
                 Pose& pose) {
  if (const Status status = check_bone(skeleton, bone, pose); !status) return status;
  if (!offset.allFinite()) return not_finite(bone, "offset");
  BoneTransform& local = pose.parent_from_bone[bone];
  Vec3d shift = offset;
  if (space == EditSpace::bone)
    shift = multiply(skinning::to_matrix(local).linear(), offset);
  else if (space == EditSpace::model)
    shift = multiply(inverse(Mat3d(model_from_parent(skeleton, pose, bone).linear())), offset);
  const Vec3f moved = (local.translation.cast<double>() + shift).cast<float>();
  if (!moved.allFinite()) return scaled_to_nothing(bone);
  local.translation = moved;
  return {};
}

Status place_bone(const Skeleton& skeleton, std::uint32_t bone, const Vec3d& position,
                  const Quatd& rotation, Pose& pose) {
  if (const Status status = check_bone(skeleton, bone, pose); !status) return status;
  const Result<Quatd> wanted = checked_rotation(bone, rotation);
  if (!wanted) return wanted.error();
  if (!position.allFinite()) return not_finite(bone, "position");
  const Affine3d parent = model_from_parent(skeleton, pose, bone);
  const Result<Quatd> local = rotation_in_parent(parent.linear(), wanted->toRotationMatrix(), bone);
  if (!local) return local.error();
  const Vec3f place = transform(inverse(parent), position).cast<float>();
  if (!place.allFinite()) return scaled_to_nothing(bone);
  pose.parent_from_bone[bone].translation = place;
  pose.parent_from_bone[bone].rotation = local->cast<float>();
  return {};
}

Status set_bone(const Skeleton& skeleton, std::uint32_t bone, const BoneTransform& parent_from_bone,
                Pose& pose) {
  if (const Status status = check_bone(skeleton, bone, pose); !status) return status;
  if (!parent_from_bone.translation.allFinite()) return not_finite(bone, "new translation");
  if (!parent_from_bone.scale.allFinite()) return not_finite(bone, "new scale");
  const Result<Quatd> rotation = checked_rotation(bone, parent_from_bone.rotation.cast<double>());
  if (!rotation) return rotation.error();
  pose.parent_from_bone[bone] = parent_from_bone;
  // A unit quaternion keeps its bits.
  if (std::abs(norm(parent_from_bone.rotation) - 1.0f) > 1e-6f)
    pose.parent_from_bone[bone].rotation = rotation->cast<float>();
  return {};
}

}  // namespace sunder
