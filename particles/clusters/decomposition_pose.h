#pragma once

#include <sunder/core/character.h>

#include <array>
#include <vector>

namespace sunder::particles {

/// The pose of the decomposition, which does not change: positions of vertices in it, in single
/// precision. That is enough for distances along the surface, and create() poses every point.
/// SurfacePose computes positions in other poses, in double.
class DecompositionPose {
 public:
  DecompositionPose() = default;
  /// @param pose  of the character; unchecked.
  DecompositionPose(const Character& character, const ModelPose& pose);

  /// Metres, model space. O(influences + morph targets).
  [[nodiscard]] Vec3f place(const Mesh& mesh, Index vertex) const;

 private:
  using Column = Eigen::Array<float, 4, 1>;
  /// The columns of an affine matrix as whole packets of four; three rows would not fill them.
  using Columns = std::array<Column, 4>;
  std::vector<std::vector<Columns>> palettes_;  ///< Per skin and slot.
  std::vector<float> morph_weights_;
};

}  // namespace sunder::particles
