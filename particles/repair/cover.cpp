#include "particles/repair/cover.h"

#include <algorithm>
#include <cstdint>
#include <limits>

#include "particles/clusters/band.h"
#include "particles/internal/tolerances.h"

namespace sunder::particles {
namespace {

/// To meet a point costs a quarter of what it costs to visit one of the band, and to write it back.
constexpr Index kMetPerVisit = 4;

/// The influences of a point before the tear; for a point created by it, those of a neighbour.
ParticleInfluences influences_before(StructureEdit& edit, Index point) {
  const Change& change = edit.change();
  if (point < change.points) {
    for (std::size_t i = 0; i < change.changed_points.size(); ++i)
      if (change.changed_points[i].point == point) return change.changed_points[i].influences;
    return edit.structure().points.influences[point];
  }
  const Ring around = edit.other_ring()(point);
  for (std::size_t i = 0; i < around.size(); ++i)
    if (around.point(i) < change.points) return influences_before(edit, around.point(i));
  return {};
}

/// Begins the front of the particle of a point.
void begin_front_around(Structure& structure, Index point) {
  RepairScratch& scratch = structure.scratch;
  scratch.front.begin(structure.points.count(), static_cast<float>(structure.report.range),
                      structure.character.edge_length);
  scratch.front.add(point, 0.0f);
  scratch.met.clear();
}

/// Continues it until it has met a number of points. @return whether it has met all.
bool go_on_around(StructureEdit& edit, std::uint64_t count) {
  RepairScratch& scratch = edit.structure().scratch;
  if (scratch.met.size() < count)
    scratch.front.run(edit.other_ring(), [&](Index point, float distance, Index) {
      scratch.met.push_back({point, distance});
      return scratch.met.size() < count;
    });
  return scratch.front.is_done();
}

/// Makes a particle of all points that its front has met.
void make_covering_particle(StructureEdit& edit, Index seed) {
  const Structure& structure = edit.structure();
  const auto range = static_cast<float>(structure.report.range);
  const Index particle = edit.make_particle(seed, range, influences_before(edit, seed));
  for (const MetPoint& of : structure.scratch.met)
    if (edit.may_join(of.point, particle)) edit.join(of.point, {particle, of.distance / range});
}

}  // namespace

bool is_covered(const StructureEdit& edit, Index point) {
  if (edit.surface().point_corner[point] == kNone) return true;
  return std::ranges::any_of(edit.memberships(point), [](const ParticleMembership& membership) {
    return membership.reach < kUncoveredReach;
  });
}

void go_on_covering(StructureEdit& edit, Index& points) {
  Structure& structure = edit.structure();
  Band& band = *structure.tears.band;
  std::vector<MetPoint>& met = structure.scratch.met;
  if (is_covered(edit, band.uncovered)) {  // by an operation that came between
    band.uncovered = kNone;
    band.met_count = 0;
    return;
  }
  if (band.met_count == 0 || met.size() != band.met_count) {  // or the memory is that of a copy
    begin_front_around(structure, band.uncovered);
    (void)go_on_around(edit, band.met_count);
  }
  const std::size_t before = met.size();
  const bool is_done = go_on_around(edit, before + std::uint64_t{kMetPerVisit} * points);
  points -= std::min(points, static_cast<Index>((met.size() - before) / kMetPerVisit));
  band.met_count = static_cast<Index>(met.size());
  if (!is_done) return;
  make_covering_particle(edit, band.uncovered);
  points -= std::min(points, band.met_count - band.met_count / kMetPerVisit);
  band.uncovered = kNone;
  band.met_count = 0;
}

Index cover(StructureEdit& edit, Index point) {
  if (is_covered(edit, point)) return 0;
  begin_front_around(edit.structure(), point);
  (void)go_on_around(edit, std::numeric_limits<std::uint64_t>::max());
  make_covering_particle(edit, point);
  return static_cast<Index>(edit.structure().scratch.met.size());
}

void cover_taken_up(StructureEdit& edit) {
  for (std::size_t i = 0; i < edit.taken_up_count(); ++i) (void)cover(edit, edit.taken_up(i));
}

}  // namespace sunder::particles
