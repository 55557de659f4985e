#include "particles/repair/structure_edit.h"

#include <algorithm>
#include <utility>

#include "particles/clusters/cells.h"
#include "particles/clusters/influences.h"
#include "particles/repair/renew_cells.h"

namespace sunder::particles {
namespace {

/// Room for memberships that a point gets during the edit.
constexpr Index kMoreMemberships = 4;

}  // namespace

StructureEdit::StructureEdit(const TornModel& model, Structure& structure, Change& change,
                             Index tear)
    : model_(model),
      surface_(model.surface()),
      structure_(structure),
      change_(change),
      tear_(tear),
      first_new_point_(structure.points.count()),
      border_(model),
      ring_(model.surface(), structure.points.positions),
      other_ring_(model.surface(), structure.points.positions),
      arrays_(std::move(structure.scratch.edit)) {
  arrays_.clear();
  structure.make_room(surface_.point_count());
  structure.scratch.worked.begin(surface_.point_count());
}

StructureEdit::Work& StructureEdit::work_of(Index point) {
  RepairScratch& scratch = structure_.scratch;
  if (scratch.worked.mark(point)) {
    scratch.work_of[point] = static_cast<Index>(arrays_.works.size());
    const auto known = structure_.points.memberships_of(point);
    const auto count = static_cast<Index>(known.size());
    arrays_.works.push_back({point, static_cast<Index>(arrays_.memberships.size()), count,
                             count + kMoreMemberships, structure_.points.owners[point]});
    arrays_.memberships.insert(arrays_.memberships.end(), known.begin(), known.end());
    arrays_.memberships.resize(arrays_.memberships.size() + kMoreMemberships);
  }
  return arrays_.works[scratch.work_of[point]];
}

std::span<const ParticleMembership> StructureEdit::memberships(Index point) const {
  if (!structure_.scratch.worked.has(point)) return structure_.points.memberships_of(point);
  const Work& work = arrays_.works[structure_.scratch.work_of[point]];
  return {arrays_.memberships.data() + work.first, work.count};
}

bool StructureEdit::may_join(Index point, Index particle, Index undecided_tear) {
  bool may = true, has_all = true;
  structure_.points.for_each_lip(point, [&](Index tear, Side side) {
    const Side* known = structure_.particles[particle].side_of(tear);
    may &= known == nullptr || *known == side;
    has_all &= known != nullptr;
  });
  if (!may || has_all) return may;
  structure_.points.for_each_lip(point, [&](Index tear, Side side) {
    if (tear == undecided_tear) return;
    if (structure_.particles[particle].side_of(tear) == nullptr)
      change_particle(particle).sides.push_back({tear, side});
  });
  return true;
}

void StructureEdit::join(Index point, const ParticleMembership& membership) {
  Work& work = work_of(point);
  for (Index i = work.first; i < work.first + work.count; ++i)
    if (arrays_.memberships[i].particle == membership.particle) {
      arrays_.memberships[i].reach = std::min(arrays_.memberships[i].reach, membership.reach);
      return;
    }
  if (work.count == work.room) {
    const Work moved{point, static_cast<Index>(arrays_.memberships.size()), work.count,
                     2 * work.room + 2, work.owner};
    arrays_.memberships.resize(moved.first + moved.room);
    std::copy_n(arrays_.memberships.begin() + work.first, work.count,
                arrays_.memberships.begin() + moved.first);
    work = moved;
  }
  arrays_.memberships[work.first + work.count++] = membership;
}

Particle& StructureEdit::change_particle(Index particle) {
  structure_.scratch.logged_particles.grow(particle + 1);
  if (particle < change_.particles && structure_.scratch.logged_particles.mark(particle))
    change_.changed_particles.emplace_back(particle, structure_.particles[particle]);
  structure_.particles[particle].revision = structure_.revision + 1;
  return structure_.particles[particle];
}

void StructureEdit::move_seed(Index particle, Index seed) {
  change_particle(particle).seed = seed;
  moved_seeds_.push_back(particle);
}

Index StructureEdit::owner_before(Index point) const {
  if (!structure_.scratch.worked.has(point)) return structure_.points.owners[point];
  return arrays_.works[structure_.scratch.work_of[point]].owner;
}

void StructureEdit::log_point(Index point) {
  const PointTable& points = structure_.points;
  if (point < change_.points && structure_.scratch.logged_points.mark(point))
    change_.changed_points.push_back({point, points.slabs[point], points.influences[point],
                                      points.owners[point], points.lip_points[point]});
}

Index StructureEdit::make_particle(Index seed, float range, const ParticleInfluences& parents) {
  const auto index = static_cast<Index>(structure_.particles.size());
  structure_.members.joined.emplace_back();
  Particle& particle = structure_.particles.emplace_back();
  particle.serial = structure_.next_serial++;
  particle.revision = structure_.revision + 1;
  particle.seed = seed;
  particle.range = range;
  particle.parents = parents;
  return index;
}

/// Removes a point from the sums of particles that it left and adds it to those that it joined;
/// both lists ascend.
void StructureEdit::count_members(Index point, std::span<const ParticleMembership> before,
                                  std::span<const ParticleMembership> now) {
  const auto change = [&](Index particle, int sign) {
    Particle& of = change_particle(particle);
    of.member_count = static_cast<Index>(static_cast<std::int64_t>(of.member_count) + sign);
    arrays_.counted.push_back({particle, point, sign});
    if (sign > 0) structure_.members.join(particle, point);
  };
  std::size_t b = 0, n = 0;
  while (b < before.size() || n < now.size()) {
    if (n == now.size() || (b < before.size() && before[b].particle < now[n].particle))
      change(before[b++].particle, -1);
    else if (b == before.size() || now[n].particle < before[b].particle)
      change(now[n++].particle, +1);
    else
      ++b, ++n;
  }
}

/// Brings the terms of particles up to date. Each sums its points in their order in the edit.
void StructureEdit::sum_rests() {
  auto& [works, memberships, counted, by_particle, first] = arrays_;
  if (counted.empty()) return;
  // Sorted by counting, which keeps the order of equal ones.
  first.assign(structure_.particles.size() + 2, 0);
  for (const Counted& of : counted) ++first[of.particle + 2];
  for (std::size_t p = 2; p < first.size(); ++p) first[p] += first[p - 1];
  by_particle.resize(counted.size());
  for (const Counted& of : counted) by_particle[first[of.particle + 1]++] = of;
  RestChange change(model_, structure_.character.first_slots);
  for (auto of = by_particle.begin(); of != by_particle.end();) {
    const Index particle = of->particle;
    change.begin(structure_.particles[particle]);
    for (; of != by_particle.end() && of->particle == particle; ++of)
      change.add(structure_.points.vertices[of->point], of->sign);
    change.finish();
  }
  counted.clear();
}

void StructureEdit::put_back(const Work& work) {
  const std::span<ParticleMembership> now(arrays_.memberships.data() + work.first, work.count);
  const auto by_particle = [](const ParticleMembership& a, const ParticleMembership& b) {
    return a.particle < b.particle;
  };
  if (!std::is_sorted(now.begin(), now.end(), by_particle))
    std::sort(now.begin(), now.end(), by_particle);
  PointTable& points = structure_.points;
  const std::span<const ParticleMembership> before = points.memberships_of(work.point);
  if (std::ranges::equal(before, now, [](const ParticleMembership& a, const ParticleMembership& b) {
        return a.particle == b.particle && a.reach == b.reach;
      }))
    return;
  log_point(work.point);
  count_members(work.point, before, now);
  // Often the particles that join or leave are not among the nearest four.
  const ParticleInfluences influences = influences_from(now);
  if (work.point >= first_new_point_ || influences != points.influences[work.point])
    structure_.dirty.push_back(work.point);
  points.influences[work.point] = influences;
  points.owners[work.point] = owner_of(now, structure_.particles);
  write_memberships(work.point, now);
}

/// Undo needs the memberships before the change, not those of steps in between, which are written
/// over where there is room.
void StructureEdit::write_memberships(Index point, std::span<const ParticleMembership> now) {
  PointTable& points = structure_.points;
  MembershipSlab& slab = points.slabs[point];
  const bool is_of_change = slab.count > 0 && slab.first >= change_.ends_before.memberships;
  if (is_of_change && points.memberships.replace(slab.first, slab.count, now)) {
    slab.count = static_cast<Index>(now.size());
    return;
  }
  const auto first = static_cast<Index>(points.memberships.size());
  points.memberships.append(now, is_of_change ? now.size() / 2 + kMoreMemberships : 0);
  slab = {first, static_cast<Index>(now.size())};
}

void StructureEdit::finish(const RewrittenFaces& rewritten) {
  const MembershipList& memberships = structure_.points.memberships;
  for (const Work& work : arrays_.works) put_back(work);
  sum_rests();
  renew_cells(*this, rewritten);
  PointTable& points = structure_.points;
  change_.ends_after = points.ends = {memberships.size(), points.older_lips.size()};
  ++structure_.revision;
  if (structure_.tears.band) structure_.scratch.edit = std::move(arrays_);
}

}  // namespace sunder::particles
