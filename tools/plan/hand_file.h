#pragma once

#include <sunder/core/math.h>

#include <string>

namespace sunder::tools {

/// The robot of free_hand() as URDF: the same joints, behind a fixed joint that places it, and a
/// thin box as its blade.
/// @param root_from_hand  place of the hand in the space of the file's root link, z up.
/// @param length          of the blade, metres.
[[nodiscard]] std::string hand_urdf(const Affine3d& root_from_hand, double length);

}  // namespace sunder::tools
