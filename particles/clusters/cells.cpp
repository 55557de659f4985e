#include "particles/clusters/cells.h"

#include "particles/clusters/border_table.h"

namespace sunder::particles {
double coupling_of(const Structure& structure, Index particle, const ParticleNeighbour& neighbour) {
  const auto seed_of = [&](Index of) {
    return Vec3d(structure.points.positions[structure.particles[of].seed].cast<double>());
  };
  const Vec3d here = seed_of(particle), there = seed_of(neighbour.particle);
  const Vec3d between = there - here,
              middle = neighbour.middles / static_cast<double>(neighbour.edges);
  const double around = norm(Vec3d(middle - here)) + norm(Vec3d(there - middle));
  const double squared = squared_norm(between);
  if (!(around > 0)) return 0;
  if (around * around > kBentPath * kBentPath * squared) {
    const double coupling = norm(neighbour.across) / around;
    return coupling > kMostBentCoupling ? kTwoTipsCoupling : coupling;
  }
  return std::max(0.0, dot(neighbour.across, between) / squared);
}

void sum_cells(const tear::Surface& surface, Structure& structure) {
  BorderTable borders(4 * structure.particles.size());
  for (Index t = 0; t < surface.triangle_count(); ++t) {
    if (!has_cells(surface, t)) continue;
    const std::array<Index, 3> points = points_of(surface, t);
    FaceOfCells(structure.points.positions, points)
        .divide(
            owners_of(structure, points),
            [&](Index p, double area) { structure.particles[p].area += area; },
            [&](Index p, Index q, const Vec3d& across, const Vec3d& middle) {
              borders.add(p, q, 1, across, middle);
            });
  }
  borders.for_each([&](const BorderTable::Entry& of) {
    const auto edges = static_cast<Index>(of.edges);
    structure.particles[of.low()].neighbours.push_back(
        {of.high(), edges, 0.0, of.across, of.middles});
    structure.particles[of.high()].neighbours.push_back(
        {of.low(), edges, 0.0, Vec3d(-of.across), of.middles});
  });
  for (Index p = 0; p < structure.particles.size(); ++p) {
    std::vector<ParticleNeighbour>& neighbours = structure.particles[p].neighbours;
    std::ranges::sort(neighbours, {}, &ParticleNeighbour::particle);
    for (ParticleNeighbour& neighbour : neighbours)
      neighbour.coupling = coupling_of(structure, p, neighbour);
  }
}

}  // namespace sunder::particles
