#pragma once

#include <sunder/core/character.h>
#include <sunder/operation/pose_spec.h>

#include <cstddef>
#include <cstdint>
#include <memory>

namespace sunder {

/// The rest transforms of all bones, each relative to its parent, and the rest morph weights: what
/// sample_clip() starts from.
[[nodiscard]] SUNDER_API Pose local_rest_pose(const Character& character);

/// Writes what `clip` animates into `pose` at `time`; the rest of `pose` stays, so start from
/// local_rest_pose().
///
/// @param clip  one of a character that passed validate_character().
/// @param time  seconds, any finite value; before the first and after the last key the value is
/// held.
/// @param pose  one transform a bone and one weight a morph weight of that character.
/// @return ok; size_mismatch or non_finite_value (nothing written).
///
/// Linear rotations are interpolated along the shorter great arc, cubic splines are Hermite with
/// tangents scaled by the key distance and normalised (glTF 2.0, appendix C). O(channels log keys),
/// no allocation, reentrant.
[[nodiscard]] SUNDER_API Status sample_clip(const Clip& clip, double time, Pose& pose);

/// model_from_bone of every bone: local transforms multiplied down the tree, in double.
/// @param model_pose  resized to fit; does not allocate when it already fits.
/// @return ok, or size_mismatch (nothing written).
[[nodiscard]] SUNDER_API Status compute_model_pose(const Skeleton& skeleton, const Pose& pose,
                                                   ModelPose& model_pose);

/// The character as the file stands it: rest transforms multiplied down the tree, rest morph
/// weights.
[[nodiscard]] SUNDER_API ModelPose rest_pose(const Character& character);

/// The pose in which the skins were attached: model_from_bone = inverse(bone_from_bind), so that
/// each skin reproduces its mesh. Where several skins bind one bone differently the first one
/// counts; a bone that no skin binds, or binds by a singular matrix, keeps its rest transform
/// relative to its parent. Morph weights are those of rest.
[[nodiscard]] SUNDER_API ModelPose bind_pose(const Character& character);

/// The pose that a spec names.
/// @return not_found for a clip or bone that the character does not have; size_mismatch for
/// matrices that are not its bones'.
[[nodiscard]] SUNDER_API Result<ModelPose> make_pose(const Character& character,
                                                     const PoseSpec& spec);

/// Poses of a character, each computed when it is asked for: a range of motion of 300 bones is
/// thousands of them. Copies share what they know.
class SUNDER_API PoseSet {
 public:
  enum class Role : std::uint8_t {
    fit,       ///< Weights are fitted over these.
    held_out,  ///< Their error is measured over these; there may be none.
  };

  /// Clips first, then joints that turn, then the given poses; docs/skinning.md says which each of
  /// them are.
  ///
  /// @param character  satisfies validate_character(); kept.
  /// @return the first fault of the character; index_out_of_range, non_finite_value or
  /// invalid_argument with the joint limit; what
  ///         make_pose() says, with the given pose; limit_exceeded for too many samples a clip, or
  ///         without enough memory; empty_input for no character, or a set without a pose to fit
  ///         over.
  [[nodiscard]] static Result<PoseSet> create(std::shared_ptr<const Character> character,
                                              const PoseSetSpec& spec);

  [[nodiscard]] std::size_t size(Role role) const;

  /// @param index  below size(role).
  /// @param pose   resized to fit; does not allocate when it already fits.
  ///
  /// O(bones + channels log keys), reentrant. The same bits each time.
  void compute(Role role, std::size_t index, ModelPose& pose) const;

 private:
  struct State;
  explicit PoseSet(std::shared_ptr<const State> state);
  std::shared_ptr<const State> state_;
};

}  // namespace sunder
