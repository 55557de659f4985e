#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "pipeline/plan/blade_chain.h"
#include "pipeline/plan/blade_errors.h"
#include "pipeline/plan/clearance.h"
#include "pipeline/plan/inverse_kinematics.h"
#include "pipeline/plan/target_path.h"

namespace sunder::plan {

/// The inputs of a search for tracks.
struct TrackSearch {
  std::span<const TargetSample> samples;  ///< At least one.
  const ErrorScales& scales;
  const SplineLimits& limits;
  const Clearance& clearance;  ///< Of these samples.
  double margin = 0;           ///< Wanted between links and character, metres.
  double tolerance = 0;        ///< Of places, metres.
  std::uint32_t seeds = 0;     ///< Random starts.
};

/// Values for each sample, where the fit of a spline begins.
struct Track {
  std::vector<Values> values;
  /// From tip to base, one per sample: what the blade keeps to.
  std::vector<Vec3d> handles;
  std::size_t missed = 0;  ///< Samples of the cut that are not reached.
  double inside = 0;       ///< How deep links are, summed over the instants of the clearance.

  [[nodiscard]] bool is_clean() const { return missed == 0 && inside <= 0; }
};

/// Tracks that keep the wanted angle and are found without regard to links: each sample's values
/// from those before, by inverse kinematics, from each of several different solutions in the middle
/// of the curve: elbow up, elbow down, and others.
/// @return at most three, at least one: those that reach the curve first, of these those with links
///         outside of the character, of these those with the least errors and speeds.
[[nodiscard]] std::vector<Track> follow_tracks(BladeChain& chain, const TrackSearch& search);

/// The constraints of a walk.
struct WalkRules {
  bool keeps_links_outside = true;
  double speed = 1;        ///< Factor of all limits of speed.
  std::uint64_t seed = 0;  ///< Of random starts and steps.
};

/// Tracks on which links stay outside of the character, and values within limits and speeds: a
/// random walk from one instant of the clearance to the next, of which at each instant some places
/// are kept (a beam). The blade leans to any side where it must.
/// @return at most three; none if no walk gets through.
[[nodiscard]] std::vector<Track> walk_freely(BladeChain& chain, const TrackSearch& search,
                                             const WalkRules& rules = {});

/// Whether one of some random starts leads to values that reach an instant of the clearance within
/// limits, with links outside of the character.
[[nodiscard]] bool has_free_values(BladeChain& chain, const TrackSearch& search,
                                   std::size_t instant, std::uint32_t tries);

/// How deep links are on a track, summed over the instants of the clearance.
[[nodiscard]] double depth_of_links(BladeChain& chain, const Clearance& clearance,
                                    const Track& track);

}  // namespace sunder::plan
