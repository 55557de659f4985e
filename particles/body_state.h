#pragma once

#include <sunder/particles/soft_body.h>

#include <memory>
#include <utility>

#include "particles/contact/contact.h"
#include "particles/contact/self_contact.h"
#include "particles/motion/coupling.h"
#include "particles/motion/hold_list.h"
#include "particles/motion/motion.h"
#include "particles/motion/moved_vertices.h"
#include "particles/motion/pose_tension.h"
#include "particles/motion/rest_motion.h"
#include "particles/motion/sleep.h"
#include "particles/motion/thread_list.h"

namespace sunder::particles {

/// The forces on all particles of a body.
struct OuterForces {
  Vec3d gravity = Vec3d::Zero();
  WindField wind;
  bool has_blown = false;  ///< Whether Motion::winds may be other than zero.
  Tension tension;
  ThreadList threads;
  bool is_tension_stale = false;  ///< Whether Motion::lip_forces must be recomputed.
  PoseTension of_pose;            ///< If Tension::adds_pose_strain.
  bool is_disturbed = false;      ///< Whether something changed since the last step.
  double time = 0;          ///< Seconds of all steps: the time at which the wind is asked for.
  double step_seconds = 0;  ///< Of the last one.

  void advance(double seconds) {
    time += seconds;
    step_seconds = seconds;
  }
};

/// The motion that renderers read.
struct ShownMotion {
  std::vector<Vec4f> displacements;
  std::vector<Mat3f> turns;
  std::vector<std::uint8_t> is_displaced;
  Index displaced_count = 0;
  std::uint64_t displaced_key = 1;  ///< Grows when `is_displaced` or the set changes.
  MovedVertices moved_vertices;
};

/// Scratch memory of a step.
struct StepScratch {
  std::vector<Index> active, needed, changed;
  std::vector<Index> followed;  ///< Particles that the last change of the set changed.
  std::vector<std::uint8_t> is_needed;
  std::vector<Vec3d> sums;
  std::vector<Vec3d> corrections;  ///< Per particle: by neighbours and holds.
  std::vector<SpringStep> steps;
  std::vector<PointPull> pulls;         ///< Of holds and threads.
  particles::SelfContact self_contact;  ///< It keeps nothing but what follows from the set.
};

/// The data of a SoftBody.
struct BodyState {
  ParticleSet* set = nullptr;
  std::uint64_t revision = 0;  ///< Revision of the set that all members below follow.
  SoftBodyOptions options;
  std::vector<SoftMaterial> materials;

  Motion motion;
  SpringGraph graph;
  RestMotion rests;
  EpochPose poses;
  CouplingSolver solver;
  Sleep sleep;
  OuterForces outer;
  HoldList holds;
  Contact contact;
  ShownMotion shown;
  StepScratch scratch;

  /// Whether nothing moves and no setting needs attention, so that a step has nothing to do.
  [[nodiscard]] bool is_idle() const;
  /// Whether nothing moves while the pose stays: as is_idle(), but displaced particles may be at
  /// rest.
  [[nodiscard]] bool is_still() const;
  /// Follows the set, if it changed. If memory runs out, the next call completes it. @throws
  /// std::bad_alloc
  void follow_particles();
  void wake_around(Index particle);
  /// Shows displacements that were set outside of a step.
  void show() { publish(false); }
  [[nodiscard]] std::size_t memory_bytes() const;
  /// Makes room for follow_particles().
  void reserve_for(Index count) { reserve(count); }
  void wake_all();
  /// @param pose, seconds  were checked, and the set was followed. @throws std::bad_alloc
  void step(const TornModel& model, const ModelPose& pose, bool is_posed, double seconds);

 private:
  void reserve(Index count);
  void inherit_motion();
  void connect_springs();
  void pull_lips(const TornModel& model, const ModelPose& pose, bool is_posed);
  void follow_pose(double seconds);
  void find_needed();
  void follow_forces(const TornModel& model, const ModelPose& pose);
  void find_active();
  void integrate(double seconds);
  void publish(bool is_posed);
  [[nodiscard]] Sleep::World world() const {
    return {*set, graph, materials, rests, outer.gravity, sleep.tolerance()};
  }
  [[nodiscard]] bool has_stretch_limit() const;
  [[nodiscard]] bool can_yield() const;
};

/// Gives functions of the module the data behind a body, and bodies of such data.
struct BodyStateOf {
  [[nodiscard]] static const BodyState& in(const SoftBody& body) { return *body.state_; }
  [[nodiscard]] static SoftBody body_of(std::unique_ptr<BodyState> state) {
    return SoftBody(std::move(state));
  }
};

}  // namespace sunder::particles
