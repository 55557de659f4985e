#pragma once

#include <algorithm>

#include "particles/internal/recorded_limits.h"
#include "particles/motion/is_rotation.h"
#include "particles/motion/spring_graph.h"

namespace sunder::particles {

/// Positions, rotations and velocities of particles at rest in the pose. Computed only for
/// requested particles.
class RestMotion {
 public:
  /// @return as ParticleSet::rest().
  Status begin(const ParticleSet& set, const ModelPose& pose);
  /// Follows a changed set: evaluates the particles that changed, in the current pose. A move
  /// caused only by the set is not a motion.
  /// @param changed  ascending; all new ones are among them. @throws std::bad_alloc
  void follow(const ParticleSet& set, std::span<const Index> changed);

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
  [[nodiscard]] std::size_t memory_bytes() const {
    return particles_.capacity() * sizeof(Particle) + rests_.capacity() * sizeof(ParticleRest) +
           (stale_.capacity() + moved_.capacity() + carried_.capacity()) * sizeof(Index) +
           (decomposition_pose_.model_from_bone.capacity() + pose_.model_from_bone.capacity()) *
               sizeof(Affine3d);
  }
  /// Passes its state to a tape, but for the decomposition's pose and what follows from it: while
  /// reading, this object has followed the set.
  template <class Tape>
  void describe(Tape& tape) {
    const std::vector<Particle> own = particles_;
    tape(epoch_);
    tape.require(epoch_ < kMostRecordedNumber, "the number of a pose");
    tape.each(particles_, [&](Particle& of) {
      for (Vec3d* vector : {&of.place, &of.velocity, &of.shift})
        tape.within(*vector, kMostRecordedLength);
      for (Mat3d* matrix : {&of.turn, &of.turn_of_step}) {
        tape(*matrix);
        tape.require(is_rotation(*matrix), "the turn of a particle is no rotation");
      }
      tape.within(of.size, 0, kMostRecordedLength);
      tape(of.epoch);
      tape.require(of.epoch <= epoch_, "the pose of a particle");
    });
    for (std::size_t p = 0; p < std::min(own.size(), particles_.size()); ++p)
      particles_[p].decomposition_from_bind = own[p].decomposition_from_bind;
    std::uint64_t bones = pose_.model_from_bone.size();
    tape(bones);
    tape.require(bones == pose_.model_from_bone.size(), "a pose has another number of bones");
    for (Affine3d& bone : pose_.model_from_bone)
      for (int i = 0; i < 12; ++i)
        tape.within(bone.matrix()(i % 3, i / 3), -kMostRecordedLength, kMostRecordedLength);
    std::uint64_t weights = pose_.morph_weights.size();
    tape(weights);
    tape.require(weights == pose_.morph_weights.size(), "a pose has other morph weights");
    for (float& weight : pose_.morph_weights)
      tape.within(weight, -kMostRecordedLength, kMostRecordedLength);
    tape(is_gap_);
    tape.all(carried_);
    for (const Index p : carried_) tape.require(p < particles_.size(), "a carried particle");
  }
  [[nodiscard]] std::size_t count() const { return particles_.size(); }
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
