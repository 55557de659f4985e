#pragma once

#include <sunder/core/api.h>
#include <sunder/core/character.h>

#include <cstdint>
#include <memory>
#include <span>

namespace sunder {

namespace skinning {
struct PaletteData;
}

enum class SkinningMethod : std::uint8_t {
  linear,           ///< Blends matrices: p = sum_k w_k M_k v. Collapses at large twists.
  dual_quaternion,  ///< Blends rigid motions, after the blended stretch of bones that are not
                    ///< rigid: twists keep their volume.
};

/// The matrices of one skin in one pose, in float as deformation reads them, the morph weights, and
/// since when each of them is what it is: SkinnedMesh::deform() leaves alone what did not change.
class SUNDER_API BonePalette {
 public:
  /// @param slots          of the skin.
  /// @param morph_weights  of the pose.
  BonePalette(std::size_t slots, std::size_t morph_weights,
              SkinningMethod method = SkinningMethod::linear);
  ~BonePalette();
  BonePalette(BonePalette&&) noexcept;
  BonePalette& operator=(BonePalette&&) noexcept;

  /// Takes the pose of a skin. Posed vertices are then relative to `model_from_character`, a frame
  /// that moves with the character: its matrices are multiplied in double, so that a character
  /// loses nothing far from the origin, and one that only travels does not change.
  /// @return size_mismatch, index_out_of_range, or non_finite_value with the slot (nothing is
  /// taken).
  ///
  /// O(slots), no allocation, reentrant. A pose that is the same bit for bit costs its comparison.
  [[nodiscard]] Status set(const Skin& skin, const ModelPose& pose,
                           const Affine3d& model_from_character = Affine3d::Identity());

  /// Takes matrices that an engine computed.
  /// @param character_from_bind  one a slot.
  /// @return size_mismatch, or non_finite_value with the slot (nothing is taken).
  [[nodiscard]] Status set(std::span<const Affine3f> character_from_bind,
                           std::span<const float> morph_weights);

  [[nodiscard]] SkinningMethod method() const;
  /// Grows whenever something changed. 0: no pose yet.
  [[nodiscard]] std::uint64_t revision() const;
  /// Revision at which a slot's matrix became what it is.
  [[nodiscard]] std::uint64_t revision_of(std::size_t slot) const;

  [[nodiscard]] const skinning::PaletteData& data() const {
    return *data_;
  }  ///< For the library itself.

 private:
  std::unique_ptr<skinning::PaletteData> data_;
};

}  // namespace sunder
