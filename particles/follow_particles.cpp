#include "particles/body_state.h"
#include "particles/lip_tension.h"

namespace sunder::particles {

/// A new particle moves as what it was torn from.
void BodyState::inherit(Index particle) {
  const ParticleInfluences& parents = set->parents(particle);
  Vec3d displacement = Vec3d::Zero(), velocity = Vec3d::Zero(), rest_velocity = Vec3d::Zero();
  double sum = 0;
  for (std::size_t k = 0; k < 4 && parents.weights[k] > 0; ++k) {
    const Index parent = parents.particles[k];
    if (parent >= motion.count() || parent == particle) continue;
    if (!(sum > 0)) motion.material_of[particle] = motion.material_of[parent];
    const double weight = parents.weights[k];
    displacement += weight * motion.displacements[parent];
    velocity += weight * motion.velocities[parent];
    rest_velocity += weight * rests.velocity(parent);
    sum += weight;
  }
  if (!(sum > 0)) motion.material_of[particle] = 0;
  motion.displacements[particle] = motion.starts[particle] = sum > 0 ? Vec3d(displacement / sum) : Vec3d::Zero();
  motion.velocities[particle] = sum > 0 ? Vec3d(velocity / sum) : Vec3d::Zero();
  rests.set_velocity(particle, sum > 0 ? Vec3d(rest_velocity / sum) : Vec3d::Zero());
  for (auto* vectors : {&motion.forces, &motion.lip_forces, &motion.winds, &motion.corrections, &motion.slept_pulls})
    (*vectors)[particle].setZero();
  motion.touched[particle] = motion.bound[particle] = 0;
  motion.wake(particle);
}

void BodyState::follow_particles() {
  if (set->revision() == revision) return;
  const Index count = set->particle_count();
  Index awake = 0;
  for (Index p = 0; p < std::min(count, motion.count()); ++p) awake += motion.awake[p];
  motion.awake_count = awake;
  motion.resize(count);
  if (options.follow == Follow::lag) {  // in the room, where it stays
    for (const Index p : rests.carried())
      if (p < count) motion.velocities[p] += rests.velocity(p);
    rests.begin_still_step();
  }
  rests.follow(*set);
  for (Index p = 0; p < count; ++p) {
    if (motion.serials[p] == set->serial(p)) continue;
    motion.serials[p] = set->serial(p);
    inherit(p);
  }
  holds.follow(*set);
  contact.follow(count);
  displacements.resize(count, Vec4f::Zero());
  turns.resize(count, Mat3f::Identity());
  is_displaced.resize(count, 0);
  for (std::vector<Index>* list : {&active, &needed, &changed}) list->reserve(count);
  sums.reserve(count);
  revision = set->revision();
  is_graph_stale = is_tension_stale = true;
  connect_springs();
  for (Index p = 0; p < count; ++p) {
    turns[p] = rests.turn(p).cast<float>();
    Sleep::wake_if_pulled(world(), p, motion);
  }
  publish(false);
  ++displaced_key;
}

void BodyState::connect_springs() {
  if (is_graph_stale) connect(*set, materials, motion.material_of, graph);
  is_graph_stale = false;
  if (!is_tension_stale) return;
  is_tension_stale = false;
  pull_lips(*set, tension, motion, sums, changed);
  for (const Index p : changed) wake_around(p);
}

void BodyState::wake_around(Index particle) {
  motion.wake(particle);
  for (const Neighbour& neighbour : set->neighbours(particle)) motion.wake(neighbour.particle);
}

void BodyState::wake_all() {
  for (Index p = 0; p < motion.count(); ++p) motion.wake(p);
}

}  // namespace sunder::particles
