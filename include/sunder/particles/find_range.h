#pragma once

#include <sunder/particles/material.h>
#include <sunder/particles/particle_set.h>

namespace sunder {

/// A range that fits what was wanted.
struct FoundRange {
  double range = 0.0;           ///< A fraction of the diagonal, for DecompositionOptions.
  std::uint32_t particles = 0;  ///< That it makes.
  double step_seconds = 0.0;    ///< Of SoftBody::step() with all of them awake, in a still pose, as measured; 0: it was not.
};

/// Searches the range that makes about as many particles as wanted: within 2 %, or as near as ranges come. Deterministic.
/// @param wanted  >= 1; at most as many as the model has points.
/// @return invalid_argument, and what ParticleSet::decompose() finds. A dozen decompositions at most.
SUNDER_API Result<FoundRange> find_range_for_particles(const TornModel& model, const ModelPose& pose, std::uint32_t wanted,
                                                       std::uint64_t seed = 0);

/// Searches the smallest range, and so the finest motion, whose steps take no longer than wanted, on this machine as it is now:
/// each trial is timed.
/// @param seconds  of one step with all particles awake; > 0.
/// @return not_found where none does; else as find_range_for_particles(). A few decompositions, some milliseconds of steps each.
SUNDER_API Result<FoundRange> find_range_for_step(const TornModel& model, const ModelPose& pose, double seconds,
                                                  const Material& material, std::uint64_t seed = 0);

}  // namespace sunder
