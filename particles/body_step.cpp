#include <algorithm>
#include <numeric>

#include "core/internal/ordered.h"
#include "particles/body_state.h"
#include "particles/internal/angular_frequency.h"
#include "particles/internal/tolerances.h"
#include "particles/motion/lip_tension.h"
#include "particles/motion/plasticity.h"
#include "particles/motion/stretch_limit.h"

namespace sunder::particles {

bool BodyState::has_stretch_limit() const {
  return std::any_of(materials.begin(), materials.end(),
                     [](const SoftMaterial& material) { return material.stretch_limit > 0; });
}

bool BodyState::can_yield() const {
  return std::any_of(materials.begin(), materials.end(),
                     [](const SoftMaterial& material) { return material.yield_stretch > 0; });
}

bool BodyState::is_idle() const {
  const bool feels_pose =
      options.tracks_rest || (outer.tension.adds_pose_strain && !set->lips().empty());
  return shown.displaced_count == 0 && options.follow == Follow::ride && !feels_pose && is_still();
}

bool BodyState::is_still() const {
  return motion.awake_count == 0 && set->revision() == revision && set->is_settled() &&
         !graph.is_stale && !outer.is_tension_stale && holds.empty() &&
         contact.colliders().empty() && !outer.wind;
}

/// Lists the particles whose rest the step needs.
void BodyState::find_needed() {
  std::vector<Index>& needed = scratch.needed;
  needed.clear();
  const bool sees_all =
      options.follow == Follow::lag || options.tracks_rest || outer.wind ||
      !contact.colliders().empty() ||
      (options.self_contact.thickness > 0 && !set->lips().empty() && motion.awake_count > 0);
  if (sees_all) {
    needed.resize(motion.count());
    std::iota(needed.begin(), needed.end(), Index{0});
    return;
  }
  // A stretch limit measures neighbours too.
  const bool with_neighbours = has_stretch_limit();
  std::vector<std::uint8_t>& is_needed = scratch.is_needed;
  is_needed.assign(motion.count(), 0);
  for (Index p = 0; p < motion.count(); ++p) {
    if (motion.awake[p] == 0 && shown.is_displaced[p] == 0) continue;
    is_needed[p] = 1;
    if (with_neighbours)
      for (const Spring& spring : graph.of(p)) is_needed[spring.other] = 1;
  }
  holds.for_each_held([&](Index p) { is_needed[p] = 1; });
  for (Index p = 0; p < motion.count(); ++p)
    if (is_needed[p] != 0) needed.push_back(p);
}

/// Updates particles to the pose, and carries them along or lets them lag.
void BodyState::follow_pose(double seconds) {
  find_needed();
  rests.update(*set, scratch.needed, seconds);
  for (const Index p : rests.moved()) {
    if (options.follow == Follow::ride) {
      if (motion.awake[p] == 0 && shown.is_displaced[p] == 0) continue;
      if (motion.awake[p] == 0) motion.wake(p);
      for (auto* vectors : {&motion.displacements, &motion.velocities, &motion.quiet.from})
        (*vectors)[p] = multiply(rests.turn_of_step(p), (*vectors)[p]);
    } else {
      motion.wake(p);
      // During the step the frame moves with the rest; in a step of zero seconds it moves at once.
      if (seconds > 0)
        motion.velocities[p] -= rests.velocity(p);
      else
        motion.displacements[p] -= rests.shift(p);
    }
  }
}

/// Pulls at lips with what the pose adds.
void BodyState::pull_lips(const TornModel& model, const ModelPose& pose, bool is_posed) {
  if (!outer.is_tension_stale && (!is_posed || set->lips().empty())) return;
  outer.of_pose.update(*set, model, poses.at(model, pose, rests.epoch()), materials,
                       motion.material_of, graph);
  particles::pull_lips(*set, outer.tension, outer.of_pose.added(), motion, scratch.sums,
                       scratch.changed);
  for (const Index p : scratch.changed)
    if (outer.is_tension_stale)
      wake_around(p);
    else
      Sleep::wake_if_pulled(world(), p, motion);
  outer.is_tension_stale = false;
}

void BodyState::follow_forces(const TornModel& model, const ModelPose& pose) {
  if (outer.has_blown) std::fill(motion.winds.begin(), motion.winds.end(), Vec3d::Zero());
  outer.has_blown = static_cast<bool>(outer.wind);
  if (outer.wind)
    for (Index p = 0; p < motion.count(); ++p) {
      const Vec3d felt = outer.wind(rests.place(p) + motion.displacements[p], outer.time);
      if (felt.allFinite()) motion.winds[p] = felt;
      Sleep::wake_if_pulled(world(), p, motion);
    }
  if (contact.is_changed())
    for (Index p = 0; p < motion.count(); ++p)
      if (motion.touched[p] != 0) motion.wake(p);
  for (Index p = 0; p < motion.count(); ++p)
    if (motion.awake[p] != 0) motion.touched[p] = motion.bound[p] = 0;
  scratch.pulls.clear();
  holds.begin_step(model, pose, rests, graph.masses, poses, motion, scratch.pulls);
  outer.threads.begin_step({*set, model, pose, rests, graph.masses, poses}, motion, scratch.pulls);
}

/// Lists the particles that are awake.
void BodyState::find_active() {
  scratch.active.clear();
  for (Index p = 0; p < motion.count(); ++p)
    if (motion.awake[p] != 0) scratch.active.push_back(p);
}

/// Integrates the particles that are awake: each alone in closed form, then the corrections by
/// neighbours and holds.
void BodyState::integrate(double seconds) {
  std::vector<SpringStep>& steps = scratch.steps;
  steps.clear();
  for (const SoftMaterial& material : materials)
    steps.push_back(
        step_spring(squared_frequency(material.return_frequency), material.damping_ratio, seconds));
  for (const Index p : scratch.active) {
    const SpringStep& step = steps[motion.material_of[p]];
    const Vec3d force = motion.forces[p] + multiply(rests.turn(p), force_in_rest(motion, p));
    const Vec3d acceleration = outer.gravity + motion.winds[p] + force / graph.masses[p];
    const Vec3d place = motion.displacements[p], velocity = motion.velocities[p];
    motion.starts[p] = place;
    motion.displacements[p] = step.place_from_place * place + step.place_from_velocity * velocity +
                              step.place_from_acceleration * acceleration;
    motion.velocities[p] = step.velocity_from_place * place +
                           step.velocity_from_velocity * velocity +
                           step.velocity_from_acceleration() * acceleration;
  }
  if (seconds < kShortestStepSeconds) return;
  solver.solve({graph, scratch.active, steps, motion.material_of, motion.displacements,
                motion.velocities, scratch.pulls, seconds},
               scratch.corrections);
  for (const Index p : scratch.active) {
    const SpringStep& step = steps[motion.material_of[p]];
    motion.displacements[p] += scratch.corrections[p];
    motion.velocities[p] +=
        step.velocity_from_acceleration() / step.place_from_acceleration * scratch.corrections[p];
  }
}

/// Writes the data for renderers. @param is_posed  whether RestMotion::updated() is of this step.
void BodyState::publish(bool is_posed) {
  if (is_posed)
    for (const Index p : rests.updated()) shown.turns[p] = rests.turn(p).cast<float>();
  shown.displaced_count = 0;
  bool is_other = false;
  for (Index p = 0; p < motion.count(); ++p) {
    if (motion.awake[p] == 0 && shown.is_displaced[p] == 0) continue;
    const Vec3d& u = motion.displacements[p];
    shown.displacements[p] << u.cast<float>(), 0.0f;
    const std::uint8_t displaced = u != Vec3d::Zero() ? 1 : 0;
    shown.displaced_count += displaced;
    is_other |= displaced != shown.is_displaced[p];
    shown.is_displaced[p] = displaced;
  }
  if (is_other) ++shown.displaced_key;
}

void BodyState::step(const TornModel& model, const ModelPose& pose, bool is_posed, double seconds) {
  outer.advance(seconds);
  connect_springs();
  // A body that lags moves relative to the world; between steps its velocity is stored relative to
  // that of its rest.
  if (options.follow == Follow::lag)
    for (const Index p : rests.carried()) motion.velocities[p] += rests.velocity(p);
  if (is_posed)
    rests.begin_step(pose);
  else
    rests.begin_still_step();
  if (outer.tension.adds_pose_strain) pull_lips(model, pose, is_posed);
  const bool is_disturbed = is_posed || outer.is_disturbed || outer.wind || contact.is_changed();
  sleep.count_still_seconds(seconds, is_disturbed);
  outer.is_disturbed = false;
  if (is_disturbed)
    for (Index p = 0; p < motion.count(); ++p)
      if (motion.tired[p] != 0) motion.wake(p);
  follow_pose(seconds);
  follow_forces(model, pose);

  const std::vector<Index>& active = scratch.active;
  find_active();
  if (!active.empty() && seconds > 0) {
    integrate(seconds);
    if (outer.threads.end_step(motion)) outer.is_disturbed = true;
    if (can_yield()) flow({*set, graph, materials, rests}, active, motion);
    if (has_stretch_limit()) limit_stretch({graph, rests, active}, motion, scratch.changed);
  }
  const Contact::World around = {*set, model, pose, is_posed, graph, rests, poses, seconds};
  scratch.self_contact.push_apart(options.self_contact, around, motion);
  contact.push_out(around, motion);
  contact.end_step();
  if (seconds > 0) {
    find_active();  // contacts may have roused some
    sleep.wake_neighbours(world(), active, motion);
    sleep.fall_asleep(world(), active, seconds, motion);
  }
  publish(true);
}

}  // namespace sunder::particles
