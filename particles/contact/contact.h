#pragma once

#include <sunder/particles/soft_body.h>

#include "particles/contact/contact_points.h"
#include "particles/motion/epoch_pose.h"
#include "particles/motion/motion.h"
#include "particles/motion/rest_motion.h"

namespace sunder::particles {

/// The colliders of a body, and how they push its particles.
class Contact {
 public:
  /// Replaces all colliders, or none if memory runs out. @throws std::bad_alloc
  void set(std::span<const Collider> colliders);
  void move(std::uint32_t collider, const Vec3d& place, const Quatd& turn);
  [[nodiscard]] std::span<const Collider> colliders() const { return colliders_; }
  /// Whether any collider moved, was added or was removed since the last step.
  [[nodiscard]] bool is_changed() const { return is_changed_; }
  void follow(Index particles) {
    particle_count_ = particles;
    if (!colliders_.empty()) points_.follow(particles);
  }

  /// Sets a recorded state. @param before  the colliders after the last step. @throws
  /// std::bad_alloc
  void restore(std::span<const Collider> colliders, std::span<const Collider> before,
               bool is_changed, const ContactReport& report) {
    set(colliders);
    before_.assign(before.begin(), before.end());
    is_changed_ = is_changed;
    report_ = report;
  }
  /// The colliders after the last step.
  [[nodiscard]] std::span<const Collider> before() const { return before_; }
  [[nodiscard]] std::size_t memory_bytes() const {
    return (colliders_.capacity() + before_.capacity()) * sizeof(Collider) +
           points_.memory_bytes() + touches_.capacity() * sizeof(Touch);
  }

  struct World {
    const ParticleSet& set;
    const TornModel& model;
    const ModelPose& pose;
    bool is_posed;  ///< Whether the pose differs from that of the last step.
    const SpringGraph& graph;
    const RestMotion& rests;
    EpochPose& poses;
    double seconds;
  };

  /// Pushes contact points out of colliders, each by the particles that move it, in sweeps until
  /// none is deeper inside than kContactDepthRanges. Removes the velocity into the collider and,
  /// with friction, part of the velocity along it. Wakes the particles that it pushes. Position
  /// based, as limit_stretch(). O(particles x colliders + contacts x sweeps); O(1) if nothing is
  /// awake, moved or posed.
  void push_out(const World& world, Motion& motion);
  /// The report of the last push_out(); empty after skip_step().
  [[nodiscard]] const ContactReport& report() const { return report_; }
  void skip_step() { report_ = {}; }
  /// Ends a step: later velocities of the colliders are measured from their current places.
  void end_step();

 private:
  /// A contact point that is in a collider, or near it.
  struct Touch {
    Index point = 0;
    std::uint32_t collider = 0;
    Vec3d rest;  ///< Place in the pose, without displacement.
    ParticleInfluences whom;
    double squares = 0;    ///< Sum of the squares of its weights.
    double tolerance = 0;  ///< Metres.
    double dragged = 0;    ///< Distance by which friction moved it back, metres.
    double depth = 0;      ///< Total distance by which it was pushed, metres.
    Vec3d normal = Vec3d::Zero();
  };

  void find(const World& world, const Motion& motion);
  void find_near(const World& world, const Motion& motion, Index particle, double reach);
  void add_touch(const World& world, const Motion& motion, const ContactPoints::Points& points,
                 Index i, Index collider, double range);
  double push_once(const World& world, Motion& motion);
  Vec3d drag_back(const World& world, const Motion& motion, Touch& touch, const Vec3d& moved,
                  const SurfaceDistance& at) const;
  void slow_down(const World& world, Motion& motion);
  [[nodiscard]] Vec3d velocity_of(const Touch& touch, const Vec3d& place, double seconds) const;

  Index particle_count_ = 0;
  std::vector<Collider> colliders_, before_;
  bool is_changed_ = false;
  ContactPoints points_;
  std::vector<Touch> touches_;
  ContactReport report_;
};

}  // namespace sunder::particles
