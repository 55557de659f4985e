#pragma once

#include "particles/bullet/substep_springs.h"

namespace sunder::particles {

/// Rest places of particles in world space, metres, while they move to those of the pose.
class RestPath {
 public:
  /// Evaluates the rest places of a pose. @return as ParticleSet::rest().
  Status evaluate(const ParticleSet& set, const ModelPose& pose, const Affine3d& world_from_model,
                  Columns& places);

  /// The places at the substep that Bullet reached, and their targets.
  [[nodiscard]] const Columns& places() const { return places_; }
  [[nodiscard]] const Columns& target() const { return target_; }
  [[nodiscard]] bool moves() const { return moves_; }

  /// Replaces all places, for another set of particles.
  void follow(Columns places) { places_ = std::move(places); }
  /// Sets the targets of the places.
  void set_target(const Columns& target);
  /// Lets them move to the targets evenly within some seconds. @param substep  that Bullet may be
  /// behind.
  void begin(double seconds, double substep);
  /// Moves them to the targets at once.
  void jump();

  /// The fraction of the way to the target per substep.
  [[nodiscard]] double part_of_way(double seconds) const;
  /// Advances them by a substep.
  void advance(double seconds);

 private:
  Columns places_, target_;
  double remaining_ = 0;  ///< Seconds to the target.
  bool moves_ = false;
  std::vector<Index> all_;
  std::vector<ParticleRest> rests_;
};

}  // namespace sunder::particles
