#pragma once

#include <sunder/particles/soft_body.h>

#include <limits>

#include "particles/motion/coupling.h"
#include "particles/motion/motion.h"
#include "particles/motion/point_places.h"
#include "particles/motion/rest_motion.h"

namespace sunder::particles {

/// What callers hold.
class HoldList {
 public:
  HoldId add_particle(const ParticleSet& set, Index particle, const Vec3d& target, double stiffness);
  HoldId add_point(const ParticleSet& set, Index point, const Vec3d& target, double stiffness);
  /// @return whether there is such a hold.
  bool move(HoldId id, const Vec3d& target);
  /// @param whom  what it held. @return whether there was such a hold.
  bool remove(HoldId id, ParticleInfluences& whom);
  [[nodiscard]] bool empty() const { return holds_.empty(); }

  /// Drops what holds points and particles that are no more, and finds what moves the others.
  void follow(const ParticleSet& set);
  /// Calls visit(particle) for everyone who is held.
  template <class Visit>
  void for_each_held(Visit visit) const {
    for (const Hold& hold : holds_)
      for (std::size_t k = 0; k < 4 && hold.whom.weights[k] > 0; ++k) visit(hold.whom.particles[k]);
  }

  /// Sets up pulls() for a step, and wakes those whose pull is another than in the last one.
  void begin_step(const TornModel& model, const ModelPose& pose, const RestMotion& rests, std::span<const SoftMaterial> materials,
                  PointPlaces& places, Motion& motion);
  [[nodiscard]] std::span<const PointPull> pulls() const { return pulls_; }

 private:
  struct Hold {
    HoldId id = 0;
    Index particle = kNone, point = kNone;  // one of them
    std::uint64_t serial = 0;               // of the particle
    ParticleInfluences whom;
    Vec3d target = Vec3d::Zero();
    double stiffness = 0;
    Vec3d last = Vec3d::Constant(std::numeric_limits<double>::quiet_NaN());  // displacement to which it pulled
    Vec3d rest = Vec3d::Zero();                                              // place of the point
    std::uint64_t epoch = 0;                                                 // of that place
  };

  std::vector<Hold> holds_;
  std::vector<PointPull> pulls_;
  HoldId next_ = 1;
};

}  // namespace sunder::particles
