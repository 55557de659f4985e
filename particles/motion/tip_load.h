#pragma once

#include <sunder/particles/soft_body.h>

#include <span>
#include <vector>

namespace sunder::particles {

/// A tip of a tear, and the energy that the tissue would release per length if the tear ran on.
struct TipLoad {
  Index tip = 0;
  Index left = 0, right = 0;  ///< The particles of the first lip points next to it.
  double release = 0;         ///< Newtons, that is joules per metre.
};

/// The loads of those tips at which one of the two particles is awake.
///
/// Next to a tip the gap of a membrane of stiffness S opens like the root of the distance r: with
/// the width A sqrt(r), running on releases pi S A^2 / 16 per length (Griffith 1921, Irwin 1957).
/// A^2 is the mean of width^2 / r along the first lip particles, corrected for the length of the
/// gap, and by kReleaseOfMean for the blending of the particles there.
///
/// @param tips  ParticleSet::tips(). O(points of lips near tips), allocates.
[[nodiscard]] std::vector<TipLoad> tip_loads(const SoftBody& body, const ParticleSet& particles,
                                             const TornModel& model, std::span<const Index> tips);

}  // namespace sunder::particles
