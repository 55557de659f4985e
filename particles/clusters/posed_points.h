#pragma once

#include <sunder/core/character.h>

#include <array>
#include <vector>

namespace sunder::particles {

/// Where vertices are in a pose; in single precision, for distances along the surface.
class PosedPoints {
 public:
  PosedPoints() = default;
  /// @param pose  of the character; unchecked.
  PosedPoints(const Character& character, const ModelPose& pose);

  /// Metres, model space. O(influences + morph targets).
  [[nodiscard]] Vec3f at(const Mesh& mesh, std::uint32_t vertex) const;

 private:
  using Column = Eigen::Array<float, 4, 1>;
  using Columns = std::array<Column, 4>;        ///< Of an affine matrix; whole packets, where three rows are none.
  std::vector<std::vector<Columns>> palettes_;  ///< Of each skin, one a slot.
  std::vector<float> morph_weights_;
};

}  // namespace sunder::particles
