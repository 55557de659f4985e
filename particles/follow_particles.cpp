#include <algorithm>
#include <new>
#include <span>
#include <utility>

#include "particles/body_state.h"
#include "particles/clusters/structure_of.h"
#include "particles/motion/inherit.h"
#include "particles/motion/lip_tension.h"
#include "particles/motion/plasticity.h"

namespace sunder::particles {
namespace {

/// The four neighbours that are coupled most to a particle, without `orphans`, which ascend.
ParticleInfluences like_neighbours(const ParticleSet& set, Index particle,
                                   std::span<const Index> orphans) {
  ParticleInfluences found;
  for (const ParticleNeighbour& neighbour : set.neighbours(particle)) {
    if (std::binary_search(orphans.begin(), orphans.end(), neighbour.particle)) continue;
    Index other = neighbour.particle;
    auto coupling = static_cast<float>(neighbour.coupling);
    for (std::size_t k = 0; k < 4; ++k)
      if (coupling > found.weights[k]) {
        std::swap(other, found.particles[k]);
        std::swap(coupling, found.weights[k]);
      }
  }
  return found;
}

}  // namespace

/// Reserves all memory that a body with this many particles needs in follow_particles(), except for
/// its springs.
void BodyState::reserve(Index count) {
  motion.resize(count);
  contact.follow(count);
  outer.of_pose.resize(count);
  shown.displacements.resize(count, Vec4f::Zero());
  shown.turns.resize(count, Mat3f::Identity());
  shown.is_displaced.resize(count, 0);
  for (std::vector<Index>* list :
       {&scratch.active, &scratch.needed, &scratch.changed, &scratch.followed})
    list->reserve(count);
  scratch.sums.reserve(count);
  scratch.corrections.resize(count);
  scratch.is_needed.reserve(count);
}

/// Gives new particles the motion of their parents.
void BodyState::inherit_motion() {
  std::vector<Index> orphans;
  orphans.reserve(motion.count());
  for (Index p = 0; p < motion.count(); ++p) {
    if (motion.serials[p] == set->serial(p)) continue;
    motion.serials[p] = set->serial(p);
    inherit(set->parents(p), p, rests, motion);
    if (!(set->parents(p).weights[0] > 0)) orphans.push_back(p);
  }
  // A particle without parents, such as one that undo restored, moves like its neighbours, so that
  // the tissue does not jump.
  for (const Index p : orphans) inherit(like_neighbours(*set, p, orphans), p, rests, motion);
}

void BodyState::follow_particles() {
  if (set->is_broken()) throw std::bad_alloc();  // its data is not consistent
  if (set->revision() == revision) return;
  const Index count = set->particle_count();
  std::vector<Index>& changed = scratch.followed;
  const std::vector<Particle>& particles = StructureOf::in(*set).particles;
  changed.clear();
  for (Index p = 0; p < count; ++p)
    if (p >= motion.count() || particles[p].revision > revision) changed.push_back(p);
  Index awake = 0;
  for (Index p = 0; p < std::min(count, motion.count()); ++p) awake += motion.awake[p];
  reserve(count);
  motion.awake_count = awake;
  if (options.follow == Follow::lag) {  // keeps its place in the world
    for (const Index p : rests.carried())
      if (p < count) motion.velocities[p] += rests.velocity(p);
    rests.begin_still_step();
  }
  rests.follow(*set, changed);
  inherit_motion();
  holds.follow(*set);
  outer.threads.follow(*set, motion);
  graph.is_stale = outer.is_tension_stale = true;
  connect_springs();
  for (const Index p : changed) {
    shown.turns[p] = rests.turn(p).cast<float>();
    Sleep::wake_if_pulled(world(), p, motion);
    for (const Spring& spring : graph.of(p)) Sleep::wake_if_pulled(world(), spring.other, motion);
  }
  publish(false);
  ++shown.displaced_key;
  revision = set->revision();
}

void BodyState::connect_springs() {
  if (graph.is_stale) {
    connect(*set, materials, motion.material_of, graph);
    push_by_strains(*set, graph, motion);
    outer.is_tension_stale |= outer.tension.adds_pose_strain;  // it depends on the materials
  }
  if (!outer.is_tension_stale || outer.tension.adds_pose_strain) return;
  particles::pull_lips(*set, outer.tension, {}, motion, scratch.sums, scratch.changed);
  outer.is_tension_stale = false;
  for (const Index p : scratch.changed) wake_around(p);
}

void BodyState::wake_around(Index particle) {
  outer.is_disturbed = true;
  motion.wake(particle);
  for (const ParticleNeighbour& neighbour : set->neighbours(particle))
    motion.wake(neighbour.particle);
}

void BodyState::wake_all() {
  outer.is_disturbed = true;
  for (Index p = 0; p < motion.count(); ++p) motion.wake(p);
}

}  // namespace sunder::particles
