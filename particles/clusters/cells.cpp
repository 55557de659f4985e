#include "particles/clusters/cells.h"

#include <bit>

namespace sunder::particles {
namespace {

/// A hash table of the borders of pairs of cells, with linear probing.
class BorderTable {
 public:
  struct Entry {
    std::uint64_t pair =
        kNoPair;  ///< The lower particle in the high bits, the higher one in the low bits.
    Index edges = 0;
    Vec3d across = Vec3d::Zero();  ///< Towards the higher particle.
    Vec3d middles = Vec3d::Zero();
  };

  explicit BorderTable(std::size_t particles) {
    entries_.resize(std::bit_ceil(8 * particles + 16));
  }

  void add(Index p, Index q, const Vec3d& across, const Vec3d& middle) {
    const bool is_ascending = p < q;
    Entry& entry = find(is_ascending ? std::uint64_t{p} << 32u | q : std::uint64_t{q} << 32u | p);
    ++entry.edges;
    if (is_ascending)
      entry.across += across;
    else
      entry.across -= across;
    entry.middles += middle;
    if (entry.edges == 1 && 2 * ++count_ > entries_.size()) grow();
  }

  /// Calls visit(low, high, entry) for all pairs.
  template <class Visit>
  void for_each(Visit visit) const {
    for (const Entry& entry : entries_)
      if (entry.pair != kNoPair)
        visit(static_cast<Index>(entry.pair >> 32u), static_cast<Index>(entry.pair), entry);
  }

 private:
  static constexpr std::uint64_t kNoPair = ~std::uint64_t{0};

  Entry& find(std::uint64_t pair) {
    const std::size_t mask = entries_.size() - 1;
    std::size_t at = static_cast<std::size_t>((pair * 0x9E37'79B9'7F4A'7C15u) >> 32u) & mask;
    while (entries_[at].pair != pair && entries_[at].pair != kNoPair) at = (at + 1) & mask;
    entries_[at].pair = pair;
    return entries_[at];
  }

  void grow() {
    std::vector<Entry> before(2 * entries_.size());
    before.swap(entries_);
    for (const Entry& entry : before)
      if (entry.pair != kNoPair) find(entry.pair) = entry;
  }

  std::vector<Entry> entries_;  ///< A power of two.
  std::size_t count_ = 0;
};

}  // namespace

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
  if (around * around > kBentPath * kBentPath * squared) return norm(neighbour.across) / around;
  return std::max(0.0, dot(neighbour.across, between) / squared);
}

void add_border(Particle& particle, Index other, int sign, const Vec3d& across,
                const Vec3d& middle) {
  auto at = std::ranges::lower_bound(particle.neighbours, other, {}, &ParticleNeighbour::particle);
  if (at == particle.neighbours.end() || at->particle != other) {
    if (sign < 0) return;
    at = particle.neighbours.insert(at, ParticleNeighbour{.particle = other});
  }
  at->edges = static_cast<Index>(std::int64_t{at->edges} + sign);
  at->across += sign * across;
  at->middles += sign * middle;
  if (at->edges == 0) particle.neighbours.erase(at);
}

void sum_cells(const tear::Surface& surface, Structure& structure) {
  BorderTable borders(structure.particles.size());
  for (Index t = 0; t < surface.triangle_count(); ++t) {
    if (!has_cells(surface, t)) continue;
    const std::array<Index, 3> points = points_of(surface, t);
    for_each_cell_part(
        structure.points.positions, points, owners_of(structure, points),
        [&](Index p, double area) { structure.particles[p].area += area; },
        [&](Index p, Index q, const Vec3d& across, const Vec3d& middle) {
          borders.add(p, q, across, middle);
        });
  }
  borders.for_each([&](Index low, Index high, const BorderTable::Entry& of) {
    structure.particles[low].neighbours.push_back({high, of.edges, 0.0, of.across, of.middles});
    structure.particles[high].neighbours.push_back(
        {low, of.edges, 0.0, Vec3d(-of.across), of.middles});
  });
  for (Index p = 0; p < structure.particles.size(); ++p) {
    std::vector<ParticleNeighbour>& neighbours = structure.particles[p].neighbours;
    std::ranges::sort(neighbours, {}, &ParticleNeighbour::particle);
    for (ParticleNeighbour& neighbour : neighbours)
      neighbour.coupling = coupling_of(structure, p, neighbour);
  }
}

}  // namespace sunder::particles
