#pragma once

#include <sunder/core/character.h>
#include <sunder/operation/pose_spec.h>

#include <cstdint>
#include <vector>

namespace sunder::skinning {

/// An axis about which a bone rotates.
struct Hinge {
  std::uint32_t bone = 0;
  Vec3d axis = Vec3d::UnitX();  ///< In the bone's own frame; unit length.
};

/// A rotation about a hinge.
struct Turn {
  std::uint32_t hinge = kNone;  ///< In JointSweeps::hinges; kNone: no rotation.
  double angle = 0;             ///< Radians, relative to rest.
};

/// One pose: a rotated bone, and optionally its rotated parent.
struct Sweep {
  Turn bone, parent;
};

/// The poses of a range of motion, or of the limited joints alone.
struct JointSweeps {
  std::vector<Hinge> hinges;
  std::vector<Sweep> fit, held_out;
};

/// Bones are ascending; per bone the poses of its axes come first, by ascending angle, then those
/// with its parent.
/// @param character  satisfies validate_character().
/// @param spec       its limits are valid: existing bones, finite and ordered angles, axes with a
///         length.
[[nodiscard]] JointSweeps make_joint_sweeps(const Character& character, const PoseSetSpec& spec);

/// The rest pose with the rotations of a sweep. @param pose  resized to fit.
void compute_sweep(const Character& character, const JointSweeps& sweeps, const Sweep& sweep,
                   ModelPose& pose);

}  // namespace sunder::skinning
