#pragma once

#include <sunder/core/character.h>
#include <sunder/skinning/pose.h>

#include <cstdint>
#include <vector>

namespace sunder::skinning {

/// Samples a clip into model space bone by bone, without a Pose in between, which would need
/// memory. The result has the bits of sample_clip() over local_rest_pose(), followed by
/// compute_model_pose().
class ClipSampler {
 public:
  /// @param clip  one of a character that passed validate_character().
  explicit ClipSampler(const Clip& clip);

  /// @param character, clip  those given to the constructor.
  /// @param pose             resized to fit.
  void sample(const Character& character, const Clip& clip, double time, ModelPose& pose) const;

 private:
  // The channels of one bone keep the order of the clip, because they may drive the same part.
  std::vector<std::uint32_t> bone_channels_;  // ascending by bone
  std::vector<std::uint32_t> morph_channels_;
};

}  // namespace sunder::skinning
