#pragma once

#include "core/internal/number_range.h"

namespace sunder::robot {

// The ranges of the numbers of sweeps, which the command checks by too.

inline constexpr NumberRange kSpacing = {
    .field = "spacing", .least = 1e-9, .most = 1e9, .unit = " m"};
/// Seconds of a clip per second of the motion.
inline constexpr NumberRange kClipSpeed = {.field = "clip speed", .least = 0, .most = 1e6};

}  // namespace sunder::robot
