#include "particles/rupture/other_loads.h"

#include <algorithm>

#include "core/internal/ordered.h"
#include "particles/internal/angular_frequency.h"

namespace sunder::particles {
namespace {

Vec3d load_on(const Tissue& tissue, Index particle) {
  const Motion& motion = tissue.motion;
  const Vec3d& displacement = motion.displacements[particle];
  Vec3d load = tissue.graph.masses[particle] *
                   squared_frequency(tissue.material(particle).return_frequency) * displacement -
               multiply(tissue.rests.turn(particle), motion.lip_forces[particle]);
  for (const Spring& spring : tissue.graph.of(particle))
    load += spring.stiffness * (displacement - motion.displacements[spring.other]);
  return load;
}

}  // namespace

void OtherLoads::add(Index particle, double area, double weight) {
  if (last_ >= parts_.size() || parts_[last_].particle != particle) {
    const auto at = std::ranges::lower_bound(parts_, particle, {}, &OfParticle::particle);
    last_ = static_cast<std::size_t>(at - parts_.begin());
    if (at == parts_.end() || at->particle != particle) parts_.insert(at, {particle, 0, 0});
  }
  parts_[last_].area += area;
  parts_[last_].weight += area * weight;
}

Vec3d OtherLoads::sum() const {
  const SpringGraph& graph = tissue_.graph;
  Vec3d sum = Vec3d::Zero();
  if (graph.is_stale || graph.first.size() != tissue_.motion.count() + std::size_t{1}) return sum;
  for (const OfParticle& of : parts_)  // the parts may be larger than a small cell
    sum += of.weight / std::max(of.area, tissue_.set.area(of.particle)) *
           load_on(tissue_, of.particle);
  return sum;
}

}  // namespace sunder::particles
