#pragma once

#include <sunder/core/character.h>
#include <sunder/operation/pose_spec.h>

#include <cstdint>
#include <vector>

namespace sunder::skinning {

/// An axis about which a bone turns.
struct Hinge {
  std::uint32_t bone = 0;
  Vec3d axis = Vec3d::UnitX();  ///< In the bone's own frame; unit length.
};

struct Turn {
  std::uint32_t hinge = kNone;  ///< In JointSweeps::hinges; kNone: no turn.
  double angle = 0;             ///< Radians about rest.
};

/// One pose: a bone turned, and its parent or nothing.
struct Sweep {
  Turn bone, parent;
};

/// The poses of a range of motion, or of limited joints alone.
struct JointSweeps {
  std::vector<Hinge> hinges;
  std::vector<Sweep> fit, held_out;
};

/// Bones ascending; of each its axes, angles ascending, then those with its parent.
/// @param character  satisfies validate_character().
/// @param spec       its limits name bones, are finite and not reversed, and their axes have
/// length.
[[nodiscard]] JointSweeps make_joint_sweeps(const Character& character, const PoseSetSpec& spec);

/// Rest, but for the turns of a sweep.
/// @param pose  resized to fit.
void compute_sweep(const Character& character, const JointSweeps& sweeps, const Sweep& sweep,
                   ModelPose& pose);

}  // namespace sunder::skinning
