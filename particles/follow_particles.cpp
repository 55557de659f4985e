#include <algorithm>
#include <span>
#include <utility>

#include "particles/body_state.h"
#include "particles/motion/inherit.h"
#include "particles/motion/lip_tension.h"

namespace sunder::particles {
namespace {

/// The four neighbours that share most with a particle, but for `orphans`, which ascend.
ParticleInfluences like_neighbours(const ParticleSet& set, Index particle, std::span<const Index> orphans) {
  ParticleInfluences found;
  for (const ParticleNeighbour& neighbour : set.neighbours(particle)) {
    if (std::binary_search(orphans.begin(), orphans.end(), neighbour.particle)) continue;
    Index other = neighbour.particle;
    auto shared = static_cast<float>(neighbour.shared);
    for (std::size_t k = 0; k < 4; ++k)
      if (shared > found.weights[k]) {
        std::swap(other, found.particles[k]);
        std::swap(shared, found.weights[k]);
      }
  }
  return found;
}

}  // namespace

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
  std::vector<Index> orphans;
  for (Index p = 0; p < count; ++p) {
    if (motion.serials[p] == set->serial(p)) continue;
    motion.serials[p] = set->serial(p);
    inherit(set->parents(p), p, rests, motion);
    if (!(set->parents(p).weights[0] > 0)) orphans.push_back(p);
  }
  // Who has no parents, as one that undo brought back, is as those around it: the tissue must not jump.
  for (const Index p : orphans) inherit(like_neighbours(*set, p, orphans), p, rests, motion);
  holds.follow(*set);
  contact.follow(count);
  displacements.resize(count, Vec4f::Zero());
  turns.resize(count, Mat3f::Identity());
  is_displaced.resize(count, 0);
  for (std::vector<Index>* list : {&active, &needed, &changed}) list->reserve(count);
  sums.reserve(count);
  is_needed.reserve(count);
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
  for (const ParticleNeighbour& neighbour : set->neighbours(particle)) motion.wake(neighbour.particle);
}

void BodyState::wake_all() {
  for (Index p = 0; p < motion.count(); ++p) motion.wake(p);
}

}  // namespace sunder::particles
