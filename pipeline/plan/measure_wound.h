#pragma once

#include <sunder/plan/plan.h>

#include <memory>
#include <vector>

#include "pipeline/plan/target_path.h"

namespace sunder::plan {

/// Distances of the lips of a tear and a curve on the same surface.
struct WoundMeasures {
  /// Infinity if there are no lips.
  double hausdorff = 0, mean_distance = 0, hausdorff_in_clips = 0;
  double farthest_share = 0;  ///< Of the curve, about: the place of the largest distance.
  /// For TargetPath::aim_beside(): from the nearest place of the lips to each anchor of the curve.
  std::vector<Vec2d> missed_by;
  TearReport torn;
};

/// Tears a copy of the character, without width and walls, and measures its lips.
/// @param pose  in which `hausdorff` and `mean_distance` are measured.
[[nodiscard]] Result<WoundMeasures> measure_wound(const std::shared_ptr<const Character>& character,
                                                  const TargetPath& path, const TearOperation& tear,
                                                  const ModelPose& pose);

}  // namespace sunder::plan
