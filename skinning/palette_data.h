#pragma once

#include <sunder/skinning/bone_palette.h>

#include <vector>

namespace sunder::skinning {

/// What a BonePalette holds. Arrays of numbers, one after another a slot, as the kernels read them.
struct PaletteData {
  SkinningMethod method = SkinningMethod::linear;
  std::uint64_t id = 0;        ///< Of this palette alone, in the process.
  std::uint64_t revision = 0;  ///< 0: no pose yet.
  std::size_t slots = 0;

  std::vector<float> matrices;          ///< 12 a slot, column after column.
  std::vector<float> normal_matrices;   ///< 9 a slot: normal_matrix() of the linear part.
  std::vector<std::uint8_t> is_uneven;  ///< 1 a slot: whether normals need a matrix of their own.
  bool any_uneven = false;
  std::vector<float> morph_weights;
  std::vector<std::uint64_t> revisions;  ///< One a slot, then one a morph weight.

  // Only for dual quaternions: matrix = motion * stretch.
  std::vector<float> motions;  ///< 8 a slot: real part x y z w, dual part x y z w.
  std::vector<float>
      stretches;  ///< 18 a slot: the stretch, and its normal_matrix(), both less the identity.
  std::vector<std::uint8_t> is_stretched;  ///< 1 a slot.

  std::vector<Affine3d> poses;  ///< model_from_bone a slot, as last set.
  Affine3d frame = Affine3d::Identity();
  const Skin* skin = nullptr;   ///< Whose pose that was; nullptr: matrices were set.
  std::vector<Affine3f> fresh;  ///< Scratch.
};

}  // namespace sunder::skinning
