#include "particles/motion/spring_graph.h"

#include <algorithm>
#include <cmath>

namespace sunder::particles {

Spring spring_between(const SoftMaterial& a, const SoftMaterial& b, double coupling) {
  const double mass = 0.5 * (a.mass + b.mass), ratio = 0.5 * (a.damping_ratio + b.damping_ratio);
  const double stiffness = 0.5 * (a.neighbour_stiffness + b.neighbour_stiffness);
  Spring spring;
  spring.frequency = std::sqrt(stiffness);
  spring.stiffness = coupling * mass * stiffness;
  spring.damping = coupling * mass * 2 * ratio * spring.frequency;
  spring.stretch_limit = a.stretch_limit == 0   ? b.stretch_limit
                         : b.stretch_limit == 0 ? a.stretch_limit
                                                : std::min(a.stretch_limit, b.stretch_limit);
  return spring;
}

void connect(const ParticleSet& set, std::span<const SoftMaterial> materials,
             std::span<const Index> material_of, SpringGraph& graph) {
  graph.is_stale = true;
  graph.springs.clear();
  graph.first.assign(1, 0);
  for (Index p = 0; p < set.particle_count(); ++p) {
    for (const ParticleNeighbour& neighbour : set.neighbours(p)) {
      Spring spring =
          spring_between(materials[material_of[p]], materials[material_of[neighbour.particle]],
                         set.coupling(p, neighbour));
      spring.other = neighbour.particle;
      graph.springs.push_back(spring);
    }
    graph.first.push_back(static_cast<Index>(graph.springs.size()));
  }
  graph.is_stale = false;
}

}  // namespace sunder::particles
