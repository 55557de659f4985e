#pragma once

#include <sunder/core/character.h>
#include <sunder/skinning/pose.h>

#include <vector>

namespace sunder::aim {

/// Two bones that mirror each other.
struct BonePair {
  Index left = 0, right = 0;
};

/// The pairs of a character, and the level unit vector to the side of their left bones.
struct BonePairs {
  std::vector<BonePair> pairs;
  Vec3d left = Vec3d::Zero();
  /// In [0, 1]: how well the pairs, or their places, agree about that side.
  double agreement = 0.0;
  /// Whether names tell which side is the left one. If not, it is a guess.
  bool is_side_known = false;
};

/// Bones whose names differ in left and right alone, "Arm.L" and "Arm.R".
[[nodiscard]] BonePairs pairs_by_name(const Character& character, const ModelPose& pose);

/// Bones that move something and whose places mirror each other in a plane across the x or the z
/// axis, whatever their names. No pairs if most bones beside the plane have no partner, or if both
/// planes would do.
[[nodiscard]] BonePairs pairs_by_place(const Character& character, const ModelPose& pose);

}  // namespace sunder::aim
