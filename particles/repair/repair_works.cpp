// Points and particles that a repair changes.

#include <algorithm>

#include "particles/clusters/pair_changes.h"
#include "particles/repair/repair.h"

namespace sunder::particles {

Repair::Work& Repair::work_of(Index point) {
  RepairScratch& scratch = structure_.scratch;
  if (scratch.worked.mark(point)) {
    scratch.work_of[point] = static_cast<Index>(works_.size());
    const auto known = structure_.memberships_of(point);
    const auto count = static_cast<Index>(known.size());
    works_.push_back({point, static_cast<Index>(memberships_.size()), count, count + 4});
    memberships_.insert(memberships_.end(), known.begin(), known.end());
    memberships_.resize(memberships_.size() + 4);
  }
  return works_[scratch.work_of[point]];
}

std::span<const ParticleMembership> Repair::current(Index point) {
  if (!structure_.scratch.worked.has(point)) return structure_.memberships_of(point);
  return memberships(works_[structure_.scratch.work_of[point]]);
}

bool Repair::may_join(Index point, Index particle) {
  bool may = true, has_all = true;
  structure_.for_each_lip(point, [&](Index tear, Side side) {
    const Side* known = structure_.particles[particle].side_of(tear);
    may &= known == nullptr || *known == side;
    has_all &= known != nullptr;
  });
  if (!may || has_all) return may;
  structure_.for_each_lip(point, [&](Index tear, Side side) {
    if (is_before_sides_ && tear == tear_) return;
    if (structure_.particles[particle].side_of(tear) == nullptr) change_particle(particle).sides.push_back({tear, side});
  });
  return true;
}

void Repair::join(Index point, const ParticleMembership& membership) {
  Work& work = work_of(point);
  for (ParticleMembership& known : memberships(work))
    if (known.particle == membership.particle) {
      known.reach = std::min(known.reach, membership.reach);
      return;
    }
  if (work.count == work.room) {
    const Work moved{point, static_cast<Index>(memberships_.size()), work.count, 2 * work.room + 2};
    memberships_.resize(moved.first + moved.room);
    std::copy_n(memberships_.begin() + work.first, work.count, memberships_.begin() + moved.first);
    work = moved;
  }
  memberships_[work.first + work.count++] = membership;
}

Particle& Repair::change_particle(Index particle) {
  structure_.scratch.logged_particles.grow(particle + 1);
  if (particle < change_.particles && structure_.scratch.logged_particles.mark(particle))
    change_.changed_particles.emplace_back(particle, structure_.particles[particle]);
  return structure_.particles[particle];
}

void Repair::log_point(Index point) {
  if (point < change_.points && structure_.scratch.logged_points.mark(point))
    change_.changed_points.push_back({point, structure_.slabs[point], structure_.influences[point], structure_.lip_points[point]});
}

Index Repair::make_particle(Index seed, float range, const ParticleInfluences& parents) {
  const auto index = static_cast<Index>(structure_.particles.size());
  Particle& particle = structure_.particles.emplace_back();
  particle.serial = structure_.next_serial++;
  particle.seed = seed;
  particle.range = range;
  particle.parents = parents;
  structure_.joined.emplace_back();
  return index;
}

void Repair::put_back(const Work& work) {
  const std::span<ParticleMembership> now = memberships(work);
  const auto by_particle = [](const ParticleMembership& a, const ParticleMembership& b) { return a.particle < b.particle; };
  if (!std::is_sorted(now.begin(), now.end(), by_particle)) std::sort(now.begin(), now.end(), by_particle);
  const std::span<const ParticleMembership> before = structure_.memberships_of(work.point);
  if (std::ranges::equal(before, now, [](const ParticleMembership& a, const ParticleMembership& b) {
        return a.particle == b.particle && a.reach == b.reach;
      }))
    return;
  log_point(work.point);
  // Who left and who joined: both lists ascend.
  bool has_rest = false;
  const auto change = [&](Index particle, int sign) {
    Particle& of = change_particle(particle);
    of.member_count = static_cast<Index>(static_cast<std::int64_t>(of.member_count) + sign);
    if (!has_rest) rest_.set(model_, structure_, structure_.vertices[work.point]);
    has_rest = true;
    rest_.add_to(of, sign);
    if (sign > 0) structure_.joined[particle].push_back(work.point);
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
  const ParticleInfluences influences = influences_from(now);
  if (influences != structure_.influences[work.point]) {
    const auto changing = [&](Index particle) -> Particle& { return change_particle(particle); };
    structure_.pairs->add(structure_.influences[work.point], -1, changing);
    structure_.pairs->add(influences, +1, changing);
    structure_.influences[work.point] = influences;
  }
  structure_.slabs[work.point] = {static_cast<Index>(structure_.memberships.size()), static_cast<Index>(now.size())};
  structure_.memberships.insert(structure_.memberships.end(), now.begin(), now.end());
}

void Repair::finish() {
  auto& memberships = structure_.memberships;
  if (memberships.capacity() < memberships.size() + memberships_.size())
    memberships.reserve(memberships.size() + memberships_.size() + memberships.size() / 8);
  for (const Work& work : works_) put_back(work);
  structure_.pairs->apply([&](Index particle) -> Particle& { return change_particle(particle); });
  change_.memberships_after = structure_.memberships_end = structure_.memberships.size();
  for (const Work& work : works_) structure_.dirty.push_back(work.point);
  ++structure_.revision;
}

}  // namespace sunder::particles
