#include <sunder/ragdoll/ragdoll.h>

#include "core/internal/ordered.h"
#include "pipeline/ragdoll/joint_frames.h"
#include "skinning/internal/rotation.h"

namespace sunder {
namespace {

Status check_count(std::size_t count, std::size_t expected, const char* what) {
  if (count == expected) return {};
  return Status::failure(StatusCode::size_mismatch, kNone, "there are %zu %s; expected %zu", count,
                         what, expected);
}

/// Where a matrix of its bone puts a body. @return nothing if the bone's matrix is singular.
std::optional<Affine3d> place_of(const Ragdoll& ragdoll, const RagdollBody& body,
                                 const Affine3d& model_from_bone) {
  const std::optional<Affine3d> at_start = ragdoll::rigid_frame(ragdoll.body_from_bone[body.bone]);
  const std::optional<Affine3d> now = ragdoll::rigid_frame(model_from_bone);
  if (!at_start || !now) return std::nullopt;
  return multiply(*now, ragdoll::inverse_of_rigid(*at_start));
}

}  // namespace

Status place_bodies(const Ragdoll& ragdoll, const ModelPose& pose,
                    std::span<Affine3d> model_from_body) {
  if (Status status = check_count(pose.model_from_bone.size(), ragdoll.body_of_bone.size(),
                                  "matrices of bones");
      !status)
    return status;
  if (Status status = check_count(model_from_body.size(), ragdoll.bodies.size(), "places"); !status)
    return status;
  for (const RagdollBody& body : ragdoll.bodies)
    if (!place_of(ragdoll, body, pose.model_from_bone[body.bone]))
      return Status::failure(StatusCode::non_finite_value, body.bone,
                             "the matrix of bone %u is singular or not finite", body.bone);
  for (std::size_t i = 0; i < ragdoll.bodies.size(); ++i)
    model_from_body[i] =
        *place_of(ragdoll, ragdoll.bodies[i], pose.model_from_bone[ragdoll.bodies[i].bone]);
  return {};
}

Status joint_turns(const Ragdoll& ragdoll, std::span<const Affine3d> model_from_body,
                   std::span<Quatd> turns) {
  if (Status status = check_count(model_from_body.size(), ragdoll.bodies.size(), "places"); !status)
    return status;
  if (Status status = check_count(turns.size(), ragdoll.bodies.size(), "turns"); !status)
    return status;
  for (std::size_t i = 0; i < ragdoll.bodies.size(); ++i) {
    const RagdollBody& body = ragdoll.bodies[i];
    turns[i] = Quatd::Identity();
    if (body.parent == kNone) continue;
    const Mat3d at_parent = multiply(Mat3d(model_from_body[body.parent].linear()),
                                     Mat3d(body.parent_from_joint.linear()));
    const Mat3d at_body =
        multiply(Mat3d(model_from_body[i].linear()), Mat3d(body.body_from_joint.linear()));
    turns[i] = unit(Quatd(multiply(Mat3d(at_parent.transpose()), at_body)));
  }
  return {};
}

Status pose_of_bodies(const Ragdoll& ragdoll, std::span<const Affine3d> model_from_body,
                      ModelPose& pose) {
  if (Status status = check_count(model_from_body.size(), ragdoll.bodies.size(), "places"); !status)
    return status;
  if (Status status = check_count(pose.model_from_bone.size(), ragdoll.body_of_bone.size(),
                                  "matrices of bones");
      !status)
    return status;
  for (std::uint32_t i = 0; i < model_from_body.size(); ++i)
    if (!model_from_body[i].matrix().allFinite())
      return Status::failure(StatusCode::non_finite_value, i, "the place of body %u is not finite",
                             i);
  for (std::size_t bone = 0; bone < ragdoll.body_of_bone.size(); ++bone)
    pose.model_from_bone[bone] =
        multiply(model_from_body[ragdoll.body_of_bone[bone]], ragdoll.body_from_bone[bone]);
  return {};
}

}  // namespace sunder
