#pragma once

#include <sunder/core/math.h>

namespace sunder::particles {

/// The rotation in a linear map: its polar factor, by Newton's scaled iteration (Higham 1986
/// [higham1986polar]). Maps that mirror or are singular have none.
/// @param turn  written if there is one.
/// @return whether there is one.
bool turn_of(const Mat3d& linear, Mat3d& turn);

}  // namespace sunder::particles
