#pragma once

#include <sunder/particles/soft_body.h>

#include "particles/clusters/influences.h"
#include "particles/motion/motion.h"
#include "particles/motion/rest_motion.h"
#include "particles/rupture/perforations.h"

namespace sunder::particles {

/// A body as tearing by force sees it: its surface, its materials, and its motion in the last step.
struct Tissue {
  const ParticleSet& set;
  const TornModel& model;
  std::span<const SoftMaterial> materials;
  const Motion& motion;
  const RestMotion& rests;
  const SpringGraph& graph;
  const Tension& tension;
  std::span<const Mat3d> added_tension;  ///< Per particle, or empty; see LipTension.
  Perforations perforations = Perforations(set, model);

  [[nodiscard]] bool is_awake(Index particle) const { return motion.awake[particle] != 0; }
  [[nodiscard]] const SoftMaterial& material(Index particle) const {
    return graph.material(particle, materials, motion.material_of);
  }
  /// Position of a point in the decomposition's pose.
  [[nodiscard]] Vec3d position(Index point) const { return set.positions()[point].cast<double>(); }
  /// Displacement of a point, along the axes of model space.
  [[nodiscard]] Vec3d displacement(Index point) const {
    Vec3d sum = Vec3d::Zero();
    for_each_influence(set.influences()[point], [&](Index particle, double weight) {
      sum += weight * motion.displacements[particle];
    });
    return sum;
  }
};

}  // namespace sunder::particles
