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

class SkinnedMesh;

enum class SkinningMethod : std::uint8_t {
  linear,           ///< Blends matrices: p = sum_k w_k M_k v. Loses volume at strong twists.
  dual_quaternion,  ///< Blends rigid motions after the blended stretch of non-rigid bones. Keeps
                    ///< volume at twists.
};

/// The matrices of one skin in one pose, in float as deformation reads them, and the morph weights.
/// Each entry has a revision, by which SkinnedMesh::deform() leaves vertices alone that did not
/// change.
///
/// Not thread-safe: set() must not run at the same time as any other use of the same palette. Const
/// functions may run concurrently.
class SUNDER_API BonePalette {
 public:
  /// @param slots          number of slots of the skin.
  /// @param morph_weights  number of morph weights of the pose.
  /// @return limit_exceeded: out of memory. Allocates all memory that the palette ever needs.
  [[nodiscard]] static Result<BonePalette> create(std::size_t slots, std::size_t morph_weights,
                                                  SkinningMethod method = SkinningMethod::linear);
  ~BonePalette();
  BonePalette(BonePalette&&) noexcept;
  BonePalette& operator=(BonePalette&&) noexcept;

  /// Sets the pose of a skin.
  /// @param model_from_character  frame that moves with the character. Posed vertices are relative
  ///         to it. It is multiplied in double, so a character far from the origin loses no
  ///         precision, and one that only travels does not change.
  /// @return size_mismatch, index_out_of_range, or non_finite_value with the slot; the palette is
  /// unchanged then.
  /// O(slots), no allocation. A pose that is bit-identical to the last one costs only the
  /// comparison.
  [[nodiscard]] Status set(const Skin& skin, const ModelPose& pose,
                           const Affine3d& model_from_character = Affine3d::Identity());

  /// Sets matrices computed by an engine.
  /// @param character_from_bind  one matrix per slot.
  /// @return size_mismatch, or non_finite_value with the slot; the palette is unchanged then.
  /// O(slots), no allocation.
  [[nodiscard]] Status set(std::span<const Affine3f> character_from_bind,
                           std::span<const float> morph_weights);

  [[nodiscard]] SkinningMethod method() const;
  /// Increases whenever an entry changed. 0: no pose yet.
  [[nodiscard]] std::uint64_t revision() const;
  /// The revision at which the matrix of a slot last changed. @param slot  unchecked.
  [[nodiscard]] std::uint64_t revision_of(std::size_t slot) const;

 private:
  friend class SkinnedMesh;

  explicit BonePalette(std::unique_ptr<skinning::PaletteData> data);
  std::unique_ptr<skinning::PaletteData> data_;
};

}  // namespace sunder
