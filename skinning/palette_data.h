#pragma once

#include <sunder/skinning/bone_palette.h>

#include <vector>

namespace sunder::skinning {

/// The state of a BonePalette: arrays of numbers, slot after slot, as the kernels read them.
struct PaletteData {
  /// Rigid motions and stretches, for dual quaternions only: matrix = motion * stretch.
  struct DualQuaternions {
    std::vector<float> motions;  ///< 8 per slot: real part x y z w, dual part x y z w.
    /// 18 per slot: the stretch and its normal_matrix(), both minus the identity.
    std::vector<float> stretches;
    std::vector<std::uint8_t> is_stretched;  ///< 1 per slot.
  };
  /// The last pose that was set, to find out what changed.
  struct LastPose {
    std::vector<Affine3d> model_from_bone;  ///< 1 per slot.
    Affine3d model_from_character = Affine3d::Identity();
    const Skin* skin = nullptr;  ///< nullptr: matrices were set instead of a pose.
  };

  SkinningMethod method = SkinningMethod::linear;
  std::uint64_t id = 0;        ///< Unique in the process.
  std::uint64_t revision = 0;  ///< 0: no pose yet.
  std::size_t slots = 0;

  std::vector<float> matrices;          ///< 12 per slot, column by column.
  std::vector<float> normal_matrices;   ///< 9 per slot: normal_matrix() of the linear part.
  std::vector<std::uint8_t> is_uneven;  ///< 1 per slot: whether normals need their own matrix.
  bool any_uneven = false;
  std::vector<float> morph_weights;
  std::vector<std::uint64_t> revisions;  ///< One per slot, then one per morph weight.

  DualQuaternions dual;
  LastPose last;
  std::vector<Affine3f> fresh;  ///< Scratch memory.
};

}  // namespace sunder::skinning
