#include "particles/clusters/describe.h"

namespace sunder::particles {
namespace {

void describe(Tape& tape, Index& of) { tape(of); }

void describe(Tape& tape, Particle::OfTear& of) {
  tape(of.tear);
  tape.small(of.side, 2);
}

void describe(Tape& tape, MembershipSlab& of) {
  tape(of.first);
  tape(of.count);
}

void describe(Tape& tape, VertexRef& of) {
  tape(of.mesh);
  tape(of.vertex);
}

void describe(Tape& tape, ParticleMembership& of) {
  tape(of.particle);
  tape(of.reach);
}

void describe(Tape& tape, OnLip& of) {
  tape(of.tear);
  tape.small(of.side, 2);
  tape(of.older);
}

void describe(Tape& tape, RestTerm& of) {
  tape(of.slot);
  tape(of.sum);
}

void describe(Tape& tape, RestMorphTerm& of) {
  tape(of.morph_weight);
  tape(of.slot);
  tape(of.sum);
}

void describe(Tape& tape, ParticleNeighbour& of) {
  tape(of.particle);
  tape(of.edges);
  tape(of.coupling);
  tape(of.across);
  tape(of.middles);
}

/// Influences and owner follow from the memberships; see derive().
void describe(Tape& tape, Change::OfPoint& of) {
  tape(of.point);
  describe(tape, of.slab);
  describe(tape, of.lip);
}

void describe(Tape& tape, Change::OfVertex& of) {
  tape(of.mesh);
  tape(of.vertex);
  tape(of.point);
}

void describe(Tape& tape, LipChain& of) {
  tape.small(of.side, 2);
  tape.any(of.length);
  tape(of.depth);
  tape(of.spacing);
  for (LipChain::End* end : {&of.front, &of.back}) {
    tape(end->tip);
    tape(end->other);
    tape.any(end->distance);
  }
  tape.each(of.places, [&](LipChain::Place& place) {
    tape(place.point);
    tape(place.along);
    tape.any(place.to_tip);
  });
  tape.each(of.particles, [&](LipChain::OfLip& particle) {
    tape(particle.particle);
    tape(particle.along);
    tape(particle.half_width);
    tape(particle.is_small);
  });
}

template <class T>
void describe_each(Tape& tape, std::vector<T>& values) {
  tape.each(values, [&](T& value) { describe(tape, value); });
}

/// Describes work that may be absent.
void describe(Tape& tape, std::shared_ptr<const PendingWork>& of) {
  bool has = of != nullptr;
  tape(has);
  if (!has) return;
  PendingWork work = of ? *of : PendingWork();
  describe(tape, work);
  if (tape.is_reading()) of = std::make_shared<const PendingWork>(std::move(work));
}

bool are_same(const LipPoint& a, const LipPoint& b) {
  return a.tear == b.tear && a.side == b.side && a.older == b.older && a.edge == b.edge;
}
bool are_same(const MembershipSlab& a, const MembershipSlab& b) {
  return a.first == b.first && a.count == b.count;
}
bool are_same(Index a, Index b) { return a == b; }

/// Describes an array by the entries that differ from an older one, and those that follow it.
/// @param now  while reading, like `before`.
template <class T>
void describe_changed(Tape& tape, std::vector<T>& now, const std::vector<T>& before) {
  std::vector<Index> changed;
  for (Index i = 0; !tape.is_reading() && i < before.size(); ++i)
    if (!are_same(now[i], before[i])) changed.push_back(i);
  tape.all(changed);
  for (const Index i : changed) {
    tape.require(i < before.size(), "an entry of the decomposition does not exist");
    if (i < before.size()) describe(tape, now[i]);
  }
  tape.each(
      now, [&](T& value) { describe(tape, value); }, before.size());
}

void describe_points(Tape& tape, PointTable& of, const PointTable& before) {
  // Of these two only the entries of new points are anything new.
  tape.each(
      of.positions, [&](Vec3f& at) { tape(at); }, before.positions.size());
  tape.each(
      of.vertices, [&](VertexRef& at) { describe(tape, at); }, before.vertices.size());
  describe_changed(tape, of.slabs, before.slabs);
  describe_changed(tape, of.lip_points, before.lip_points);
  // Those after the end are of operations that were undone.
  std::vector<ParticleMembership> more = of.memberships.appended(of.ends.memberships);
  describe_each(tape, more);
  if (tape.is_reading()) of.memberships.set_appended(std::move(more));
  std::vector<OnLip> older(of.older_lips.begin(),
                           of.older_lips.begin() + static_cast<std::ptrdiff_t>(of.ends.older_lips));
  describe_each(tape, older);
  if (!tape.is_reading()) return;
  of.older_lips = std::move(older);
  of.ends = {of.memberships.size(), of.older_lips.size()};
}

void describe_vertex_points(Tape& tape, VertexPoints& of, const VertexPoints& before) {
  for (std::size_t m = 0; m < of.of_mesh.size(); ++m)
    describe_changed(tape, of.of_mesh[m], before.of_mesh[m]);
  struct Shared {
    Index mesh = 0, vertex = 0;
    std::vector<Index> points;
  };
  std::vector<Shared> shared;
  for (const auto& [vertex, points] : of.shared)
    shared.push_back({vertex.first, vertex.second, points});
  tape.each(shared, [&](Shared& each) {
    tape(each.mesh);
    tape(each.vertex);
    tape.all(each.points);
  });
  if (!tape.is_reading()) return;
  of.shared.clear();
  for (Shared& each : shared) of.shared[{each.mesh, each.vertex}] = std::move(each.points);
}

/// Describes the front of a band in progress. Points that it has not met are unknown.
void describe_front(Tape& tape, RepairScratch& of, const Band& band, Index points) {
  bool is_used = (band.is_begun && !of.band_front.is_done()) || band.growing != kNone;
  tape(is_used);
  if (!is_used) return;
  of.band_front.describe(tape, points);
  of.band_front.for_each_met([&](Index point) {
    tape(of.beside[point].chain);
    tape(of.beside[point].place);
  });
  if (!tape.is_reading() || band.growing != kNone) return;
  // Points beside a lip are found from those that the front has visited, and where it starts. The
  // others have what an earlier band left there.
  const auto check = [&](Index point) {
    const BesideLip beside = of.beside[point];
    tape.require(
        beside.chain < band.chains.size() && beside.place < band.chains[beside.chain].places.size(),
        "a point is beside a chain that does not exist");
  };
  of.band_front.for_each_start(check);
  of.band_front.for_each_met([&](Index point) {
    if (of.band_front.has_visited(point)) check(point);
  });
}

void describe_tears(Tape& tape, Structure& of) {
  if (tape.is_reading()) of.scratch.make_room(of.points.count());
  std::vector<Change>& done = of.tears.done;
  describe_each(tape, done);
  if (tape.is_reading())
    for (std::size_t i = 0; i < done.size(); ++i)
      done[i].ends_after = i + 1 < done.size() ? done[i + 1].ends_before : of.points.ends;
  tape(of.tears.triangle_count);
  describe(tape, of.tears.waiting);
  bool has_band = of.tears.band != nullptr;
  tape(has_band);
  if (!has_band) return;
  if (tape.is_reading()) of.tears.band = std::make_unique<Band>();
  describe(tape, *of.tears.band);
  describe_front(tape, of.scratch, *of.tears.band, of.points.count());
}

}  // namespace

void describe(Tape& tape, ParticleInfluences& of) {
  for (Index& particle : of.particles) tape(particle);
  for (float& weight : of.weights) tape(weight);
}

void describe(Tape& tape, LipPoint& of) {
  describe(tape, static_cast<OnLip&>(of));
  tape(of.edge);
}

void describe(Tape& tape, LipEdge& of) {
  for (Index& point : of.points) tape(point);
  tape(of.inward);
}

void describe(Tape& tape, Particle& of) {
  tape(of.serial);
  tape(of.revision);
  tape(of.seed);
  tape(of.range);
  tape(of.member_count);
  tape(of.area);
  describe_each(tape, of.terms);
  describe_each(tape, of.morph_terms);
  describe_each(tape, of.neighbours);
  describe(tape, of.parents);
  describe_each(tape, of.sides);
}

void describe(Tape& tape, PendingWork& of) {
  tape.each(of.lips, [&](PendingLips& lips) {
    tape(lips.tear);
    tape.all(lips.points);
  });
  tape.all(of.to_grow);
}

void describe(Tape& tape, TableEnds& of) {
  std::uint64_t memberships = of.memberships, older_lips = of.older_lips;
  tape(memberships);
  tape(older_lips);
  of = {static_cast<std::size_t>(memberships), static_cast<std::size_t>(older_lips)};
}

void describe(Tape& tape, Change& of) {
  tape(of.points);
  tape(of.particles);
  tape(of.lips);
  describe(tape, of.ends_before);
  tape.all(of.vertices);
  std::vector<Change::OfPoint> changed_points;
  of.changed_points.for_each(
      [&](const Change::OfPoint& point) { changed_points.push_back(point); });
  describe_each(tape, changed_points);
  if (tape.is_reading()) of.changed_points.assign(changed_points);
  tape.each(of.changed_particles, [&](std::pair<Index, Particle>& changed) {
    tape(changed.first);
    describe(tape, changed.second);
  });
  describe_each(tape, of.changed_vertices);
  tape.each(of.changed_lips, [&](std::pair<Index, LipEdge>& changed) {
    tape(changed.first);
    describe(tape, changed.second);
  });
  describe(tape, of.pending_before);
}

void describe(Tape& tape, Band& of) {
  tape(of.tear);
  tape.all(of.lips);
  tape(of.is_begun);
  tape(of.is_final);
  describe_each(tape, of.chains);
  tape(of.growing);
  tape.all(of.unreached);
  tape(of.is_grown);
  tape(of.uncovered);
  tape(of.met_count);
  describe(tape, of.pending);
}

void describe(Tape& tape, Structure& of, const Structure& decomposition) {
  tape(of.revision);
  tape(of.next_serial);
  describe_points(tape, of.points, decomposition.points);
  describe_vertex_points(tape, of.vertex_points, decomposition.vertex_points);
  describe_each(tape, of.particles);
  describe_each(tape, of.lips);
  describe_tears(tape, of);
}

}  // namespace sunder::particles
