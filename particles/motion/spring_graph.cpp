#include "particles/motion/spring_graph.h"

#include <algorithm>
#include <cmath>

#include "core/internal/ordered.h"
#include "particles/internal/angular_frequency.h"
#include "particles/internal/tolerances.h"

namespace sunder::particles {

namespace {

double harmonic_mean(double a, double b) { return a + b > 0 ? 2 * a * (b / (a + b)) : 0.0; }

/// The stiffness of the foundation per area, N/m^3.
double foundation_of(const SoftMaterial& material) {
  return material.areal_density * squared_frequency(material.return_frequency);
}

}  // namespace

Spring spring_between(const SoftMaterial& a, const SoftMaterial& b, double coupling,
                      double squared_distance) {
  const double stiffness = harmonic_mean(a.membrane_stiffness, b.membrane_stiffness);
  const double damping = harmonic_mean(a.membrane_damping, b.membrane_damping);
  const double foundation = 0.5 * (foundation_of(a) + foundation_of(b));
  // A quarter of what the foundation resists between the two seeds.
  const double part = stiffness > 0 ? std::max(kLeastCoupledPart,
                                               1 - 0.25 * foundation * squared_distance / stiffness)
                                    : 0.0;
  Spring spring;
  spring.stiffness = coupling * part * stiffness;
  spring.damping = coupling * (stiffness > 0 ? part : 1.0) * damping;
  spring.stretch_limit = a.stretch_limit == 0   ? b.stretch_limit
                         : b.stretch_limit == 0 ? a.stretch_limit
                                                : std::min(a.stretch_limit, b.stretch_limit);
  return spring;
}

double mass_of(const ParticleSet& set, const SoftMaterial& material, Index particle) {
  const double range = set.range(particle);
  return material.areal_density * std::max(set.area(particle), kLeastCellArea * range * range);
}

void set_frequencies(SpringGraph& graph) {
  // The squared frequencies of a network are at most twice the largest rate of a particle.
  graph.rates.clear();
  for (Index p = 0; p < graph.masses.size(); ++p) {
    double sum = 0;
    for (const Spring& spring : graph.of(p)) sum += spring.stiffness;
    graph.rates.push_back(sum / graph.masses[p]);
  }
  for (Index p = 0; p < graph.masses.size(); ++p)
    for (Index s = graph.first[p]; s < graph.first[p + 1]; ++s) {
      Spring& spring = graph.springs[s];
      spring.frequency = std::sqrt(graph.rates[p] + graph.rates[spring.other]);
    }
}

void connect(const ParticleSet& set, std::span<const SoftMaterial> materials,
             std::span<const Index> material_of, SpringGraph& graph) {
  graph.is_stale = true;
  graph.springs.clear();
  graph.first.assign(1, 0);
  graph.masses.clear();
  const auto seed_of = [&](Index p) { return set.positions()[set.seed(p)]; };
  for (Index p = 0; p < set.particle_count(); ++p) {
    for (const ParticleNeighbour& neighbour : set.neighbours(p)) {
      const double squared_distance =
          squared_norm(Vec3d((seed_of(neighbour.particle) - seed_of(p)).cast<double>()));
      Spring spring =
          spring_between(materials[material_of[p]], materials[material_of[neighbour.particle]],
                         neighbour.coupling, squared_distance);
      spring.other = neighbour.particle;
      graph.springs.push_back(spring);
    }
    graph.first.push_back(static_cast<Index>(graph.springs.size()));
    graph.masses.push_back(mass_of(set, materials[material_of[p]], p));
  }
  set_frequencies(graph);
  graph.is_stale = false;
}

}  // namespace sunder::particles
