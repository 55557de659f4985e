#pragma once

#include <sunder/particles/material.h>
#include <sunder/particles/particle_set.h>

#include <span>
#include <vector>

#include "particles/clusters/point_factors.h"

namespace sunder::particles {

/// A spring from a particle to a neighbour. Both ends store it, with the same numbers, so that
/// their forces are opposite.
struct Spring {
  Index other = 0;
  double stiffness = 0;  ///< Newtons per metre.
  double damping = 0;    ///< Newton seconds per metre.
  /// An upper bound of the frequencies of the springs around its two ends, radians per second.
  double frequency = 0;
  double stretch_limit = 0;
};

/// The springs of all particles, each from both ends.
struct SpringGraph {
  std::vector<Index> first = {0};  ///< Per particle its first spring; the total at the end.
  std::vector<Spring> springs;
  std::vector<double> masses;  ///< Per particle, kilograms.
  std::vector<double> rates;  ///< Per particle: sum of its springs' stiffnesses by its mass, 1/s^2.
  /// Per particle, its material with the authored factors at its seed; empty without factors.
  std::vector<SoftMaterial> local;
  bool is_stale = true;  ///< Whether particles or materials changed since connect().

  /// The material of a particle, with its factors.
  [[nodiscard]] const SoftMaterial& material(Index particle,
                                             std::span<const SoftMaterial> materials,
                                             std::span<const Index> material_of) const {
    return local.size() == material_of.size() ? local[particle] : materials[material_of[particle]];
  }
  [[nodiscard]] std::span<const Spring> of(Index particle) const {
    return {springs.data() + first[particle], first[particle + 1] - first[particle]};
  }
};

/// The authored factors at the seed of a particle; null without any.
[[nodiscard]] const PointFactors* factors_at(const ParticleSet& set, Index particle);

/// The mass of a particle of a material, kilograms.
[[nodiscard]] double mass_of(const ParticleSet& set, const SoftMaterial& material, Index particle);

/// Connects all neighbours. If their materials differ, the spring has the harmonic means of
/// stiffness and damping, as half of it is in each material, and the smaller stretch limit.
/// Authored factors are those at the seeds.
/// @param material_of  per particle. O(pairs of neighbours). @throws std::bad_alloc
void connect(const ParticleSet& set, std::span<const SoftMaterial> materials,
             std::span<const Index> material_of, SpringGraph& graph);

/// Sets the frequencies of all springs from their stiffnesses and the masses.
void set_frequencies(SpringGraph& graph);

/// The spring of two materials, before its other end and its frequency are known. The foundation
/// between two seeds acts at the seeds, which makes a coarse row of particles stiffer than the
/// tissue: with stiffness S and foundation K, a row with the spacing h resists a force at its end
/// by sqrt(S' K + (K h / 2)^2) instead of sqrt(S K). S' = S - K h^2 / 4 makes them equal.
[[nodiscard]] Spring spring_between(const SoftMaterial& a, const SoftMaterial& b, double coupling,
                                    double squared_distance);

}  // namespace sunder::particles
