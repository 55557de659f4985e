#pragma once

#include <sunder/core/character.h>
#include <sunder/skinning/pose.h>

#include <span>
#include <vector>

#include "skinning/internal/reference.h"

namespace sunder {

/// The palettes of all skins and the morph weights of a character in one pose: everything that
/// poses its vertices. Palettes are computed once per pose, not once per vertex.
class SUNDER_API CharacterPose {
 public:
  /// @return size_mismatch or non_finite_value if the pose does not fit the character.
  [[nodiscard]] static Status check(const Character& character, const ModelPose& pose);

  /// Checks the pose and computes the palettes. On failure of the check nothing changes.
  /// O(slots of all skins); allocates only if the sizes change.
  [[nodiscard]] Status set(const Character& character, const ModelPose& pose);

  [[nodiscard]] const std::vector<Affine3d>& palette(std::size_t skin) const {
    return palettes_[skin];
  }
  [[nodiscard]] std::span<const float> morph_weights() const { return morph_weights_; }

  /// Posed position of a vertex, in double, by deform_position_reference().
  [[nodiscard]] Vec3d position(const Mesh& mesh, std::uint32_t vertex) const {
    return deform_position_reference(mesh, vertex, palettes_[mesh.skin], morph_weights_);
  }
  /// The same for a vertex as if it had the given bind position and influences.
  [[nodiscard]] Vec3d position(const Mesh& mesh, std::uint32_t vertex, const Vec3f& bind_position,
                               std::span<const Influence> influences) const {
    return deform_position_reference(mesh, vertex, bind_position, influences, palettes_[mesh.skin],
                                     morph_weights_);
  }

  /// One per skin.
 private:
  std::vector<std::vector<Affine3d>> palettes_;
  std::vector<float> morph_weights_;
};

}  // namespace sunder
