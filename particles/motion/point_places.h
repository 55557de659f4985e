#pragma once

#include <sunder/tear/torn_model.h>

#include <vector>

#include "particles/motion/spring_graph.h"

namespace sunder::particles {

/// Where a pose puts points, in double, as skinning does.
class PointPlaces {
 public:
  /// @param epoch  of the pose: nothing is computed for the same one again. The pose was checked.
  void set_pose(const TornModel& model, const ModelPose& pose, std::uint64_t epoch);
  /// O(influences of the point). Zero for a point of no face.
  [[nodiscard]] Vec3d place(const TornModel& model, Index point) const;

 private:
  std::vector<Index> first_slot_;
  std::vector<Affine3d> palette_;
  std::vector<float> morph_weights_;
  std::uint64_t epoch_ = 0;
};

}  // namespace sunder::particles
