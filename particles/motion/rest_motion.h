#pragma once

#include "particles/motion/spring_graph.h"

namespace sunder::particles {

/// Positions, rotations and velocities of particles at rest in the pose. Computed only for
/// requested particles.
class RestMotion {
 public:
  /// @return as ParticleSet::rest().
  Status begin(const ParticleSet& set, const ModelPose& pose);
  /// Follows a changed set: evaluates all particles in the current pose. A move caused only by the
  /// set is not a motion. @throws std::bad_alloc
  void follow(const ParticleSet& set);

  /// Whether a pose has the bits of the last one.
  [[nodiscard]] bool is_same(const ModelPose& pose) const;
  /// Begins a step: with another pose, with the same one, or with one that is not evaluated.
  /// Velocities are zero until update().
  void begin_step(const ModelPose& pose);
  void begin_still_step();
  void skip_step();

  /// Evaluates the particles that are not up to date with the pose. O(bones + such particles x
  /// their bones).
  void update(const ParticleSet& set, std::span<const Index> particles, double seconds);
  /// Particles that moved since the previous step, according to the last update().
  [[nodiscard]] std::span<const Index> moved() const { return moved_; }
  /// Particles that the last update() evaluated.
  [[nodiscard]] std::span<const Index> updated() const { return stale_; }

  /// Sets the velocity of a new particle.
  void set_velocity(Index p, const Vec3d& velocity) {
    particles_[p].velocity = velocity;
    if (velocity != Vec3d::Zero()) carried_.push_back(p);
  }

  [[nodiscard]] const Vec3d& place(Index p) const { return particles_[p].place; }
  [[nodiscard]] const Vec3d& velocity(Index p) const { return particles_[p].velocity; }
  /// From the decomposition's pose to this one.
  [[nodiscard]] const Mat3d& turn(Index p) const { return particles_[p].turn; }
  /// For particles in moved(): how they moved.
  [[nodiscard]] const Vec3d& shift(Index p) const { return particles_[p].shift; }
  [[nodiscard]] const Mat3d& turn_of_step(Index p) const { return particles_[p].turn_of_step; }
  /// An upper bound of how much the pose lengthens the particle's members, times the root of 3.
  [[nodiscard]] double size(Index p) const { return particles_[p].size; }
  /// Particles with a velocity.
  [[nodiscard]] std::span<const Index> carried() const { return carried_; }
  /// Index of the pose; increasing.
  [[nodiscard]] std::uint64_t epoch() const { return epoch_; }

 private:
  struct Particle {
    Vec3d place = Vec3d::Zero(), velocity = Vec3d::Zero(), shift = Vec3d::Zero();
    Mat3d turn = Mat3d::Identity(), turn_of_step = Mat3d::Identity();
    Mat3d decomposition_from_bind =
        Mat3d::Identity();  // inverse of its linear part there; zero if it has none
    double size = 1;
    std::uint64_t epoch = 0;  // of its pose
  };

  void stop_all();
  void evaluate(const ParticleSet& set, const ModelPose& pose, std::span<const Index> particles);

  std::vector<Particle> particles_;
  ModelPose decomposition_pose_, pose_;
  std::uint64_t epoch_ = 1;
  bool is_gap_ = false;  // whether steps were skipped since the last pose
  std::vector<Index> stale_, moved_, carried_;
  std::vector<ParticleRest> rests_;
};

}  // namespace sunder::particles
