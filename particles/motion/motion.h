#pragma once

#include "particles/motion/spring_graph.h"

namespace sunder::particles {

/// The state of particles that determines sleep. One entry per particle in every array.
struct Quiet {
  std::vector<double> seconds;  ///< Time for which the particle has been quiet.
  std::vector<Vec3d> from;      ///< The displacement at which it became quiet.
  std::vector<Vec3d> pulls;     ///< The remaining acceleration when the particle fell asleep.
};

/// What tissue keeps of its strain. One entry per particle in both arrays, or none if nothing was
/// ever kept.
struct Plastic {
  /// The part of the displacement's gradient that pulls no more, along the axes of the
  /// decomposition's pose.
  std::vector<Mat3d> strains;
  std::vector<Vec3d> forces;  ///< Of push_by_strains(), newtons; follows from the strains.

  void resize(Index count) {
    strains.reserve(count);
    forces.resize(count, Vec3d::Zero());
    strains.resize(count, Mat3d::Zero());
  }
};

/// The motion of particles. One entry per particle in every array.
struct Motion {
  std::vector<std::uint64_t> serials;
  std::vector<Index> material_of;
  /// From the rest place, along the axes of model space; metres.
  std::vector<Vec3d> displacements;
  std::vector<Vec3d> velocities;  ///< Of the displacement.
  std::vector<Vec3d> starts;      ///< Displacements before the step.
  std::vector<Vec3d> forces;      ///< Newtons, set by the caller.
  std::vector<Vec3d> lip_forces;  ///< Newtons, in the decomposition's pose.
  std::vector<Vec3d> winds;       ///< m/s^2.
  std::vector<std::uint8_t> awake;
  std::vector<std::uint8_t> touched;  ///< By a collider.
  /// Held, touched or at a stretch limit: the particle may be at rest without forces in balance.
  std::vector<std::uint8_t> bound;
  /// Asleep although it is not at rest alone, because it moved with bound ones in a still world.
  std::vector<std::uint8_t> tired;
  Quiet quiet;
  Plastic plastic;
  Index awake_count = 0;

  [[nodiscard]] Index count() const { return static_cast<Index>(displacements.size()); }

  /// New entries are at rest, of the first material, asleep. Allocates first, so it changes all or
  /// nothing.
  void resize(Index count) {
    serials.reserve(count);
    material_of.reserve(count);
    for (auto* column : vector_columns()) column->reserve(count);
    for (auto* flags : {&awake, &touched, &bound, &tired}) flags->reserve(count);
    quiet.seconds.reserve(count);
    if (!plastic.strains.empty()) plastic.resize(count);

    serials.resize(count, 0);
    material_of.resize(count, 0);
    for (auto* column : vector_columns()) column->resize(count, Vec3d::Zero());
    for (auto* flags : {&awake, &touched, &bound, &tired}) flags->resize(count, 0);
    quiet.seconds.resize(count, 0.0);
  }

  void wake(Index particle) {
    quiet.seconds[particle] = 0;
    if (awake[particle] != 0) return;
    rouse(particle);
    quiet.from[particle] = displacements[particle];
  }
  /// Wakes a particle that stays as quiet as it was: it may fall asleep in the same step.
  void rouse(Index particle) {
    if (awake[particle] != 0) return;
    awake[particle] = 1;
    tired[particle] = 0;
    ++awake_count;
  }

 private:
  std::array<std::vector<Vec3d>*, 8> vector_columns() {
    return {&displacements, &velocities, &starts,     &forces,
            &lip_forces,    &winds,      &quiet.from, &quiet.pulls};
  }
};

}  // namespace sunder::particles
