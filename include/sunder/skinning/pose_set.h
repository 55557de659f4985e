#pragma once

#include <sunder/core/character.h>
#include <sunder/core/pose_set_spec.h>

#include <cstddef>
#include <cstdint>
#include <memory>

namespace sunder {

/// Poses of a character, each computed when it is asked for: a range of motion of 300 bones is thousands of them. Copies share
/// what they know.
class SUNDER_API PoseSet {
 public:
  enum class Role : std::uint8_t {
    fit,       ///< Weights are fitted over these.
    held_out,  ///< Their error is measured over these; there may be none.
  };

  /// Clips first, then joints that turn, then the given poses; docs/skinning.md says which each of them are.
  ///
  /// @param character  satisfies validate_character(); kept.
  /// @return the first fault of the character; index_out_of_range, non_finite_value or invalid_argument with the joint limit; what
  ///         make_pose() says, with the given pose; limit_exceeded for too many samples a clip, or without enough memory;
  ///         empty_input for no character, or a set without a pose to fit over.
  [[nodiscard]] static Result<PoseSet> make(std::shared_ptr<const Character> character, const PoseSetSpec& spec);

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
