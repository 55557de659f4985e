#pragma once

#include "particles/structure.h"

namespace sunder::particles {

/// What a particle has in common with others.
class PairSums {
 public:
  explicit PairSums(Structure& structure) : structure_(structure), of_other_(structure.particles.size()) {}

  /// Makes a particle's list of neighbours, and its weight, from the influences of its members. O(members).
  void sum(std::span<const Index> members, Index particle) {
    Particle& of = structure_.particles[particle];
    of.weight = 0;
    of.neighbours.clear();
    for (const Index point : members) {
      const ParticleInfluences& influences = structure_.influences[point];
      std::size_t own = 0;
      while (own < 4 && (influences.particles[own] != particle || !(influences.weights[own] > 0))) ++own;
      if (own == 4) continue;
      const double weight = influences.weights[own];
      of.weight += weight;
      for (std::size_t i = 0; i < 4 && influences.weights[i] > 0; ++i) {
        if (i == own) continue;
        Neighbour& neighbour = of_other_[influences.particles[i]];
        if (neighbour.points++ == 0) others_.push_back(influences.particles[i]);
        neighbour.shared += weight * double{influences.weights[i]};
      }
    }
    std::sort(others_.begin(), others_.end());
    for (const Index other : others_) {
      of.neighbours.push_back({other, of_other_[other].points, of_other_[other].shared});
      of_other_[other] = {};
    }
    others_.clear();
  }

 private:
  Structure& structure_;
  std::vector<Neighbour> of_other_;  ///< One a particle: empty between calls.
  std::vector<Index> others_;
};

}  // namespace sunder::particles
