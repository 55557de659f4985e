#pragma once

#include "particles/clusters/structure.h"
#include "particles/front/marks.h"

namespace sunder::particles {

/// Updates the sums of neighbours by added and removed pairs of influences. The changes are first
/// summed in a small matrix, because the points around a tear have few pairs of particles, each
/// many times.
class PairChanges {
  static constexpr std::size_t kMost = 96;

 public:
  /// Memory of the matrix.
  static constexpr std::size_t kBytes = kMost * kMost * (sizeof(std::int32_t) + sizeof(double));

  ///
  /// @param sign    1 for added influences, -1 for removed ones.
  /// @param change  called with the index of a particle before it changes; returns the particle.
  template <class ChangeParticle>
  void add(const ParticleInfluences& influences, int sign, ChangeParticle change) {
    std::array<std::size_t, 4> rows;
    std::size_t count = 0;
    for (; count < 4 && influences.weights[count] > 0; ++count) {
      if (count_ + 4 > kMost) apply(change);
      rows[count] = row_of(influences.particles[count]);
    }
    // apply() may have reassigned the rows.
    for (std::size_t i = 0; i < count; ++i) rows[i] = row_of(influences.particles[i]);
    for (std::size_t i = 0; i < count; ++i) {
      weights_[rows[i]] += sign * double{influences.weights[i]};
      for (std::size_t j = 0; j < i; ++j) {
        const std::size_t at =
            rows[i] < rows[j] ? rows[i] * kMost + rows[j] : rows[j] * kMost + rows[i];
        points_[at] += sign;
        shared_[at] += sign * double{influences.weights[i]} * double{influences.weights[j]};
      }
    }
  }

  /// Adds the summed changes to the particles.
  template <class ChangeParticle>
  void apply(ChangeParticle change) {
    for (std::size_t i = 0; i < count_; ++i) {
      change(particles_[i]).weight += std::exchange(weights_[i], 0.0);
      for (std::size_t j = i + 1; j < count_; ++j) {
        const std::size_t at = i * kMost + j;
        const std::int32_t points = std::exchange(points_[at], 0);
        const double shared = std::exchange(shared_[at], 0.0);
        if (points == 0 && shared == 0) continue;
        add_to(change(particles_[i]).neighbours, particles_[j], points, shared);
        add_to(change(particles_[j]).neighbours, particles_[i], points, shared);
      }
    }
    rows_.begin(0);
    count_ = 0;
  }

 private:
  std::size_t row_of(Index particle) {
    if (row_of_.size() <= particle) row_of_.resize(particle + 64);
    rows_.grow(particle + 1);
    if (rows_.mark(particle)) {
      row_of_[particle] = static_cast<Index>(count_);
      particles_[count_++] = particle;
    }
    return row_of_[particle];
  }

  static void add_to(std::vector<ParticleNeighbour>& neighbours, Index other, std::int32_t points,
                     double shared) {
    auto at = std::lower_bound(neighbours.begin(), neighbours.end(), other,
                               [](const ParticleNeighbour& neighbour, Index particle) {
                                 return neighbour.particle < particle;
                               });
    if (at == neighbours.end() || at->particle != other)
      at = neighbours.insert(at, {other, 0, 0.0});
    at->points = static_cast<Index>(static_cast<std::int32_t>(at->points) + points);
    at->shared += shared;
    if (at->points == 0) neighbours.erase(at);
  }

  Marks rows_;
  std::vector<Index> row_of_;
  std::array<Index, kMost> particles_ = {};
  std::array<double, kMost> weights_ = {};
  std::vector<std::int32_t> points_ = std::vector<std::int32_t>(kMost * kMost, 0);
  std::vector<double> shared_ = std::vector<double>(kMost * kMost, 0.0);
  std::size_t count_ = 0;
};

}  // namespace sunder::particles
