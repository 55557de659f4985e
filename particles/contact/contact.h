#pragma once

#include <sunder/particles/soft_body.h>

#include "particles/contact/contact_points.h"
#include "particles/motion/motion.h"
#include "particles/motion/rest_motion.h"

namespace sunder::particles {

/// Colliders, and what they push.
class Contact {
 public:
  void set(std::span<const Collider> colliders);
  void move(std::uint32_t collider, const Vec3d& place, const Quatd& turn);
  [[nodiscard]] std::span<const Collider> colliders() const { return colliders_; }
  /// Whether any collider moved, came or went since the last step.
  [[nodiscard]] bool is_changed() const { return is_changed_; }
  void follow(Index particles) { points_.follow(particles); }

  struct World {
    const ParticleSet& set;
    const TornModel& model;
    const ModelPose& pose;
    bool is_posed;  ///< Whether the pose is another than in the last step.
    const SpringGraph& graph;
    const RestMotion& rests;
    PointPlaces& places;
    double seconds;
  };

  /// Pushes contact points out of colliders, each by the particles that move it, in sweeps until none is deeper inside than a
  /// thousandth of a range; takes the velocity into the collider away, and with friction some of that along it. Wakes what it
  /// pushes. Position based, as limit_stretch(). O(particles x colliders + contacts x sweeps); nothing awake, moved or posed: O(1).
  ContactReport push_out(const World& world, Motion& motion);
  /// Colliders are where they will have been.
  void end_step();

 private:
  struct Touch {
    Index point = 0;
    std::uint32_t collider = 0;
    Vec3d rest;  // place in the pose
    ParticleInfluences whom;
    double squares = 0;  // of its weights
    double tolerance = 0;
    double dragged = 0;  // by which friction took it back
    double depth = 0;    // by which it was pushed, all in all
    Vec3d normal = Vec3d::Zero();
  };

  void find(const World& world, const Motion& motion);
  double push_once(const World& world, Motion& motion);
  void slow_down(const World& world, Motion& motion);
  [[nodiscard]] Vec3d velocity_of(const Touch& touch, const Vec3d& place, double seconds) const;

  std::vector<Collider> colliders_, before_;
  bool is_changed_ = false;
  ContactPoints points_;
  std::vector<Touch> touches_;
};

}  // namespace sunder::particles
