#pragma once

#include <sunder/core/character.h>

#include <array>
#include <vector>

namespace sunder::particles {

/// The decomposition's pose, which stays: where it puts vertices, in single precision. Distances
/// along the surface need no more, and create() poses every point. Where points are in any other
/// pose, in double, SurfacePose says.
class DecompositionPose {
 public:
  DecompositionPose() = default;
  /// @param pose  of the character; unchecked.
  DecompositionPose(const Character& character, const ModelPose& pose);

  /// Metres, model space. O(influences + morph targets).
  [[nodiscard]] Vec3f place(const Mesh& mesh, Index vertex) const;

 private:
  using Column = Eigen::Array<float, 4, 1>;
  /// The columns of an affine matrix, in whole packets, which three rows do not fill.
  using Columns = std::array<Column, 4>;
  std::vector<std::vector<Columns>> palettes_;  ///< Per skin and slot.
  std::vector<float> morph_weights_;
};

}  // namespace sunder::particles
