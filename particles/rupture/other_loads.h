#pragma once

#include <vector>

#include "particles/rupture/tissue.h"

namespace sunder::particles {

/// The loads on particles other than the membrane, its foundation and the tension at lips: holds,
/// colliders, gravity, wind, forces, inertia, damping. The springs of a particle do not balance
/// them. They are summed over a region of the surface that is given in small parts.
class OtherLoads {
 public:
  explicit OtherLoads(const Tissue& tissue) : tissue_(tissue) {}

  /// Adds a part of a particle's cell. O(1) for the particle of the last part, otherwise O(log
  /// particles); allocates.
  void add(Index particle, double area, double weight);
  /// The integral of weight times load per area, newtons in model space, if the load of a particle
  /// is spread evenly over its cell. Zero while the springs of the body are not up to date.
  /// O(particles x neighbours).
  [[nodiscard]] Vec3d sum() const;

 private:
  struct OfParticle {
    Index particle = 0;
    double area = 0, weight = 0;  ///< Of its parts: the sum of areas, that of areas times weights.
  };

  const Tissue& tissue_;
  std::vector<OfParticle> parts_;  ///< Ascending by particle.
  std::size_t last_ = 0;
};

}  // namespace sunder::particles
