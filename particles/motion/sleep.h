#pragma once

#include "particles/motion/motion.h"
#include "particles/motion/rest_motion.h"

namespace sunder::particles {

/// The acceleration of a particle, without damping.
struct Pull {
  Vec3d acceleration = Vec3d::Zero();  ///< Sum over its springs, neighbours and outer forces;
                                       ///< without holds and colliders.
  bool is_pushed = false;              ///< Whether anything except springs acts.
  double stiffness = 0;                ///< Of all springs, 1/s^2.
};
[[nodiscard]] Pull pull_on(Index particle, const SpringGraph& graph,
                           std::span<const SoftMaterial> materials, const RestMotion& rests,
                           const Vec3d& gravity, const Motion& motion);

/// Decides which particles sleep and wake. Distances are relative to a particle's range, the scale
/// at which displacements are visible.
class Sleep {
 public:
  struct World {
    const ParticleSet& set;
    const SpringGraph& graph;
    std::span<const SoftMaterial> materials;
    const RestMotion& rests;
    Vec3d gravity;
  };

  /// Wakes a sleeping particle if the pull on it differs from that at which it fell asleep by
  /// enough to move it visibly.
  static void wake_if_pulled(const World& world, Index particle, Motion& motion);
  /// The same for the sleeping neighbours of awake particles: motion spreads from neighbour to
  /// neighbour while it is visible.
  void wake_neighbours(const World& world, std::span<const Index> active, Motion& motion);
  /// Puts to sleep particles that, like their neighbours, have been quiet for kQuietSeconds. Those
  /// without a push that are nearly at rest are put to rest exactly.
  void fall_asleep(const World& world, std::span<const Index> active, double seconds,
                   Motion& motion);

 private:
  static bool is_bound_near(const World& world, Index particle, const Motion& motion);
  static void measure(const World& world, std::span<const Index> active, double seconds,
                      Motion& motion);

  std::vector<Index> tired_;
  std::vector<std::uint64_t> asked_;  // round in which a particle was asked
  std::uint64_t round_ = 0;
};

}  // namespace sunder::particles
