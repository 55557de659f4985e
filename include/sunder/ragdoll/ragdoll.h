#pragma once

#include <sunder/animation/pull.h>
#include <sunder/bodies/convex_hulls.h>
#include <sunder/bodies/mass_properties.h>
#include <sunder/core/character.h>
#include <sunder/particles/collider.h>

#include <cstdint>
#include <span>
#include <vector>

namespace sunder {

// A character, or a piece that came off one, as rigid bodies and joints for a physics engine:
// bodies to begin with, targets for motors, and the pose in which bodies put the bones.
// docs/ragdoll.md

struct RagdollOptions {
  /// While there are more, the lightest body joins another one. 1 to 1024.
  std::uint32_t maximum_bodies = 16;
  /// So does a body with a smaller share of the mass, such as a finger of a whole body; 0 to 1.
  double least_share = 0.002;
  MassOptions mass;  ///< Of the whole; its bodies have masses in proportion to their volumes.
  /// Limits of joints: at most one per bone, as for PosePuller::create(). A joint without one turns
  /// as far as the clips show, in up to 1,536 poses, which takes most of the time: make the ragdoll
  /// of the whole character once, and give the limits of its bodies to those of its pieces. All are
  /// widened to the starting pose.
  std::span<const BoneLimit> limits;
};

/// A rigid body, which moves a bone, and its joint to the body above.
struct RagdollBody {
  std::uint32_t bone = kNone;    ///< The bone that moves its part of the surface.
  std::uint32_t parent = kNone;  ///< Body to which the joint ties it, before it in the list; kNone:
                                 ///< there is no joint, and what follows `shape` has no meaning.
  double mass = 0.0;             ///< Kilograms, > 0.
  Vec3d moments = Vec3d::Zero();  ///< Of inertia, about the body's axes, kg m^2, > 0, ascending.
  /// Where it starts: origin at its centre of mass, axes the principal ones; a rotation and a
  /// translation, as all frames here.
  Affine3d model_from_body = Affine3d::Identity();
  /// The ball, capsule or box of least volume around its part of the surface, in its frame.
  Collider shape{Collider::Sphere{1.0}};
  /// The frame of the joint, fixed to the parent and fixed to this body. The origins coincide in
  /// the starting pose, the axes where the limit's angles are zero. x is the axis of the limit.
  Affine3d parent_from_joint = Affine3d::Identity();
  Affine3d body_from_joint = Affine3d::Identity();
  /// A hinge turns about x alone, from lower to upper; in a cone x swings by at most `cone`, and
  /// twists from lower to upper.
  BoneLimit limit;
};

struct Ragdoll {
  std::vector<RagdollBody> bodies;
  std::vector<std::uint32_t> body_of_bone;  ///< Per bone: the body with which it moves.
  /// Per bone: its matrix in the frame of that body, in the starting pose.
  std::vector<Affine3d> body_from_bone;
};

/// Makes a body of each bone that moves a part of the surface most, unless it is too light, and
/// ties it to the body of the nearest bone above it; bodies that have none above them, but a bone,
/// to the heaviest of those.
/// @param character  satisfies validate_character(), with at least one triangle.
/// @param pose       in which it stands.
/// @return the failures of compute_mass(); the first fault of the pose or a limit; empty_input
///         without a triangle; invalid_argument for the options; limit_exceeded: out of memory.
/// O(T log T + bones), and O(poses x (bones + keys)) if a joint has no limit given; allocates.
[[nodiscard]] SUNDER_API Result<Ragdoll> make_ragdoll(const Character& character,
                                                      const ModelPose& pose,
                                                      const RagdollOptions& options = {});

/// The convex hulls of the bodies' parts of the surface, each in its body's frame.
/// @param character, pose  those of make_ragdoll().
/// @return one per body; as convex_hulls(); size_mismatch for another character.
[[nodiscard]] SUNDER_API Result<std::vector<ConvexHull>> hulls_of_ragdoll(
    const Ragdoll& ragdoll, const Character& character, const ModelPose& pose,
    std::uint32_t maximum_points = 64);

/// Where a pose puts the bodies: to place them as the animation goes on, to find the velocities
/// with which they start (from two poses), or as targets of motors.
/// @param model_from_body  one per body; written. @return size_mismatch for the pose or the places;
/// non_finite_value with the bone; nothing is written then. O(bodies), no allocation.
[[nodiscard]] SUNDER_API Status place_bodies(const Ragdoll& ragdoll, const ModelPose& pose,
                                             std::span<Affine3d> model_from_body);

/// How bodies in these places turn their joints: the rotation from the joint's frame fixed to the
/// parent to the one fixed to the body. Of the places of a pose: targets of motors.
/// @param turns  one per body, unit quaternions; written; identity without a joint.
/// @return size_mismatch. O(bodies), no allocation.
[[nodiscard]] SUNDER_API Status joint_turns(const Ragdoll& ragdoll,
                                            std::span<const Affine3d> model_from_body,
                                            std::span<Quatd> turns);

/// The pose in which bodies in these places hold the bones. Bones without a body of their own keep
/// their places relative to the body that moves them; morph weights stay.
/// @param pose  with one matrix per bone; written. @return size_mismatch; non_finite_value with the
/// body; nothing is written then. O(bones), no allocation.
[[nodiscard]] SUNDER_API Status pose_of_bodies(const Ragdoll& ragdoll,
                                               std::span<const Affine3d> model_from_body,
                                               ModelPose& pose);

}  // namespace sunder
