#pragma once

#include "core/internal/number_range.h"

namespace sunder::validation {

// The ranges of the numbers of ValidationOptions and TransferOptions, by which the command checks
// too. Shares are of a diagonal.

inline constexpr NumberRange kMaximumDeviation = {
    .field = "maximum_deviation", .least = 0, .most = 1e9};
inline constexpr NumberRange kErrorDeviation = {
    .field = "error_deviation", .least = 0, .most = 1e9};
inline constexpr NumberRange kRandomAngle = {
    .field = "random_angle", .least = 0, .most = 1e9, .unit = " radians"};
inline constexpr NumberRange kClipMargin = {.field = "clip_margin", .least = 0, .most = 1e9};

inline constexpr NumberRange kDistance = {.field = "distance", .least = 0, .most = 1e9};
inline constexpr NumberRange kAngleDegrees = {
    .field = "angle", .least = 0, .most = 180, .unit = " degrees"};
inline constexpr NumberRange kSmoothness = {.field = "smoothness", .least = 0, .most = 1e6};
inline constexpr NumberRange kSmoothingStrength = {
    .field = "smoothing_strength", .least = 0, .most = 1};
inline constexpr NumberRange kMix = {.field = "mix", .least = 0, .most = 1};

}  // namespace sunder::validation
