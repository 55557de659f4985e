#pragma once

#include "particles/structure.h"

namespace sunder::particles {

/// Gradients of points' weights along the surface: of those that changed since they were asked for last.
class Gradients {
 public:
  /// What changed: the weights of these points, and the faces of new ones. Nothing, before gradients were asked for.
  void forget(const Surface& surface, std::span<const Index> points);
  /// One a point.
  std::span<const ParticleGradients> of(const Surface& surface, const Structure& structure);

 private:
  std::vector<ParticleGradients> gradients_;
  std::vector<bool> is_known_;
  std::vector<Index> unknown_;
  bool is_wanted_ = false;
};

}  // namespace sunder::particles
