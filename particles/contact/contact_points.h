#pragma once

#include "particles/motion/point_places.h"

namespace sunder::particles {

/// Points of the surface by which particles feel colliders: of each particle up to sixteen of those that it moves most, spread over
/// their distance from its seed. Found when they are asked for, and again after a tear.
class ContactPoints {
 public:
  static constexpr Index kMost = 16;
  struct Points {
    std::array<Index, kMost> points = {};
    std::array<Vec3d, kMost> places = {};  ///< In the pose, without displacement.
    Index count = 0;
    std::uint64_t revision = 0, epoch = 0;  // of the set and of the pose; 0: of none
  };

  void follow(Index particles) { points_.resize(particles); }
  /// @param places  set to the pose of `epoch`.
  const Points& of(const ParticleSet& set, const TornModel& model, const PointPlaces& places, std::uint64_t epoch, Index particle);

 private:
  std::vector<Points> points_;
};

}  // namespace sunder::particles
