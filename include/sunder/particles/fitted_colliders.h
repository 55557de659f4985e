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
/// that push the tissue of another one. One convex shape per bone; bones without vertices have
/// none.
///
/// @param character  satisfies validate_character(), or has no mesh.
/// @param friction   of all colliders.
/// @return in the order of the bones; the first fault of the character; invalid_argument for the
/// friction; limit_exceeded: out of memory. O(vertices), allocates.
[[nodiscard]] SUNDER_API Result<std::vector<BoneCollider>> fit_colliders(const Character& character,
                                                                         double friction = 0.0);

/// The collider in model space. @param model_from_bone  a rotation and a translation.
[[nodiscard]] SUNDER_API Collider posed_collider(const BoneCollider& collider,
                                                 const Affine3d& model_from_bone);

}  // namespace sunder
