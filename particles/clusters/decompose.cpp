#include "particles/clusters/decompose.h"

#include <numeric>
#include <stdexcept>

#include "particles/clusters/pair_sums.h"
#include "particles/clusters/rest_terms.h"
#include "tear/internal/surface.h"

namespace sunder::particles {
namespace {

/// All numbers below `count` once, far apart in turn: steps of about the golden section, which a seed shifts.
class ScatteredOrder {
 public:
  ScatteredOrder(Index count, std::uint64_t seed) : count_(count) {
    std::uint64_t mixed = seed + 0x9E37'79B9'7F4A'7C15u;  // splitmix64
    mixed = (mixed ^ (mixed >> 30u)) * 0xBF58'476D'1CE4'E5B9u;
    mixed = (mixed ^ (mixed >> 27u)) * 0x94D0'49BB'1331'11EBu;
    mixed ^= mixed >> 31u;
    at_ = static_cast<Index>(mixed % count);
    step_ = std::max<Index>(1, static_cast<Index>((0.5 + 0.2 * static_cast<double>(mixed >> 40u) / (1u << 24u)) * count));
    while (std::gcd(step_, count) != 1) ++step_;
  }
  Index next() { return std::exchange(at_, static_cast<Index>((std::uint64_t{at_} + step_) % count_)); }

 private:
  Index count_, at_, step_;
};

struct Visit {
  Index point;
  float distance;
};

}  // namespace

void decompose(const TornModel& model, const DecompositionOptions& options, Structure& structure) {
  const Surface& surface = model.surface();
  const Index points = structure.point_count();
  const auto range = static_cast<float>(structure.report.range);

  Rings rings(surface, structure.positions);
  std::vector<Visit> visits;
  visits.reserve(3 * std::size_t{points});
  struct Found {
    float nearest;  // distance to a seed
    Index count;    // of memberships
  };
  std::vector<Found> found(points, {2 * range, 0});
  // Seeds first stand out of one another's range, then in what gaps that leaves: fewer are needed than if they were as near from
  // the beginning.
  for (const float apart : {range, kCovers * range}) {
    ScatteredOrder order(points, options.seed);
    for (Index i = 0; i < points; ++i) {
      const Index seed = order.next();
      if (found[seed].nearest <= apart || surface.point_corner[seed] == kNone) continue;
      if (structure.particles.size() == kMaximumParticles) throw std::length_error("particles");
      structure.front.begin(points, range, structure.edge_length);
      structure.front.add(seed, 0.0f);
      structure.first_member.push_back(static_cast<Index>(visits.size()));
      structure.front.run(rings, [&](Index point, float distance, Index) {
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
      particle.member_count = static_cast<Index>(visits.size()) - structure.first_member.back();
    }
  }
  structure.first_member.push_back(static_cast<Index>(visits.size()));
  structure.joined.resize(structure.particles.size());

  structure.members.resize(visits.size());
  structure.memberships.resize(visits.size());
  structure.slabs.resize(points);
  Index first = 0;
  for (Index p = 0; p < points; ++p) {
    structure.slabs[p] = {first, 0};
    first += found[p].count;
  }
  for (Index p = 0; p < structure.particles.size(); ++p)
    for (Index v = structure.first_member[p]; v < structure.first_member[p + 1]; ++v) {
      Structure::Slab& slab = structure.slabs[visits[v].point];
      structure.members[v] = visits[v].point;
      structure.memberships[slab.first + slab.count++] = {p, visits[v].distance / range};
    }

  structure.influences.resize(points);
  for (Index p = 0; p < points; ++p) structure.influences[p] = influences_from(structure.memberships_of(p));
  RestSums sums(model, structure);
  for (Index p = 0; p < structure.particles.size(); ++p) {
    const auto members = std::span(structure.members).subspan(structure.first_member[p], structure.particles[p].member_count);
    sums.sum(members, structure.particles[p]);
  }
  sum_pairs(structure);

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
