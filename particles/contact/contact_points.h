#pragma once

#include "particles/clusters/surface_pose.h"

namespace sunder::particles {

/// Points of the surface by which particles feel colliders: per particle up to sixteen of those
/// that it moves most, spread over their distance from its seed. They are computed on demand, and
/// again after a tear.
class ContactPoints {
 public:
  static constexpr Index kMost = 16;
  struct Points {
    std::array<Index, kMost> points = {};
    std::array<Vec3d, kMost> places = {};  ///< In the pose, without displacement.
    Index count = 0;
    /// Revision of the set plus one, and epoch of the pose; 0: none.
    std::uint64_t revision = 0, epoch = 0;
  };

  [[nodiscard]] std::size_t memory_bytes() const { return points_.capacity() * sizeof(Points); }
  void follow(Index particles) { points_.resize(particles); }
  ///
  /// @param pose  that of `epoch`. Allocates if the set's revision changed.
  const Points& of(const ParticleSet& set, const TornModel& model, const SurfacePose& pose,
                   std::uint64_t epoch, Index particle);

 private:
  std::vector<Points> points_;
};

}  // namespace sunder::particles
