#pragma once

#include <sunder/core/character.h>

namespace sunder {

/// The character's rest pose: its bones' rest transforms and its rest morph weights.
[[nodiscard]] SUNDER_API Pose rest_pose(const Character& character);

/// Writes what `clip` animates into `pose` at `time`; the rest of `pose` stays, so start from rest_pose().
///
/// @param clip  one of a character that passed validate_character().
/// @param time  seconds, any finite value; before the first and after the last key the value is held.
/// @param pose  one transform a bone and one weight a morph weight of that character.
/// @return ok; size_mismatch or non_finite_value (nothing written).
///
/// Linear rotations are interpolated along the shorter great arc, cubic splines are Hermite with tangents scaled by the key
/// distance and normalised (glTF 2.0, appendix C). O(channels log keys), no allocation, reentrant.
[[nodiscard]] SUNDER_API Status sample_clip(const Clip& clip, double time, Pose& pose);

}  // namespace sunder
