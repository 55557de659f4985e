#pragma once

#include <sunder/core/api.h>
#include <sunder/core/skeleton.h>
#include <sunder/core/status.h>

#include <cstdint>

namespace sunder {

// Changes of single bones of a local pose. Bones below follow. A call that fails changes nothing.
// All cost O(depth of the bone) and do not allocate. They return index_out_of_range for the bone,
// size_mismatch for a pose of another skeleton, non_finite_value, and invalid_argument for a
// rotation without length or, in model space, for a bone below one that is scaled to nothing.

/// The axes along which an edit is given.
enum class EditSpace : std::uint8_t {
  bone,    ///< The bone's own axes.
  parent,  ///< The axes of the bone's parent.
  model,
};

/// Model space from the bone, as compute_model_pose() has it.
[[nodiscard]] SUNDER_API Result<Affine3d> model_from_bone(const Skeleton& skeleton,
                                                          const Pose& pose, std::uint32_t bone);

/// Turns a bone about its own origin. Below bones that are scaled unevenly, a turn in model space
/// would shear the bone; it gets the nearest rotation instead.
/// @param rotation  of any length except zero.
[[nodiscard]] SUNDER_API Status rotate_bone(const Skeleton& skeleton, std::uint32_t bone,
                                            const Quatd& rotation, EditSpace space, Pose& pose);

/// Shifts a bone. @param offset  metres; along scaled axes in the unit of those axes.
[[nodiscard]] SUNDER_API Status move_bone(const Skeleton& skeleton, std::uint32_t bone,
                                          const Vec3d& offset, EditSpace space, Pose& pose);

/// Puts a bone's origin and axes to a place in model space; its scale stays. Below a mirrored bone
/// only rotations of the mirrored axes exist: the third axis points the other way.
[[nodiscard]] SUNDER_API Status place_bone(const Skeleton& skeleton, std::uint32_t bone,
                                           const Vec3d& position, const Quatd& rotation,
                                           Pose& pose);

/// Replaces a bone's transform relative to its parent. The rotation gets unit length.
[[nodiscard]] SUNDER_API Status set_bone(const Skeleton& skeleton, std::uint32_t bone,
                                         const BoneTransform& parent_from_bone, Pose& pose);

}  // namespace sunder
