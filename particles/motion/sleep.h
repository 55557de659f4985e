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
    double tolerance;  ///< Sleep::tolerance().
  };

  /// Counts the time in which nothing outside of the body changed: no pose, force, material, tear
  /// or collider. @param is_disturbed  whether something changed since the last call.
  void count_still_seconds(double seconds, bool is_disturbed) {
    still_seconds_ = is_disturbed ? 0 : still_seconds_ + seconds;
  }
  /// By how much more particles in contact or at a limit may tremble and sleep than at first.
  /// Sweeps over contacts and limits may never find the balance of all of them, but then they only
  /// repeat a small motion.
  [[nodiscard]] double tolerance() const;
  [[nodiscard]] double still_seconds() const { return still_seconds_; }
  void set_still_seconds(double seconds) { still_seconds_ = seconds; }

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
  void find_bound(const World& world, std::span<const Index> active, const Motion& motion);
  void measure(const World& world, std::span<const Index> active, double seconds, Motion& motion);

  std::vector<Index> tired_, found_;
  /// Per particle: whether it moves with bound ones, so that bound ones keep it from coming to
  /// rest.
  std::vector<std::uint8_t> moves_with_bound_;
  std::vector<std::uint64_t> asked_;  // round in which a particle was asked
  std::uint64_t round_ = 0;
  double still_seconds_ = 0;
};

}  // namespace sunder::particles
