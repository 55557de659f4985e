#pragma once

#include <sunder/particles/soft_body.h>

#include "particles/motion/coupling.h"
#include "particles/motion/epoch_pose.h"
#include "particles/motion/motion.h"
#include "particles/motion/rest_motion.h"

namespace sunder::particles {

/// The threads of sutures: they pull points of two lips together, and break.
///
/// A thread that is longer than nothing by g pulls with stiffness times g, and with its tension as
/// soon as g is noticeable. In a step it acts as a spring of the stiffness that gives this pull at
/// the length with which the step began: that has the same equilibria, and is stable at any step.
class ThreadList {
 public:
  struct World {
    const ParticleSet& set;
    const TornModel& model;
    const ModelPose& pose;
    const RestMotion& rests;
    std::span<const double> masses;
    EpochPose& poses;
  };

  /// Takes up the threads of the set, and finds the particles that move their ends. A thread that
  /// the list has already keeps its state.
  void follow(const ParticleSet& set, Motion& motion);
  /// Adds the pulls of a step, and wakes the particles of threads whose length changed.
  void begin_step(const World& world, Motion& motion, std::vector<PointPull>& pulls);
  /// Measures the loads at the end of a step. @return whether a thread broke.
  bool end_step(Motion& motion);
  [[nodiscard]] std::span<const ThreadLoad> loads() const { return loads_; }

  /// Passes its state to a tape. Afterwards find_held() or follow() is to be called.
  template <class Tape>
  void describe(Tape& tape) {
    tape.each(threads_, [&](Thread& thread) {
      tape(thread.of.left);
      tape(thread.of.right);
      for (double* value : {&thread.of.stiffness, &thread.of.tension, &thread.of.strength})
        tape.within(*value, 0, kMostRecordedForce);
      tape.within(thread.rest, 2 * kMostRecordedLength);
      tape.within(thread.felt, 4 * kMostRecordedLength);
    });
    loads_.resize(threads_.size());
    for (ThreadLoad& load : loads_) {
      tape.within(load.newtons, 0, kMostRecordedLoad);
      tape(load.is_broken);
    }
  }
  /// Finds the particles of the ends, for threads of this state of the set.
  /// @return false if the threads are not those of the set.
  [[nodiscard]] bool find_held(const ParticleSet& set);
  [[nodiscard]] std::size_t memory_bytes() const;

 private:
  static constexpr double kMostRecordedLoad = 1e300;

  struct Thread {
    SutureThread of;
    /// The particles that move one end away from the other; without any, it holds nothing.
    PointPull pull;
    Vec3d rest = Vec3d::Zero();  ///< From its left to its right end, without displacements.
    Vec3d felt = Vec3d::Zero();  ///< The same with displacements, when it last woke its particles.
    double least_length = 0;     ///< From which its tension acts in full.

    [[nodiscard]] bool holds() const { return pull.weights[0] != 0; }
    [[nodiscard]] Vec3d way(const Motion& motion) const;
    [[nodiscard]] double newtons(double length) const;
  };
  static void find_held(const ParticleSet& set, Thread& thread);
  static void wake(const Thread& thread, Motion& motion);
  static bool is_awake(const Thread& thread, const Motion& motion);

  std::vector<Thread> threads_;
  std::vector<ThreadLoad> loads_;  ///< Per thread.
};

}  // namespace sunder::particles
