#include "particles/body_state.h"
#include "particles/inherit.h"
#include "particles/lip_tension.h"

namespace sunder::particles {

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
    inherit(set->parents(p), p, rests, motion);
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
