#pragma once

#include <span>
#include <vector>

namespace sunder::plan {

constexpr int kGapeSteps = 12;  ///< Even steps of the curve, between which a profile is linear.

/// Which share of an even tension, at each node of these steps, gapes a straight wound of a flat
/// sheet by each share of what the even tension does in the middle. Not below 0: tension pulls.
/// @param wanted  shares, one per node.
[[nodiscard]] std::vector<double> flat_tension(std::span<const double> wanted);

/// A profile at a share of the curve.
[[nodiscard]] double profile_at_share(std::span<const double> nodes, double share);

/// The mean of some samples near each node, by their distance from it. A node without samples has
/// the mean of its neighbours.
struct ProfileSample {
  double share = 0, value = 0;
};
[[nodiscard]] std::vector<double> profile_of(std::span<const ProfileSample> samples);

}  // namespace sunder::plan
