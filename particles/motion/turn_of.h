#pragma once

#include <sunder/core/math.h>

namespace sunder::particles {

/// The rotation in a linear map: its polar factor, by Newton's iteration, scaled (Higham 1986
/// [higham1986polar]). What mirrors or flattens has none.
/// @param turn  written where there is one. @return whether there is one.
bool turn_of(const Mat3d& linear, Mat3d& turn);

}  // namespace sunder::particles
