#pragma once

#include "particles/bullet/substep_springs.h"

namespace sunder::particles {

/// Rest places of particles in world space, metres, on their way to where the pose has them.
class RestPath {
 public:
  /// Evaluates the rest places of a pose. @return as ParticleSet::rest().
  Status evaluate(const ParticleSet& set, const ModelPose& pose, const Affine3d& world_from_model,
                  Columns& places);

  /// The places as of the substep that Bullet reached, and where they are to be.
  [[nodiscard]] const Columns& places() const { return places_; }
  [[nodiscard]] const Columns& target() const { return target_; }
  [[nodiscard]] bool moves() const { return moves_; }

  /// Replaces all places, of other particles than before.
  void follow(Columns places) { places_ = std::move(places); }
  /// Sets where the places are to be.
  void set_target(const Columns& target);
  /// Lets them move there evenly in some seconds more. @param substep  that Bullet may be behind.
  void begin(double seconds, double substep);
  /// Puts them there at once.
  void jump();

  /// The fraction of the way to the target that they go in a substep.
  [[nodiscard]] double part_of_way(double seconds) const;
  /// Moves them by a substep.
  void advance(double seconds);

 private:
  Columns places_, target_;
  double remaining_ = 0;  ///< Seconds to the target.
  bool moves_ = false;
  std::vector<Index> all_;
  std::vector<ParticleRest> rests_;
};

}  // namespace sunder::particles
