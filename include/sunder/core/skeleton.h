#pragma once

#include <sunder/core/math.h>

#include <string>
#include <vector>

namespace sunder {

/// One bone's transform relative to its parent: T * R * S.
struct BoneTransform {
  Vec3f translation = Vec3f::Zero();
  Quatf rotation = Quatf::Identity();  ///< Unit length.
  Vec3f scale = Vec3f::Ones();         ///< May be negative or zero.

  bool operator==(const BoneTransform& other) const {
    return translation == other.translation && rotation.coeffs() == other.rotation.coeffs() &&
           scale == other.scale;
  }
};

struct Bone {
  std::string name;              ///< Unique in its skeleton, not empty.
  std::uint32_t parent = kNone;  ///< Smaller than the bone's own index, or kNone at a root.
  BoneTransform rest;            ///< parent_from_bone as stored in the file.

  bool operator==(const Bone&) const = default;
};

/// The whole transform tree of a character, parents before children. In addition to the bones that
/// deform skins it holds armature nodes and the nodes of rigid parts, so that every mesh is posed
/// in the same way.
struct Skeleton {
  std::vector<Bone> bones;

  bool operator==(const Skeleton&) const = default;
};

/// A pose as animation produces it: one transform per bone, relative to its parent, and the morph
/// weights.
struct Pose {
  std::vector<BoneTransform> parent_from_bone;  ///< One per bone of the skeleton.
  std::vector<float> morph_weights;             ///< As Character::rest_morph_weights.
};

/// A pose as deformation reads it: one affine matrix per bone, in model space. It can come from
/// any source.
struct ModelPose {
  std::vector<Affine3d> model_from_bone;  ///< One per bone of the skeleton.
  std::vector<float> morph_weights;       ///< As Character::rest_morph_weights.
};

}  // namespace sunder
