#pragma once

#include <sunder/core/pose.h>

#include <vector>

#include "tear/surface_editor.h"

namespace sunder::tear {

/// Positions of surface points in one pose, in double, computed when first asked for.
class PosedPoints {
 public:
  /// @return size_mismatch or non_finite_value where the pose does not fit the character.
  [[nodiscard]] Status begin(const Character& character, const ModelPose& pose);

  [[nodiscard]] const Vec3d& position(const SurfaceEditor& editor, Index point);

  /// Keeps a point where it was found on the posed surface, instead of where its own weights put it.
  void pin(Index point, const Vec3d& position);
  /// From here on the points from `first_point` up stand where their own weights put them.
  void unpin_from(Index first_point);

 private:
  std::vector<std::vector<Affine3d>> palettes_;  ///< Of each skin.
  std::vector<float> morph_weights_;
  std::vector<Vec3d> positions_;
  std::vector<bool> is_known_;
};

}  // namespace sunder::tear
