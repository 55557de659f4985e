#pragma once

#include <sunder/core/skeleton.h>

#include <vector>

namespace sunder {

/// What animation writes: a transform a bone, relative to its parent, and the morph weights.
struct Pose {
  std::vector<BoneTransform> parent_from_bone;  ///< One a bone of the skeleton.
  std::vector<float> morph_weights;             ///< As Character::rest_morph_weights.
};

/// What deformation reads: where each bone stands in model space. Full matrices, so that a pose can come from anything.
struct ModelPose {
  std::vector<Affine3d> model_from_bone;  ///< One a bone of the skeleton.
  std::vector<float> morph_weights;       ///< As Character::rest_morph_weights.
};

}  // namespace sunder
