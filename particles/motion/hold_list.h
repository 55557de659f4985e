#pragma once

#include <sunder/particles/soft_body.h>

#include <limits>

#include "particles/motion/coupling.h"
#include "particles/motion/epoch_pose.h"
#include "particles/motion/motion.h"
#include "particles/motion/rest_motion.h"

namespace sunder::particles {

/// The holds of a body: points and particles that callers pull to places.
class HoldList {
 public:
  HoldId add_particle(const ParticleSet& set, Index particle, const Vec3d& target,
                      double stiffness);
  HoldId add_point(const ParticleSet& set, Index point, const Vec3d& target, double stiffness);
  /// @return whether the hold exists.
  bool move(HoldId id, const Vec3d& target);
  ///
  /// @param whom  written: the held particle or point.
  /// @return whether the hold existed.
  bool remove(HoldId id, ParticleInfluences& whom);
  [[nodiscard]] bool empty() const { return holds_.empty(); }

  /// Drops holds of points and particles that no longer exist, and finds the particles that move
  /// the others.
  void follow(const ParticleSet& set);
  /// Calls visit(particle) for each particle that is held.
  template <class Visit>
  void for_each_held(Visit visit) const {
    for (const Hold& hold : holds_)
      for (std::size_t k = 0; k < 4 && hold.whom.weights[k] > 0; ++k) visit(hold.whom.particles[k]);
  }

  /// Sets up pulls() for a step, and wakes the particles whose pull differs from that of the last
  /// step.
  void begin_step(const TornModel& model, const ModelPose& pose, const RestMotion& rests,
                  std::span<const double> masses, EpochPose& poses, Motion& motion);
  /// Passes its state to a tape.
  template <class Tape>
  void describe(Tape& tape, Index particles, Index points) {
    tape.each(holds_, [&](Hold& hold) {
      tape(hold.id);
      tape(hold.particle);
      tape(hold.point);
      tape(hold.serial);
      for (Index& particle : hold.whom.particles) tape(particle);
      for (float& weight : hold.whom.weights) tape(weight);
      tape(hold.target);
      tape(hold.stiffness);
      for (int i = 0; i < 3; ++i) tape.any(hold.last[i]);
      tape(hold.rest);
      tape(hold.epoch);
      bool fits = hold.point == kNone ? hold.particle < particles
                                      : hold.particle == kNone && hold.point < points;
      for (const Index particle : hold.whom.particles) fits &= particle < particles;
      tape.require(fits && hold.stiffness > 0, "a hold");
    });
    tape(next_);
  }
  [[nodiscard]] std::span<const PointPull> pulls() const { return pulls_; }

 private:
  struct Hold {
    HoldId id = 0;
    Index particle = kNone, point = kNone;  // one of them
    std::uint64_t serial = 0;               // of the particle
    ParticleInfluences whom;
    Vec3d target = Vec3d::Zero();
    double stiffness = 0;
    Vec3d last =
        Vec3d::Constant(std::numeric_limits<double>::quiet_NaN());  // displacement of the last pull
    Vec3d rest = Vec3d::Zero();                                     // place of the point
    std::uint64_t epoch = 0;                                        // of that place
  };

  std::vector<Hold> holds_;
  std::vector<PointPull> pulls_;
  HoldId next_ = 1;
};

}  // namespace sunder::particles
