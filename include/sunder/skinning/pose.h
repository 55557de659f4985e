#pragma once

#include <sunder/core/character.h>
#include <sunder/operation/pose_spec.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>

namespace sunder {

/// The rest transforms of all bones, each relative to its parent, and the rest morph weights: the
/// start for sample_clip().
/// @return limit_exceeded: out of memory. O(bones), allocates.
[[nodiscard]] SUNDER_API Result<Pose> local_rest_pose(const Character& character);

/// Overwrites the parts of `pose` that `clip` animates with their values at `time`. Start from
/// local_rest_pose().
///
/// @param clip  of a character that passed validate_character().
/// @param time  seconds, finite; values are held before the first and after the last key.
/// @param pose  one transform per bone and one weight per morph weight of that character.
/// @return ok; size_mismatch or non_finite_value (nothing is written).
/// Interpolation follows glTF 2.0, appendix C. O(channels log keys), no allocation, reentrant.
[[nodiscard]] SUNDER_API Status sample_clip(const Clip& clip, double time, Pose& pose);

/// Computes model_from_bone of every bone: local transforms multiplied down the tree, in double.
/// @param model_pose  resized to fit; does not allocate if it already fits.
/// @return ok, or size_mismatch or limit_exceeded, out of memory (nothing is written). O(bones),
/// reentrant.
[[nodiscard]] SUNDER_API Status compute_model_pose(const Skeleton& skeleton, const Pose& pose,
                                                   ModelPose& model_pose);

/// The pose in the file: rest transforms multiplied down the tree, and rest morph weights.
/// @return limit_exceeded: out of memory. O(bones), allocates.
[[nodiscard]] SUNDER_API Result<ModelPose> rest_pose(const Character& character);

/// The pose in which the skins were attached: model_from_bone = inverse(bone_from_bind), so that
/// each skin reproduces its mesh. If several skins bind a bone differently, the first one counts. A
/// bone that no skin binds, or that is bound by a singular matrix, keeps its rest transform
/// relative to its parent. Morph weights are those of rest.
/// @return limit_exceeded: out of memory. O(slots), allocates.
[[nodiscard]] SUNDER_API Result<ModelPose> bind_pose(const Character& character);

/// The pose that a spec names.
/// @return not_found for a clip or bone that the character does not have; size_mismatch if the
/// number of given matrices is wrong; limit_exceeded: out of memory.
[[nodiscard]] SUNDER_API Result<ModelPose> make_pose(const Character& character,
                                                     const PoseSpec& spec);

/// The poses of a character over which weights are fitted and errors are measured. Each is computed
/// on demand, because a range of motion of 300 bones has thousands of them.
///
/// Thread-safe: immutable after create(). Copies are cheap and share their state.
class SUNDER_API PoseSet {
 public:
  /// The use of a pose.
  enum class Role : std::uint8_t {
    fit,       ///< Weights are fitted over these poses.
    held_out,  ///< Errors are measured over these poses. There may be none.
  };
  /// The origin of a pose.
  enum class Source : std::uint8_t {
    clip,
    joints,  ///< A range of motion or limited joints.
    given,
  };
  struct Group {
    Source source = Source::given;
    std::uint32_t clip = kNone;  ///< If it is from a clip: which one.

    bool operator==(const Group&) const = default;
  };

  /// Lists clip samples first, then joint rotations, then the given poses; see docs/skinning.md.
  ///
  /// @param character  satisfies validate_character(); kept.
  /// @return the first fault of the character; index_out_of_range, non_finite_value or
  /// invalid_argument with the joint limit; the failures of make_pose() with the given pose;
  /// limit_exceeded for too many samples per clip or without enough memory; empty_input without a
  /// character or without a pose to fit over.
  [[nodiscard]] static Result<PoseSet> create(std::shared_ptr<const Character> character,
                                              const PoseSetSpec& spec);
  /// Whether create() would succeed with a character that satisfies validate_character(): its other
  /// failures. Does not sample the clips, so it is much cheaper. Allocates.
  [[nodiscard]] static Status check(const Character& character, const PoseSetSpec& spec);

  [[nodiscard]] std::size_t size(Role role) const;

  /// Returns the origin of a pose. @param index  below size(role), unchecked.
  [[nodiscard]] Group group_of(Role role, std::size_t index) const;
  /// How much a pose to fit over counts: one of a clip by how long the clip stays near it, with a
  /// mean of 1 over the clip; others 1. @param index  below size(Role::fit), unchecked.
  [[nodiscard]] double weight_of(std::size_t index) const;
  /// The one or two bones that a pose of Source::joints turns; kNone for no bone.
  /// @param index  that of such a pose, unchecked.
  [[nodiscard]] std::array<std::uint32_t, 2> turned_bones(Role role, std::size_t index) const;

  /// Computes a pose. Returns the same bits each time.
  /// @param index  below size(role), unchecked.
  /// @param pose   resized to fit; does not allocate if it already fits.
  /// @return limit_exceeded: out of memory (nothing is written). O(bones + channels log keys),
  /// reentrant.
  Status compute(Role role, std::size_t index, ModelPose& pose) const;

 private:
  struct State;
  explicit PoseSet(std::shared_ptr<const State> state);
  std::shared_ptr<const State> state_;
};

}  // namespace sunder
