#pragma once

#include <sunder/core/api.h>
#include <sunder/core/skeleton.h>
#include <sunder/core/status.h>

#include <cstdint>
#include <span>
#include <vector>

namespace sunder {

// Weighted sums of local poses. Translations, scales and morph weights are blended linearly.
// Rotations are blended as unit quaternions of the same hemisphere, then normalised, which is the
// shorter arc: within 0.12 degrees of spherical interpolation between rotations 45 degrees apart,
// and within 0.92 between rotations 90 degrees apart. docs/animation.md

/// How much of a layer each bone takes, in [0, 1].
struct BoneMask {
  std::vector<float> bones;    ///< One per bone of the skeleton.
  float morph_weights = 1.0f;  ///< For all morph weights.

  bool operator==(const BoneMask&) const = default;
};

/// A mask of a bone with everything below it. @param inside, outside  in [0, 1].
/// @return index_out_of_range for the bone, invalid_argument for the values; limit_exceeded: out of
/// memory. Morph weights take `outside`. O(bones), allocates.
[[nodiscard]] SUNDER_API Result<BoneMask> subtree_mask(const Skeleton& skeleton, std::uint32_t bone,
                                                       float inside = 1.0f, float outside = 0.0f);

/// The weighted mean of poses of one skeleton. Quaternions are flipped into the hemisphere of the
/// heaviest pose's; the rotations do not depend on their signs.
///
/// @param poses    at least one; not null, of equal sizes.
/// @param weights  one per pose: finite, >= 0, not all zero. They need not sum to one.
/// @param result   resized to fit; may be one of `poses`.
/// @return empty_input, size_mismatch, invalid_argument (nothing is written); limit_exceeded: out
/// of memory. O(poses x bones); no allocation if the result fits.
[[nodiscard]] SUNDER_API Status blend(std::span<const Pose* const> poses,
                                      std::span<const float> weights, Pose& result);

/// Moves a pose towards another one: 0 leaves it as it is, bit for bit, 1 makes it the other one,
/// bit for bit. @param weight  in [0, 1].
/// @param mask  optional: multiplies the weight, per bone.
/// @return size_mismatch, invalid_argument (nothing is written). O(bones), no allocation.
[[nodiscard]] SUNDER_API Status blend_towards(const Pose& other, float weight, Pose& pose,
                                              const BoneMask* mask = nullptr);

/// The difference of two poses, which can be added to any pose: per bone a translation that is
/// added, a rotation in the bone's own frame, and factors of the scale.
struct PoseDelta {
  std::vector<BoneTransform> bones;
  std::vector<float> morph_weights;
};

/// The difference between a pose and a reference, such that reference + difference = pose. Where
/// the reference has a scale of zero, the factor is 1.
/// @param delta  resized to fit.
/// @return size_mismatch (nothing is written); limit_exceeded: out of memory. O(bones); no
/// allocation if `delta` fits.
[[nodiscard]] SUNDER_API Status make_additive(const Pose& pose, const Pose& reference,
                                              PoseDelta& delta);

/// Adds `weight` of a difference to a pose. 0 changes nothing.
/// @param weight  in [0, 1]. @param mask  optional: multiplies the weight, per bone.
/// @return size_mismatch, invalid_argument (nothing is written). O(bones), no allocation.
[[nodiscard]] SUNDER_API Status add(const PoseDelta& delta, float weight, Pose& pose,
                                    const BoneMask* mask = nullptr);

}  // namespace sunder
