#include "particles/clusters/decompose.h"

#include <numeric>
#include <stdexcept>

#include "particles/clusters/cells.h"
#include "particles/clusters/influences.h"
#include "particles/clusters/rest_terms.h"
#include "particles/internal/tolerances.h"
#include "tear/internal/surface.h"

namespace sunder::particles {
namespace {

/// All numbers below `count` once, each far from the previous one: steps of about the golden
/// section, offset by a seed.
class ScatteredOrder {
 public:
  ScatteredOrder(Index count, std::uint64_t seed) : count_(count) {
    std::uint64_t mixed = seed + 0x9E37'79B9'7F4A'7C15u;  // splitmix64
    mixed = (mixed ^ (mixed >> 30u)) * 0xBF58'476D'1CE4'E5B9u;
    mixed = (mixed ^ (mixed >> 27u)) * 0x94D0'49BB'1331'11EBu;
    mixed ^= mixed >> 31u;
    at_ = static_cast<Index>(mixed % count);
    step_ = std::max<Index>(
        1,
        static_cast<Index>((0.5 + 0.2 * static_cast<double>(mixed >> 40u) / (1u << 24u)) * count));
    while (std::gcd(step_, count) != 1) ++step_;
  }
  Index next() {
    return std::exchange(at_, static_cast<Index>((std::uint64_t{at_} + step_) % count_));
  }

 private:
  Index count_, at_, step_;
};

/// A membership found by a front.
struct Visit {
  Index point;
  float distance;
};

/// The state of a point while seeds are chosen.
struct Found {
  float nearest;  ///< Distance to the nearest seed.
  Index count;    ///< Of memberships.
};

/// Grows a particle from a seed over the surface, and appends its members to `visits`.
void grow_particle(Index seed, Rings& rings, Structure& structure, std::vector<Visit>& visits,
                   std::vector<Found>& found) {
  if (structure.particles.size() == kMaximumParticles) throw std::length_error("particles");
  const auto range = static_cast<float>(structure.report.range);
  SurfaceFront& front = structure.scratch.front;
  front.begin(structure.points.count(), range, structure.character.edge_length);
  front.add(seed, 0.0f);
  structure.members.decomposed->first.push_back(static_cast<Index>(visits.size()));
  front.run(rings, [&](Index point, float distance, Index) {
    visits.push_back({point, distance});
    Found& of = found[point];
    of.nearest = std::min(of.nearest, distance);
    ++of.count;
    return true;
  });
  Particle& particle = structure.particles.emplace_back();
  particle.serial = structure.next_serial++;
  particle.seed = seed;
  particle.range = range;
  particle.member_count =
      static_cast<Index>(visits.size()) - structure.members.decomposed->first.back();
}

/// Chooses seeds until every point is near one. @return the members of all particles, particle by
/// particle.
std::vector<Visit> take_seeds(const Surface& surface, std::uint64_t seed_of_order,
                              Structure& structure, std::vector<Found>& found) {
  const Index points = structure.points.count();
  const auto range = static_cast<float>(structure.report.range);
  Rings rings(surface, structure.points.positions);
  std::vector<Visit> visits;
  visits.reserve(3 * std::size_t{points});
  // Seeds are first placed outside one another's range, then in the remaining gaps. This takes
  // fewer seeds than placing them at the smaller distance from the beginning.
  for (const float apart : {range, kSeedSpacingReach * range}) {
    ScatteredOrder order(points, seed_of_order);
    for (Index i = 0; i < points; ++i) {
      const Index seed = order.next();
      if (found[seed].nearest <= apart || surface.point_corner[seed] == kNone) continue;
      grow_particle(seed, rings, structure, visits, found);
    }
  }
  structure.members.decomposed->first.push_back(static_cast<Index>(visits.size()));
  structure.members.joined.resize(structure.particles.size());
  return visits;
}

/// Sorts the members of particles into the memberships of points.
void sort_memberships(std::span<const Visit> visits, std::span<const Found> found,
                      Structure& structure) {
  const auto range = static_cast<float>(structure.report.range);
  PointTable& points = structure.points;
  MemberLists::OfDecomposition& members = *structure.members.decomposed;
  members.points.resize(visits.size());
  std::vector<ParticleMembership> memberships(visits.size());
  points.slabs.resize(found.size());
  Index first = 0;
  for (Index p = 0; p < found.size(); ++p) {
    points.slabs[p] = {first, 0};
    first += found[p].count;
  }
  for (Index p = 0; p < structure.particles.size(); ++p)
    for (Index v = members.first[p]; v < members.first[p + 1]; ++v) {
      MembershipSlab& slab = points.slabs[visits[v].point];
      members.points[v] = visits[v].point;
      memberships[slab.first + slab.count++] = {p, visits[v].distance / range};
    }
  points.memberships.set_decomposed(std::move(memberships));
}

/// Computes the rest terms of all particles from their members.
void sum_rest_terms(const TornModel& model, Structure& structure) {
  RestSums sums(model, structure.character.first_slots, structure.points.vertices);
  for (Index p = 0; p < structure.particles.size(); ++p) {
    Particle& particle = structure.particles[p];
    sums.sum(std::span(structure.members.decomposed->points)
                 .subspan(structure.members.decomposed->first[p], particle.member_count),
             particle);
  }
}

}  // namespace

void decompose(const TornModel& model, const DecompositionOptions& options, Structure& structure) {
  const Surface& surface = model.surface();
  const Index points = structure.points.count();
  std::vector<Found> found(points, {2 * static_cast<float>(structure.report.range), 0});
  const std::vector<Visit> visits = take_seeds(surface, options.seed, structure, found);
  sort_memberships(visits, found, structure);
  structure.points.influences.resize(points);
  structure.points.owners.resize(points);
  for (Index p = 0; p < points; ++p) {
    const std::span<const ParticleMembership> memberships = structure.points.memberships_of(p);
    structure.points.influences[p] = influences_from(memberships);
    structure.points.owners[p] = owner_of(memberships, structure.particles);
  }
  sum_rest_terms(model, structure);
  sum_cells(surface, structure);

  DecompositionReport& report = structure.report;
  report.particles = static_cast<Index>(structure.particles.size());
  report.memberships = visits.size();
  for (Index p = 0; p < points; ++p) {
    report.points += surface.point_corner[p] != kNone ? 1 : 0;
    report.covered += found[p].count > 0 ? 1 : 0;
    report.most_memberships = std::max(report.most_memberships, found[p].count);
  }
}

}  // namespace sunder::particles
