#pragma once

#include <span>
#include <vector>

#include "particles/motion/motion.h"
#include "particles/motion/rest_motion.h"

namespace sunder::particles {

/// What plastic flow depends on.
struct PlasticWorld {
  const ParticleSet& set;
  const SpringGraph& graph;
  std::span<const SoftMaterial> materials;
  const RestMotion& rests;
};

/// Lets the tissue of awake particles flow that is strained beyond its yield stretch: perfect
/// plasticity of the membrane S |grad u - P|^2 / 2, by radial return. The gradient of a particle is
/// the linear map that fits best how its neighbours' seeds moved from its own, weighted by the
/// couplings; the part of it that is kept is Plastic::strains, at most the material's limit.
/// Where something flowed, Plastic::forces are written too. O(active x neighbours).
/// @throws std::bad_alloc
void flow(const PlasticWorld& world, std::span<const Index> active, Motion& motion);

/// Writes Plastic::forces, by which the springs pull as if their rest were strained: each by its
/// stiffness times (P_p + P_q) / 2 (X_q - X_p). Nothing without strains. O(particles x neighbours).
void push_by_strains(const ParticleSet& set, const SpringGraph& graph, Motion& motion);

/// The force on a particle along the axes of the decomposition's pose: at its lips, and by what it
/// keeps.
[[nodiscard]] inline Vec3d force_in_rest(const Motion& motion, Index p) {
  if (motion.plastic.forces.empty()) return motion.lip_forces[p];
  return motion.lip_forces[p] + motion.plastic.forces[p];
}

}  // namespace sunder::particles
