#pragma once

#include <sunder/particles/soft_body.h>

#include "particles/contact/contact.h"
#include "particles/motion/coupling.h"
#include "particles/motion/hold_list.h"
#include "particles/motion/motion.h"
#include "particles/motion/moved_vertices.h"
#include "particles/motion/rest_motion.h"
#include "particles/motion/sleep.h"

namespace sunder::particles {

/// What a SoftBody is made of.
struct BodyState {
  ParticleSet* set = nullptr;
  std::uint64_t revision = 0;  ///< Of the set, which all below is of.
  SoftBodyOptions options;
  std::vector<SoftMaterial> materials;

  Motion motion;
  SpringGraph graph;
  bool is_graph_stale = true;
  RestMotion rests;
  PointPlaces places;
  CouplingSolver solver;
  Sleep sleep;

  Vec3d gravity = Vec3d::Zero();
  WindField wind;
  Tension tension;
  bool is_tension_stale = false;
  HoldList holds;
  Contact contact;
  ContactReport contacts;
  double time = 0;  ///< Seconds of all steps.

  std::vector<Vec4f> displacements;
  std::vector<Mat3f> turns;
  std::vector<std::uint8_t> is_displaced;
  Index displaced_count = 0;
  std::uint64_t displaced_key = 1;  ///< Grows when `is_displaced` or the set changes.
  MovedVertices moved_vertices;

  // ---- Scratch.
  std::vector<Index> active, needed, changed;
  std::vector<std::uint8_t> is_needed;
  std::vector<Vec3d> sums;
  std::vector<SpringStep> steps;

  /// Nothing moves, and nothing is set that a step would have to look at.
  [[nodiscard]] bool is_idle() const;
  /// Follows the set, if it changed. @throws std::bad_alloc
  void follow_particles();
  void wake_around(Index particle);
  void wake_all();
  /// The poses and times were checked, and the set followed.
  void step(const TornModel& model, const ModelPose& pose, bool is_posed, double seconds);

 private:
  void connect_springs();
  void follow_pose(double seconds);
  void follow_forces(const TornModel& model, const ModelPose& pose);
  void integrate(double seconds);
  void publish(bool is_posed);
  [[nodiscard]] Sleep::World world() const { return {*set, graph, materials, rests, gravity}; }
  [[nodiscard]] bool has_stretch_limit() const;
};

}  // namespace sunder::particles
