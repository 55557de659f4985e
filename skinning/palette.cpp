#include <sunder/skinning/deform.h>
#include <sunder/skinning/pose.h>

#include <cmath>

#include "core/internal/ordered.h"
#include "core/internal/out_of_memory.h"
#include "skinning/internal/bone_tree.h"
#include "skinning/normal_matrix.h"

namespace sunder {
namespace {

/// Whether the matrix is invertible to working precision, relative to its own scale.
bool is_invertible(const Mat3d& linear) {
  const double scale = linear.cwiseAbs().maxCoeff();
  return scale > 0 && std::abs(determinant(linear)) > 1e-12 * scale * scale * scale;
}

/// Writes a palette in either precision; the products are computed in double.
template <class Affine>
Status write_palette(const Skin& skin, const ModelPose& pose, std::span<Affine> model_from_bind) {
  if (model_from_bind.size() != skin.bones.size())
    return Status::failure(StatusCode::size_mismatch, kNone,
                           "the palette has %zu entries, the skin has %zu bones",
                           model_from_bind.size(), skin.bones.size());
  for (std::uint32_t slot = 0; slot < skin.bones.size(); ++slot)
    if (skin.bones[slot] >= pose.model_from_bone.size())
      return Status::failure(StatusCode::index_out_of_range, slot,
                             "skin slot %u: bone %u does not exist; the pose has %zu bones", slot,
                             skin.bones[slot], pose.model_from_bone.size());
  for (std::size_t slot = 0; slot < skin.bones.size(); ++slot) {
    const Affine3d product = multiply(pose.model_from_bone[skin.bones[slot]],
                                      Affine3d(skin.bone_from_bind[slot].template cast<double>()));
    model_from_bind[slot] = product.cast<typename Affine::Scalar>();
  }
  return {};
}

ModelPose find_bind_pose(const Character& character) {
  const auto& bones = character.skeleton.bones;
  ModelPose pose;
  pose.morph_weights = character.rest_morph_weights;
  pose.model_from_bone.resize(bones.size());
  std::vector<bool> is_bound(bones.size(), false);
  for (const Mesh& mesh : character.meshes) {
    const Skin& skin = character.skins[mesh.skin];
    for (std::size_t slot = 0; slot < skin.bones.size(); ++slot) {
      const std::uint32_t bone = skin.bones[slot];
      const Affine3d bone_from_bind = skin.bone_from_bind[slot].cast<double>();
      if (is_bound[bone] || !is_invertible(bone_from_bind.linear())) continue;
      // A rigid part is attached to its node at the node's place, so it has no bind pose of its
      // own.
      if (skin.bones.size() == 1 && bone_from_bind.matrix() == Affine3d::Identity().matrix())
        continue;
      pose.model_from_bone[bone] = inverse(bone_from_bind);
      is_bound[bone] = true;
    }
  }
  for (std::size_t i = 0; i < bones.size(); ++i) {
    if (is_bound[i]) continue;
    const Affine3d parent_from_bone = skinning::to_matrix(bones[i].rest);
    if (bones[i].parent == kNone)
      pose.model_from_bone[i] = parent_from_bone;
    else
      pose.model_from_bone[i] = multiply(pose.model_from_bone[bones[i].parent], parent_from_bone);
  }
  return pose;
}

}  // namespace

Status compute_model_pose(const Skeleton& skeleton, const Pose& pose, ModelPose& model_pose) {
  const std::size_t count = skeleton.bones.size();
  if (pose.parent_from_bone.size() != count)
    return Status::failure(StatusCode::size_mismatch, kNone,
                           "the pose has %zu bones, the skeleton has %zu",
                           pose.parent_from_bone.size(), count);
  return or_out_of_memory([&]() -> Status {
    model_pose.morph_weights.reserve(pose.morph_weights.size());
    model_pose.model_from_bone.resize(count);
    skinning::multiply_down(
        skeleton, [&](std::size_t bone) { return pose.parent_from_bone[bone]; },
        model_pose.model_from_bone);
    model_pose.morph_weights = pose.morph_weights;
    return {};
  });
}

Result<ModelPose> rest_pose(const Character& character) {
  return or_out_of_memory([&]() -> Result<ModelPose> {
    ModelPose pose;
    pose.morph_weights = character.rest_morph_weights;
    const auto& bones = character.skeleton.bones;
    pose.model_from_bone.resize(bones.size());
    skinning::multiply_down(
        character.skeleton, [&](std::size_t bone) { return bones[bone].rest; },
        pose.model_from_bone);
    return pose;
  });
}

Result<ModelPose> bind_pose(const Character& character) {
  return or_out_of_memory([&]() -> Result<ModelPose> { return find_bind_pose(character); });
}

Status compute_palette(const Skin& skin, const ModelPose& pose,
                       std::span<Affine3d> model_from_bind) {
  return write_palette(skin, pose, model_from_bind);
}

Status compute_palette(const Skin& skin, const ModelPose& pose,
                       std::span<Affine3f> model_from_bind) {
  return write_palette(skin, pose, model_from_bind);
}

Mat3d compute_normal_matrix(const Mat3d& linear) { return skinning::normal_matrix<double>(linear); }

}  // namespace sunder
