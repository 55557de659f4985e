#pragma once

#include "particles/clusters/structure.h"
#include "tear/internal/surface.h"

namespace sunder::particles {

/// Gradients of points' weights along the surface: of those that changed since they were asked for last.
class Gradients {
 public:
  /// What changed: the weights of some points.
  void forget(const Surface& surface, std::span<const Index> points);
  /// And the faces around others.
  void forget(const TornModel& model, const Structure& structure, std::span<const ChangeRecord> changes);
  /// One a point.
  std::span<const ParticleGradients> of(const Surface& surface, const Structure& structure);

 private:
  void forget(Index point);

  std::vector<ParticleGradients> gradients_;
  std::vector<bool> is_known_;
  std::vector<Index> unknown_;
  bool is_wanted_ = false;  ///< Nothing is done before they were asked for.
};

}  // namespace sunder::particles
