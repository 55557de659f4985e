#include "particles/sleep.h"

#include <algorithm>

namespace sunder::particles {
namespace {

// In ranges of the particle, and in ranges a second.
constexpr double kQuietPlace = 1e-4, kQuietSpeed = 1e-3, kFeels = 5e-4, kIsAtRest = 2e-4;
constexpr double kQuietSeconds = 0.5;

}  // namespace

Pull pull_on(Index p, const SpringGraph& graph, std::span<const Material> materials, const RestMotion& rests, const Vec3d& gravity,
             const Motion& motion) {
  const Material& material = materials[motion.material_of[p]];
  const Vec3d outer = motion.forces[p] + rests.turn(p) * motion.lip_forces[p];
  Vec3d inner = Vec3d::Zero();
  double stiffness = 0;
  for (const Spring& spring : graph.of(p)) {
    inner += spring.stiffness * (motion.displacements[spring.other] - motion.displacements[p]);
    stiffness += spring.stiffness;
  }
  Pull pull;
  const Vec3d pushed = gravity + motion.winds[p] + outer / material.mass;
  pull.is_pushed = pushed != Vec3d::Zero();
  pull.acceleration = pushed + inner / material.mass - material.return_stiffness * motion.displacements[p];
  pull.stiffness = material.return_stiffness + stiffness / material.mass;
  return pull;
}

void Sleep::wake_if_pulled(const World& world, Index p, Motion& motion) {
  if (motion.awake[p] != 0) return;
  const Pull pull = pull_on(p, world.graph, world.materials, world.rests, world.gravity, motion);
  // Who sleeps displaced by a pull that goes must follow it all the way back.
  const double range = world.set.range(p), displaced = motion.displacements[p].norm();
  const double place = displaced > 0 ? std::clamp(0.1 * displaced, 0.1 * kIsAtRest * range, kFeels * range) : kFeels * range;
  const double feels = place * std::max(pull.stiffness, 1.0);
  if ((pull.acceleration - motion.slept_pulls[p]).squaredNorm() > feels * feels) motion.wake(p);
}

void Sleep::wake_neighbours(const World& world, std::span<const Index> active, Motion& motion) {
  if (motion.awake_count == motion.count()) return;
  asked_.resize(motion.count(), 0);
  ++round_;
  for (const Index p : active)
    for (const Spring& spring : world.graph.of(p)) {
      if (motion.awake[spring.other] != 0 || asked_[spring.other] == round_) continue;
      asked_[spring.other] = round_;
      wake_if_pulled(world, spring.other, motion);
    }
}

void Sleep::fall_asleep(const World& world, std::span<const Index> active, double seconds, Motion& motion) {
  for (const Index p : active) {
    const double range = world.set.range(p), quiet_place = kQuietPlace * range, quiet_speed = kQuietSpeed * range;
    if (motion.velocities[p].squaredNorm() > quiet_speed * quiet_speed ||
        (motion.displacements[p] - motion.quiet_from[p]).squaredNorm() > quiet_place * quiet_place) {
      motion.quiet_seconds[p] = 0;
      motion.quiet_from[p] = motion.displacements[p];
      continue;
    }
    motion.quiet_seconds[p] += seconds;
    if (motion.quiet_seconds[p] < kQuietSeconds) continue;
    Pull pull = pull_on(p, world.graph, world.materials, world.rests, world.gravity, motion);
    const double own = world.materials[motion.material_of[p]].return_stiffness;
    // Neighbours that creep back together hardly pull at one another: against the return spring alone there is still some way.
    const double balanced = quiet_place * (own > 0 ? own : pull.stiffness);
    if (motion.bound[p] == 0 && pull.acceleration.squaredNorm() > balanced * balanced) continue;
    motion.awake[p] = 0;
    --motion.awake_count;
    motion.velocities[p].setZero();
    motion.corrections[p].setZero();
    const double at_rest = kIsAtRest * range;
    if (own > 0 && !pull.is_pushed && motion.bound[p] == 0 && motion.displacements[p].squaredNorm() < at_rest * at_rest) {
      motion.displacements[p].setZero();
      pull = pull_on(p, world.graph, world.materials, world.rests, world.gravity, motion);
    }
    motion.starts[p] = motion.displacements[p];
    motion.slept_pulls[p] = pull.acceleration;
  }
}

}  // namespace sunder::particles
