#pragma once

#include "core/internal/number_range.h"

namespace sunder {

// The ranges of the numbers of operations. The reader of logs, the command, the tears and the aimed
// operations all check by them; docs/operation_log.md has the table.

/// Blades, planes and bores lie within it: products of four coordinates stay finite.
inline constexpr double kFarthestMetres = 1e60;
/// Widths, depths, radii and distances of samples: their products with coordinates stay finite.
inline constexpr double kLongestMetres = 1e30;
inline constexpr double kLongestSeconds = 1e30;
/// A shorter blade, radius or depth is none: products of lengths do not underflow.
inline constexpr double kShortestMetres = 1e-30;
static_assert(kShortestMetres < kLongestMetres && kLongestMetres < kFarthestMetres);

namespace field {

/// A length that may be zero.
constexpr NumberRange length_from_zero(const char* field = "") {
  return {.field = field, .least = 0, .most = kLongestMetres, .unit = " m"};
}
constexpr NumberRange length_above_zero(const char* field = "") {
  return {.field = field,
          .least = kShortestMetres,
          .most = kLongestMetres,
          .unit = " m",
          .is_above_least = true};
}
/// The range of a field of a description, whose name it gets.
constexpr NumberRange named(NumberRange range, const char* field) {
  range.field = field;
  return range;
}

// Of threads.
inline constexpr NumberRange kStiffness = {
    .field = "stiffness", .least = 0, .most = 1e12, .unit = " N/m", .is_above_least = true};
inline constexpr NumberRange kNewtons = {
    .field = "newtons", .least = 0, .most = 1e12, .unit = " N"};
inline constexpr NumberRange kCoordinate = {
    .field = "coordinate", .least = -kFarthestMetres, .most = kFarthestMetres};
// Of strokes that are sampled from a hand.
inline constexpr NumberRange kMinimumDistance = length_from_zero("minimum_distance");
inline constexpr NumberRange kMinimumSeconds = {
    .field = "minimum_seconds", .least = 0, .most = kLongestSeconds, .unit = " s"};
/// Lengths in widths of the limb.
inline constexpr NumberRange kWidths = {
    .field = "widths", .least = 0, .most = kLongestMetres, .is_above_least = true};
inline constexpr NumberRange kWidthsFromZero = {
    .field = "widths", .least = 0, .most = kLongestMetres};

/// Relative to the radius, as the 1,536 sides of a rim reach: 1 - cos(pi / 1536) = 2.1e-6.
inline constexpr double kLeastChordTolerance = 2.5e-6;
/// The range of the chord tolerance of a bore with a radius. 0 is allowed too: 1 % of the radius.
constexpr NumberRange chord_tolerance(double radius) {
  return {.field = "chord_tolerance",
          .least = kLeastChordTolerance * radius,
          .most = radius,
          .unit = " m",
          .or_else = "0"};
}
inline Status check_chord_tolerance(double tolerance, double radius) {
  return tolerance == 0 ? Status() : chord_tolerance(radius).check(tolerance);
}

// Of aimed operations. Angles of logs and of the command are in degrees.
inline constexpr NumberRange kShare = {.field = "at", .least = 0, .most = 1};
inline constexpr NumberRange kTurnDegrees = {
    .field = "turn", .least = -1e9, .most = 1e9, .unit = " degrees"};
inline constexpr NumberRange kTiltDegrees = {
    .field = "tilt", .least = -80, .most = 80, .unit = " degrees"};

// Of poses and refits.
inline constexpr NumberRange kTime = {.field = "time", .least = 0, .most = 1e9, .unit = " s"};
inline constexpr NumberRange kLimitRadians = {.field = "limit", .least = -1e9, .most = 1e9};
constexpr NumberRange importance(const char* field = "") {
  return {.field = field, .least = 0, .most = 1e9};
}
inline constexpr NumberRange kBound = {.field = "bound", .least = 1, .most = 1e9, .or_else = "0"};
inline constexpr NumberRange kSmoothness = {.field = "smoothness", .least = 0, .most = 1e9};

}  // namespace field
}  // namespace sunder
