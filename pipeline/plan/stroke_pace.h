#pragma once

#include <sunder/plan/plan.h>

#include <span>
#include <vector>

namespace sunder::plan {

/// A blade in the surface, when and how far along the curve, and where it should enter.
struct PacedBlade {
  double time = 0;   ///< Seconds, ascending.
  double share = 0;  ///< Of the curve's length, not descending.
  Vec3d ideal = Vec3d::Zero();
};

/// Speed and smoothness of a stroke.
/// @param blades        at least one.
/// @param places, times  a place of the blade over the whole stroke.
/// @param length        of the curve, metres.
/// @param wanted_speed  metres per second.
[[nodiscard]] StrokePace pace_of(std::span<const PacedBlade> blades, std::span<const Vec3d> places,
                                 std::span<const double> times, double length, double wanted_speed);

}  // namespace sunder::plan
