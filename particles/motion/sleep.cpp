#include "particles/motion/sleep.h"

#include <algorithm>
#include <utility>

#include "core/internal/ordered.h"
#include "particles/internal/angular_frequency.h"
#include "particles/internal/tolerances.h"
#include "particles/motion/plasticity.h"

namespace sunder::particles {
Pull pull_on(Index p, const SpringGraph& graph, std::span<const SoftMaterial> materials,
             const RestMotion& rests, const Vec3d& gravity, const Motion& motion) {
  const SoftMaterial& material = materials[motion.material_of[p]];
  const double mass = graph.masses[p];
  const Vec3d outer = motion.forces[p] + multiply(rests.turn(p), force_in_rest(motion, p));
  Vec3d inner = Vec3d::Zero();
  double stiffness = 0;
  for (const Spring& spring : graph.of(p)) {
    inner += spring.stiffness * (motion.displacements[spring.other] - motion.displacements[p]);
    stiffness += spring.stiffness;
  }
  Pull pull;
  const Vec3d pushed = gravity + motion.winds[p] + outer / mass;
  pull.is_pushed = pushed != Vec3d::Zero();
  const double own = squared_frequency(material.return_frequency);
  pull.acceleration = pushed + inner / mass - own * motion.displacements[p];
  pull.stiffness = own + stiffness / mass;
  return pull;
}

double Sleep::tolerance() const {
  return std::clamp(1 + (still_seconds_ - kPatientSeconds) / kTiringSeconds, 1.0, kMostTolerance);
}

void Sleep::wake_if_pulled(const World& world, Index p, Motion& motion) {
  if (motion.awake[p] != 0) return;
  const Pull pull = pull_on(p, world.graph, world.materials, world.rests, world.gravity, motion);
  // A particle that sleeps displaced by a pull must return completely when the pull ends.
  const double range = world.set.range(p), displaced = norm(motion.displacements[p]);
  double place = displaced > 0
                     ? std::clamp(0.1 * displaced, 0.1 * kAtRestRanges * range, kFeltRanges * range)
                     : kFeltRanges * range;
  if (motion.bound[p] != 0 || motion.tired[p] != 0)
    place = world.tolerance * kFeltBoundRanges * range;
  const double feels = place * std::max(pull.stiffness, 1.0);
  if (squared_norm(pull.acceleration - motion.quiet.pulls[p]) > feels * feels) motion.wake(p);
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

/// Finds the bound particles and their neighbours; after kPatientSeconds all that are connected
/// with bound ones through awake ones.
void Sleep::find_bound(const World& world, std::span<const Index> active, const Motion& motion) {
  moves_with_bound_.assign(motion.count(), 0);
  found_.clear();
  const auto find = [&](Index p) {
    if (std::exchange(moves_with_bound_[p], std::uint8_t{1}) == 0) found_.push_back(p);
  };
  for (const Index p : active) {
    if (motion.bound[p] != 0) find(p);
    for (const Spring& spring : world.graph.of(p))
      if (motion.bound[spring.other] != 0) find(p);
  }
  if (still_seconds_ < kPatientSeconds) return;
  while (!found_.empty()) {
    const Index p = found_.back();
    found_.pop_back();
    for (const Spring& spring : world.graph.of(p))
      if (motion.awake[spring.other] != 0) find(spring.other);
  }
}

void Sleep::measure(const World& world, std::span<const Index> active, double seconds,
                    Motion& motion) {
  find_bound(world, active, motion);
  for (const Index p : active) {
    const bool is_bound = moves_with_bound_[p] != 0;
    const double range = world.set.range(p), quiet_speed = kQuietRangesPerSecond * range;
    const double quiet_place =
        (is_bound ? world.tolerance * kQuietBoundRanges : kQuietRanges) * range;
    if ((is_bound || squared_norm(motion.velocities[p]) <= quiet_speed * quiet_speed) &&
        squared_norm(motion.displacements[p] - motion.quiet.from[p]) <= quiet_place * quiet_place) {
      motion.quiet.seconds[p] += seconds;
      continue;
    }
    motion.quiet.seconds[p] = 0;
    motion.quiet.from[p] = motion.displacements[p];
  }
}

void Sleep::fall_asleep(const World& world, std::span<const Index> active, double seconds,
                        Motion& motion) {
  measure(world, active, seconds, motion);
  tired_.clear();
  for (const Index p : active) {
    if (motion.quiet.seconds[p] < kQuietSeconds) continue;
    const auto of_p = world.graph.of(p);
    if (std::any_of(of_p.begin(), of_p.end(), [&](const Spring& spring) {
          return motion.awake[spring.other] != 0 &&
                 motion.quiet.seconds[spring.other] < kQuietSeconds;
        }))
      continue;
    // Neighbours that creep back together hardly pull at one another, although the return spring
    // alone still has to move them.
    const Pull pull = pull_on(p, world.graph, world.materials, world.rests, world.gravity, motion);
    const double own = squared_frequency(world.materials[motion.material_of[p]].return_frequency);
    const double balanced = kQuietRanges * world.set.range(p) * (own > 0 ? own : pull.stiffness);
    if (squared_norm(pull.acceleration) <= balanced * balanced || moves_with_bound_[p] != 0)
      tired_.push_back(p);
  }
  for (const Index p : tired_) {
    motion.awake[p] = 0;
    --motion.awake_count;
    motion.velocities[p].setZero();
    const double at_rest = kAtRestRanges * world.set.range(p);
    if (world.materials[motion.material_of[p]].return_frequency > 0 && motion.bound[p] == 0 &&
        squared_norm(motion.displacements[p]) < at_rest * at_rest &&
        !pull_on(p, world.graph, world.materials, world.rests, world.gravity, motion).is_pushed)
      motion.displacements[p].setZero();
    motion.starts[p] = motion.displacements[p];
  }
  for (const Index p : tired_)
    if (still_seconds_ >= kPatientSeconds && motion.displacements[p] != Vec3d::Zero())
      motion.tired[p] = moves_with_bound_[p];
  for (const Index p : tired_)
    motion.quiet.pulls[p] =
        pull_on(p, world.graph, world.materials, world.rests, world.gravity, motion).acceleration;
}

}  // namespace sunder::particles
