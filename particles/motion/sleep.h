#pragma once

#include "particles/motion/motion.h"
#include "particles/motion/rest_motion.h"

namespace sunder::particles {

/// All beside its velocity that accelerates a particle.
struct Pull {
  Vec3d acceleration = Vec3d::Zero();  ///< What its springs, neighbours and outer forces leave; without holds and colliders.
  bool is_pushed = false;              ///< Whether anything but springs acts.
  double stiffness = 0;                ///< Of all springs, 1/s^2.
};
[[nodiscard]] Pull pull_on(Index particle, const SpringGraph& graph, std::span<const SoftMaterial> materials,
                           const RestMotion& rests, const Vec3d& gravity, const Motion& motion);

/// Who is quiet and who feels what. Places are compared with a particle's range, which is the scale at which displacements show.
class Sleep {
 public:
  struct World {
    const ParticleSet& set;
    const SpringGraph& graph;
    std::span<const SoftMaterial> materials;
    const RestMotion& rests;
    Vec3d gravity;
  };

  /// Wakes a particle that sleeps, where what pulls at it is not what it fell asleep with: where that would move it visibly.
  static void wake_if_pulled(const World& world, Index particle, Motion& motion);
  /// The same for sleepers beside those that are awake: what moves them goes on from neighbour to neighbour while it is felt.
  void wake_neighbours(const World& world, std::span<const Index> active, Motion& motion);
  /// Puts to sleep who has been quiet for half a second, and whose neighbours have. What nothing pushes and is all but at rest is
  /// put to rest exactly.
  void fall_asleep(const World& world, std::span<const Index> active, double seconds, Motion& motion);

 private:
  static bool is_bound_near(const World& world, Index particle, const Motion& motion);
  static void measure(const World& world, std::span<const Index> active, double seconds, Motion& motion);

  std::vector<Index> tired_;
  std::vector<std::uint64_t> asked_;  // in which round a particle was asked
  std::uint64_t round_ = 0;
};

}  // namespace sunder::particles
