#pragma once

#include "particles/clusters/structure.h"
#include "tear/internal/surface.h"

namespace sunder::particles {

/// Gradients of the weights of points along the surface. Gradients that changed since the last of()
/// are recomputed there.
class Gradients {
 public:
  /// Invalidates points whose weights changed, and their neighbours. No allocation.
  void forget(const Surface& surface, std::span<const Index> points);
  /// Invalidates the points of faces that changed. No allocation.
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
  bool is_wanted_ = false;      ///< Nothing is computed before the first of().
};

}  // namespace sunder::particles
