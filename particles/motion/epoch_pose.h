#pragma once

#include "particles/clusters/surface_pose.h"

namespace sunder::particles {

/// The surface in the pose of an epoch (RestMotion::epoch()), computed on first use.
class EpochPose {
 public:
  ///
  /// @param pose  that of the epoch, checked.
  const SurfacePose& at(const TornModel& model, const ModelPose& pose, std::uint64_t epoch) {
    if (epoch_ == epoch) return pose_;
    const std::vector<Skin>& skins = model.character().skins;
    pose_.begin(skins, pose.morph_weights.size());
    (void)pose_.set(skins, pose);
    epoch_ = epoch;
    return pose_;
  }

 private:
  SurfacePose pose_;
  std::uint64_t epoch_ = 0;
};

}  // namespace sunder::particles
