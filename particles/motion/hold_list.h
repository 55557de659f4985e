#pragma once

#include <sunder/particles/soft_body.h>

#include <cmath>
#include <limits>

#include "particles/internal/recorded_limits.h"
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

  /// Adds the pulls of a step, and wakes the particles whose pull differs from that of the last
  /// step.
  void begin_step(const TornModel& model, const ModelPose& pose, const RestMotion& rests,
                  std::span<const double> masses, EpochPose& poses, Motion& motion,
                  std::vector<PointPull>& pulls);
  /// Passes its state to a tape. Afterwards find_held() or follow() is to be called.
  template <class Tape>
  void describe(Tape& tape, Index particles, Index points) {
    HoldId next = 1;
    tape.each(holds_, [&](Hold& hold) {
      tape(hold.id);
      tape(hold.particle);
      tape(hold.point);
      tape(hold.serial);
      tape.within(hold.target, kMostRecordedLength);
      tape.within(hold.stiffness, std::numeric_limits<double>::min(), kMostRecordedForce);
      for (int i = 0; i < 3; ++i) {
        tape.any(hold.last[i]);
        tape.require(!(std::abs(hold.last[i]) > 2 * kMostRecordedLength), "the pull of a hold");
      }
      tape.within(hold.rest, kMostRecordedLength);
      tape(hold.epoch);
      const bool fits = hold.point == kNone ? hold.particle < particles
                                            : hold.particle == kNone && hold.point < points;
      tape.require(fits && hold.id >= next, "a hold");
      next = hold.id + 1;
    });
    tape(next_);
    tape.require(next_ >= next && next_ < kMostRecordedNumber, "the number of a hold");
  }
  /// Finds the particles that move what is held, for holds of this state of the set.
  /// @return false if a hold is of nothing that is there.
  [[nodiscard]] bool find_held(const ParticleSet& set);

 private:
  struct Hold;
  [[nodiscard]] static bool is_there(const Hold& hold, const ParticleSet& set);
  static void find_held(const ParticleSet& set, Hold& hold);

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
  HoldId next_ = 1;
};

}  // namespace sunder::particles
