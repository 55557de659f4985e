#pragma once

#include <bit>

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
    others_.resize(3 * members.size() + 4);
    std::size_t count = 0;
    for (const Index point : members) {
      const ParticleInfluences& influences = structure_.influences[point];
      float weight = 0;
      for (std::size_t i = 0; i < 4; ++i) weight += kept_if(influences.particles[i] == particle, influences.weights[i]);
      of.weight += double{weight};
      for (std::size_t i = 0; i < 4; ++i) {
        const double product = double{weight} * double{influences.weights[i]};
        const bool is_common = (influences.weights[i] > 0) & (weight > 0);
        OfOther& other = of_other_[influences.particles[i]];
        others_[count] = influences.particles[i];
        count += static_cast<std::size_t>(is_common & (other.points == 0));
        other.points += static_cast<Index>(is_common);
        other.shared += product;
      }
    }
    others_.resize(count);
    std::sort(others_.begin(), others_.end());
    of.neighbours.reserve(others_.size());
    for (const Index other : others_) {
      if (other != particle) of.neighbours.push_back({other, of_other_[other].points, of_other_[other].shared});
      of_other_[other] = {};
    }
    others_.clear();
  }

 private:
  /// Else 0; without a branch: it could not be guessed.
  static float kept_if(bool is_kept, float value) {
    return std::bit_cast<float>(std::bit_cast<std::uint32_t>(value) & (0u - static_cast<std::uint32_t>(is_kept)));
  }

  struct OfOther {
    double shared = 0;
    Index points = 0;
  };

  Structure& structure_;
  std::vector<OfOther> of_other_;  ///< One a particle: empty between calls.
  std::vector<Index> others_;
};

}  // namespace sunder::particles
