#pragma once

#include "particles/clusters/structure.h"
#include "tear/internal/surface.h"

namespace sunder::particles {

/// Gradients of the weights of points along the surface. Those that changed since the last of() are
/// computed anew there.
class Gradients {
 public:
  /// Forgets points whose weights changed, and those around them. No allocation.
  void forget(const Surface& surface, std::span<const Index> points);
  /// Forgets the points of faces that changed. No allocation.
  void forget(const TornModel& model, const Structure& structure,
              std::span<const ChangeRecord> changes);
  /// One entry per point.
  std::span<const ParticleGradients> of(const Surface& surface, const Structure& structure);

 private:
  void forget(Index point);
  void forget(const TornModel& model, const Structure& structure, const MeshChange& change);

  std::vector<ParticleGradients> gradients_;
  std::vector<bool> is_known_;
  std::vector<Index> unknown_;  ///< Has room for all points of `is_known_`.
  bool is_wanted_ = false;      ///< Nothing is done before the first of().
};

}  // namespace sunder::particles
