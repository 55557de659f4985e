#pragma once

#include <sunder/core/skeleton.h>

#include <cstddef>
#include <span>

#include "core/internal/ordered.h"

namespace sunder::skinning {

inline Affine3d to_matrix(const BoneTransform& transform) {
  Affine3d matrix;
  matrix.linear() = normalized(transform.rotation.cast<double>()).toRotationMatrix() *
                    transform.scale.cast<double>().asDiagonal();
  matrix.translation() = transform.translation.cast<double>();
  return matrix;
}

/// model_from_bone of every bone: local transforms multiplied down the tree.
/// @param parent_from_bone  called once with each bone, ascending; returns its BoneTransform.
/// @param model_from_bone   one matrix per bone, written.
template <class ParentFromBone>
void multiply_down(const Skeleton& skeleton, const ParentFromBone& parent_from_bone,
                   std::span<Affine3d> model_from_bone) {
  for (std::size_t bone = 0; bone < skeleton.bones.size(); ++bone) {
    const Affine3d local = to_matrix(parent_from_bone(bone));
    const std::uint32_t parent = skeleton.bones[bone].parent;
    if (parent == kNone)
      model_from_bone[bone] = local;
    else
      model_from_bone[bone] = multiply(model_from_bone[parent], local);
  }
}

}  // namespace sunder::skinning
