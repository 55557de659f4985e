#pragma once

#include <sunder/core/character.h>
#include <sunder/particles/collider.h>

#include <cstdint>
#include <vector>

namespace sunder {

/// A collider that a bone carries: `place` and `turn` are in the bone's frame.
struct BoneCollider {
  std::uint32_t bone = 0;
  Collider collider;
};

/// The ball, capsule or box of least volume, along the principal axes, around the vertices that
/// each bone moves predominantly: colliders for the links of a robot, or the limbs of a character,
/// that push the tissue of another one. Bones without vertices have none.
///
/// @param character      satisfies validate_character(), or has no mesh.
/// @param friction       of all colliders.
/// @param most_per_bone  how many shapes a bone may have, >= 1. With more than one, a shape is cut
///                       in two where that takes most off the volume, as long as it takes a
///                       twentieth. Each triangle between a bone's vertices is within one
///                       of its shapes.
/// @return in the order of the bones; the first fault of the character; invalid_argument for the
/// friction or the number of shapes; limit_exceeded: out of memory. O(vertices x shapes),
/// allocates.
[[nodiscard]] SUNDER_API Result<std::vector<BoneCollider>> fit_colliders(
    const Character& character, double friction = 0.0, std::uint32_t most_per_bone = 1);

/// The collider in model space. @param model_from_bone  a rotation and a translation.
[[nodiscard]] SUNDER_API Collider posed_collider(const BoneCollider& collider,
                                                 const Affine3d& model_from_bone);

}  // namespace sunder
