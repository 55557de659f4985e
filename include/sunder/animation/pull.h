#pragma once

#include <sunder/core/api.h>
#include <sunder/core/character.h>
#include <sunder/operation/pose_spec.h>

#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <vector>

namespace sunder {

// Poses changed by pulling at points: inverse kinematics by damped least squares (Wampler 1986;
// Nakamura and Hanafusa 1986; Buss 2004). docs/animation.md

/// A point of a character that can be pulled: the weighted mean of points that are fixed to bones,
/// as linear blend skinning places a vertex.
struct PullHandle {
  struct Part {
    std::uint32_t bone = 0;
    double weight = 1.0;          ///< >= 0; those of a handle sum to one.
    Vec3d point = Vec3d::Zero();  ///< In the bone's frame.
  };
  std::vector<Part> parts;

  /// The bone of the largest weight, the deeper one of equals; kNone without parts.
  [[nodiscard]] SUNDER_API std::uint32_t main_bone() const;
};

/// A point that is fixed to a bone, in the bone's frame. Allocates.
[[nodiscard]] SUNDER_API PullHandle handle_on_bone(std::uint32_t bone,
                                                   const Vec3d& point = Vec3d::Zero());

/// A place on a face of a character, as a contact, a blade or a mouse finds it.
/// @param barycentrics   of the triangle's corners, >= 0, sum 1. A vertex is a corner.
/// @param morph_weights  of the pose; empty: without morph targets.
/// @return index_out_of_range, size_mismatch, invalid_argument; limit_exceeded: out of memory.
/// Allocates. The handle follows linear blend skinning, without displacements of soft tissue.
[[nodiscard]] SUNDER_API Result<PullHandle> handle_on_surface(
    const Character& character, std::uint32_t mesh, std::uint32_t triangle,
    const Vec3d& barycentrics, std::span<const float> morph_weights = {});

/// The bones from `root` down to `bone`, both included: a chain for PosePuller.
/// @return index_out_of_range; not_found if `root` is not above `bone`. Allocates.
[[nodiscard]] SUNDER_API Result<std::vector<std::uint32_t>> chain_between(const Skeleton& skeleton,
                                                                          std::uint32_t root,
                                                                          std::uint32_t bone);

/// How far a bone may turn from its rest rotation.
struct BoneLimit {
  enum class Kind : std::uint8_t {
    hinge,  ///< About one axis only.
    cone,   ///< The axis stays within a cone, and the bone twists about it within a range.
  };
  Kind kind = Kind::hinge;
  std::uint32_t bone = 0;
  Vec3d axis = Vec3d(1.0, 0.0, 0.0);  ///< In the bone's own frame; any length except zero.
  double lower = 0.0;                 ///< Radians about the axis: of the hinge, or of the twist.
  double upper = 0.0;                 ///< >= lower. A range of 2 pi or more does not limit.
  double cone = 0.0;                  ///< Of a cone: largest angle of the axis, radians, >= 0.
};

/// A limit of a pose set, or of a robot's joint (pose_limits_of()), as a hinge.
[[nodiscard]] inline BoneLimit hinge_of(const JointLimit& limit) {
  return {BoneLimit::Kind::hinge, limit.bone, limit.axis, limit.lower, limit.upper, 0.0};
}

struct PullTarget {
  const PullHandle* handle = nullptr;
  Vec3d place = Vec3d::Zero();  ///< To where the handle is pulled; model space, metres.
  double weight = 1.0;          ///< > 0. Of several targets: how much each one's error counts.
};

struct PullOptions {
  double tolerance = 1e-4;        ///< Metres: a smaller error ends the search. > 0.
  std::uint32_t iterations = 32;  ///< Most steps of an attempt. At least 1.
  /// Most attempts. The second one bends the chain first, the others begin at random poses around
  /// it, the same ones in each call: only for poses that need not follow from one another.
  std::uint32_t attempts = 2;
};

struct PullReport {
  /// Root of the weighted mean of the squared distances between handles and targets, metres: of the
  /// pose that was given, within its limits, and of the result, which is never larger.
  double error_before = 0.0, error = 0.0;
  std::uint32_t iterations = 0;  ///< Of all attempts.
  bool is_reached = false;       ///< The error is within the tolerance.
};

/// Turns the bones of a chain such that points come to where they are pulled, each bone as little
/// as possible. Bones do not move or stretch otherwise. Immutable apart from its scratch memory;
/// one thread at a time.
class SUNDER_API PosePuller {
 public:
  /// @param bones      that may turn, in any order: a chain, or a tree for several targets.
  /// @param limits     at most one per bone; those of other bones are ignored. Bones without one
  ///                   turn freely. The bones of a robot's chain are those of its limits.
  /// @param stiffness  one per entry of `bones`, finite, >= 0, or empty: all 0. A bone of stiffness
  ///                   s turns 1 / (1 + s) as readily, so that a hand moves before the spine.
  /// @return empty_input, index_out_of_range, size_mismatch, non_finite_value, invalid_argument
  /// with the bone or limit; limit_exceeded: out of memory. Allocates.
  [[nodiscard]] static Result<PosePuller> create(const Skeleton& skeleton,
                                                 std::span<const std::uint32_t> bones,
                                                 std::span<const BoneLimit> limits = {},
                                                 std::span<const float> stiffness = {});
  ~PosePuller();
  PosePuller(PosePuller&&) noexcept;
  PosePuller& operator=(PosePuller&&) noexcept;

  /// Pulls. Bones that leave their limits are first put to the nearest rotation within. The result
  /// is within the limits, but for the rounding to float (1e-6 radians); its error is the smallest
  /// found. A target out of reach stretches the chain towards it. Poses of other bones, and all
  /// translations, scales and morph weights keep their bits.
  /// @param pose  changed. @param targets  at least one, at most 8.
  /// @return empty_input, size_mismatch, index_out_of_range, non_finite_value, invalid_argument,
  /// limit_exceeded: `pose` is unchanged then. About 0.1 µs per bone and step, 0.3 with limits; no
  /// allocation once warm.
  Result<PullReport> pull(std::span<const PullTarget> targets, Pose& pose,
                          const PullOptions& options = {});

 private:
  struct State;
  explicit PosePuller(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

/// As PosePuller with one target, without limits. Allocates.
[[nodiscard]] SUNDER_API Result<PullReport> pull_point(const Skeleton& skeleton,
                                                       std::span<const std::uint32_t> bones,
                                                       const PullHandle& handle, const Vec3d& place,
                                                       Pose& pose, const PullOptions& options = {});

}  // namespace sunder
