#include "particles/motion/spring_graph.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "core/internal/ordered.h"
#include "particles/clusters/structure_of.h"
#include "particles/internal/angular_frequency.h"
#include "particles/internal/tolerances.h"

namespace sunder::particles {

namespace {

double harmonic_mean(double a, double b) { return a + b > 0 ? 2 * a * (b / (a + b)) : 0.0; }

/// The stiffness of the foundation per area, N/m^3.
double foundation_of(const SoftMaterial& material) {
  return material.areal_density * squared_frequency(material.return_frequency);
}

double least_area_of(const ParticleSet& set, Index particle) {
  const double range = set.range(particle);
  return kLeastCellArea * range * range;
}

/// Particles and those in whose cells their seeds are, from both ends; ascending. The small
/// particles of a lip may take the whole cell of an older one, seed included. It still moves points
/// farther off, so it has to come along with the tissue at its seed.
std::vector<std::array<Index, 2>> crowded_pairs(const ParticleSet& set) {
  std::vector<std::array<Index, 2>> pairs;
  for (Index p = 0; p < set.particle_count(); ++p) {
    const Index owner = set.owners()[set.seed(p)];
    if (owner == p || owner == kNone) continue;
    // Where a surface has no area, particles have no cells either, and move freely.
    if (!(set.area(owner) > least_area_of(set, owner))) continue;
    pairs.push_back({p, owner});
    pairs.push_back({owner, p});
  }
  std::sort(pairs.begin(), pairs.end());
  pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
  return pairs;
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

const PointFactors* factors_at(const ParticleSet& set, Index particle) {
  const AuthoredPoints& authored = StructureOf::in(set).authored;
  return authored.has_factors() ? &authored.of_points[set.seed(particle)] : nullptr;
}

double mass_of(const ParticleSet& set, const SoftMaterial& material, Index particle) {
  return material.areal_density * std::max(set.area(particle), least_area_of(set, particle));
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
  graph.local.clear();
  for (Index p = 0; p < set.particle_count(); ++p)
    if (const PointFactors* factors = factors_at(set, p))
      graph.local.push_back(with_factors(materials[material_of[p]], *factors));
  const auto material = [&](Index p) -> const SoftMaterial& {
    return graph.material(p, materials, material_of);
  };
  const auto seed_of = [&](Index p) { return set.positions()[set.seed(p)]; };
  const std::vector<std::array<Index, 2>> crowded = crowded_pairs(set);
  auto next = crowded.begin();
  for (Index p = 0; p < set.particle_count(); ++p) {
    const auto add = [&](Index other, double coupling) {
      const double squared_distance =
          squared_norm(Vec3d((seed_of(other) - seed_of(p)).cast<double>()));
      Spring spring = spring_between(material(p), material(other), coupling, squared_distance);
      spring.other = other;
      graph.springs.push_back(spring);
    };
    const auto is_next_below = [&](Index end) {
      return next != crowded.end() && (*next)[0] == p && (*next)[1] < end;
    };
    const auto add_crowded = [&] {
      add((*next++)[1], kCrowdedCoupling);
      graph.springs.back().stretch_limit = 0;  // The two may be in one place.
    };
    for (const ParticleNeighbour& neighbour : set.neighbours(p)) {
      while (is_next_below(neighbour.particle)) add_crowded();
      const bool is_crowded = is_next_below(neighbour.particle + 1);
      add(neighbour.particle,
          is_crowded ? std::max(kCrowdedCoupling, neighbour.coupling) : neighbour.coupling);
      if (is_crowded) ++next;
    }
    while (is_next_below(kNone)) add_crowded();
    graph.first.push_back(static_cast<Index>(graph.springs.size()));
    graph.masses.push_back(mass_of(set, material(p), p));
  }
  set_frequencies(graph);
  graph.is_stale = false;
}

}  // namespace sunder::particles
