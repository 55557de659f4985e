#pragma once

#include "particles/motion/spring_graph.h"

namespace sunder::particles {

/// What particles do: one entry a particle in every array.
struct Motion {
  std::vector<std::uint64_t> serials;
  std::vector<Index> material_of;
  std::vector<Vec3d> displacements;  ///< From where the pose puts the particle, along the axes of model space.
  std::vector<Vec3d> velocities;     ///< Of the displacement.
  std::vector<Vec3d> starts;         ///< Displacements before the step.
  std::vector<Vec3d> corrections;    ///< What neighbours and holds added in the last step: where the next search begins.
  std::vector<Vec3d> forces;         ///< Newtons, of the caller.
  std::vector<Vec3d> lip_forces;     ///< Newtons, in the decomposition's pose.
  std::vector<Vec3d> winds;          ///< m/s^2.
  std::vector<std::uint8_t> awake;
  std::vector<std::uint8_t> touched;  ///< By a collider.
  std::vector<std::uint8_t> bound;    ///< Held, touched or at a stretch limit: forces need not be in balance for it to be at rest.
  std::vector<double> quiet_seconds;  ///< For how long it has been quiet.
  std::vector<Vec3d> quiet_from;      ///< The displacement at which that began.
  std::vector<Vec3d> slept_pulls;     ///< Acceleration that was left when it fell asleep.
  Index awake_count = 0;

  [[nodiscard]] Index count() const { return static_cast<Index>(displacements.size()); }

  /// New entries are at rest, of the first material, asleep.
  void resize(Index count) {
    serials.resize(count, 0);
    material_of.resize(count, 0);
    for (auto* vectors :
         {&displacements, &velocities, &starts, &corrections, &forces, &lip_forces, &winds, &quiet_from, &slept_pulls})
      vectors->resize(count, Vec3d::Zero());
    for (auto* flags : {&awake, &touched, &bound}) flags->resize(count, 0);
    quiet_seconds.resize(count, 0.0);
  }

  void wake(Index particle) {
    quiet_seconds[particle] = 0;
    if (awake[particle] != 0) return;
    awake[particle] = 1;
    ++awake_count;
    quiet_from[particle] = displacements[particle];
    corrections[particle].setZero();
  }
};

}  // namespace sunder::particles
