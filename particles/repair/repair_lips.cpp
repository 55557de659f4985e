// Beside the lips of a tear: which side each particle keeps, and who takes its place at the other.

#include <algorithm>
#include <cmath>
#include <limits>

#include "particles/repair/lip_chains.h"
#include "particles/repair/repair.h"
#include "tear/internal/surface.h"

namespace sunder::particles {
namespace {

/// A lip has a particle of its own wherever none that is left to it is nearer than this, in its range.
constexpr float kLipCovered = 0.8f;

/// Points beside the lips that follow() goes through; settle() does the rest.
constexpr Index kAtOnce = 8;

float length_of(float x, float y) { return std::sqrt(x * x + y * y); }

float smoothstep(float x) {
  x = std::clamp(x, 0.0f, 1.0f);
  return x * x * (3 - 2 * x);
}

}  // namespace

/// A particle stays with the lip that is nearer to its seed.
void Repair::choose_sides() {
  RepairScratch& scratch = structure_.scratch;
  scratch.scored.begin(structure_.particles.size());
  scratch.score_of.resize(std::max(scratch.score_of.size(), structure_.particles.size()));
  struct Score {
    Index particle;
    std::array<float, 2> near = {};
  };
  std::vector<Score> scores;
  const auto look_at = [&](Index point, std::size_t side) {
    for (const ParticleMembership& membership : current(point)) {
      if (scratch.scored.mark(membership.particle)) {
        scratch.score_of[membership.particle] = static_cast<Index>(scores.size());
        scores.push_back({membership.particle});
      }
      float& near = scores[scratch.score_of[membership.particle]].near[side];
      near = std::max(near, 1 - membership.reach);
    }
  };

  for (const Index point : lips_) {
    const auto side = static_cast<std::size_t>(structure_.lip_points[point].side);
    look_at(point, side);
    // The lips are equally near. What is beside them tells on which side the seed is, and knows particles that pass them by.
    const Ring around = ring_(point);
    for (std::size_t i = 0; i < around.size(); ++i)
      if (structure_.lip_points[around.point(i)].tear != tear_) look_at(around.point(i), side);
  }
  for (const Score& score : scores) {
    Particle& particle = structure_.particles[score.particle];
    if (particle.side_of(tear_) != nullptr) continue;
    // The seed itself may stand on a lip.
    const LipPoint& of_seed = structure_.lip_points[particle.seed];
    Side side = score.near[0] >= score.near[1] ? Side::left : Side::right;
    if (of_seed.tear == tear_) side = of_seed.side;
    change_particle(score.particle).sides.push_back({tear_, side});
  }
}

void Repair::begin_band() {
  const auto range = static_cast<float>(structure_.report.range);
  structure_.band = std::make_unique<Band>();
  Band& band = *structure_.band;
  band.tear = tear_;
  band.chains = find_lip_chains(border_, structure_, tear_, lips_, range, structure_.scratch.given, structure_.scratch.seen);
  float deepest = 0;
  for (LipChain& chain : band.chains) {
    chain.depth = std::min(range, std::max(0.5f * chain.length, structure_.edge_length));
    deepest = std::max(deepest, chain.depth);
  }
  structure_.band_front.begin(structure_.point_count(), deepest, structure_.edge_length);
  Index lip_count = 0;
  for (Index c = 0; c < band.chains.size(); ++c) {
    LipChain& chain = band.chains[c];
    make_lip_particles(chain);
    for (Index p = 0; p < chain.places.size(); ++p) {
      const LipChain::Place& place = chain.places[p];
      structure_.beside[place.point] = {c, p};
      structure_.band_front.add(place.point, 0.0f);
      keep_to_own_side(place.point, chain, place, 0.0f);
      join_lip_particles(place.point, chain, place, 0.0f);
      ++lip_count;
    }
  }
  // What a tear without tips may have set free holds together no longer, however far from the lips.
  const bool may_part = std::ranges::any_of(band.chains, [](const LipChain& chain) { return !std::isfinite(chain.length); });
  if (may_part) queue_beside_lips(band);
  cover();
  widen_band(lip_count + kAtOnce);
}

/// The particles that the tear passes, on the lips or beside them.
void Repair::queue_beside_lips(Band& band) {
  for (const Index point : lips_) {
    const Ring around = ring_(point);
    for (std::size_t i = 0; i < around.size(); ++i)
      for (const ParticleMembership& membership : structure_.memberships_of(around.point(i)))
        band.to_grow.push_back(membership.particle);
  }
  std::sort(band.to_grow.begin(), band.to_grow.end());
  band.to_grow.erase(std::unique(band.to_grow.begin(), band.to_grow.end()), band.to_grow.end());
}

/// A bore has no lips: particles that its rim takes a part of are grown anew.
void Repair::begin_hole() {
  auto band = std::make_unique<Band>();
  band->tear = tear_;
  for (Index point = first_new_; point < structure_.point_count(); ++point)
    if (border_.leaving(point) != kNone)
      for (const ParticleMembership& membership : current(point)) band->to_grow.push_back(membership.particle);
  if (band->to_grow.empty()) return;
  std::sort(band->to_grow.begin(), band->to_grow.end());
  band->to_grow.erase(std::unique(band->to_grow.begin(), band->to_grow.end()), band->to_grow.end());
  structure_.band_front.begin(structure_.point_count(), structure_.edge_length,
                              structure_.edge_length);  // of which nothing is left
  structure_.band = std::move(band);
}

void Repair::widen(Index points) {
  if (!structure_.band) return;
  widen_band(points);
  while (structure_.band && structure_.band_front.is_done() && !structure_.band->to_grow.empty() && points > 0) {
    const Index particle = structure_.band->to_grow.back();
    structure_.band->to_grow.pop_back();
    const Index grown = grow(particle);
    points -= std::min(points, grown);
    if (structure_.band->to_grow.empty()) structure_.band.reset();
  }
}

/// Grows a particle from its seed again: what it does not reach any more leaves it. @return how many points it has.
Index Repair::grow(Index particle) {
  const float range = structure_.particles[particle].range;
  const std::vector<Index> members = structure_.members_of(particle);
  Index seed = structure_.particles[particle].seed;
  if (surface_.point_corner[seed] == kNone) {
    // Lost: from what was nearest to it.
    float nearest = std::numeric_limits<float>::infinity();
    for (const Index point : members)
      for (const ParticleMembership& membership : current(point))
        if (membership.particle == particle && membership.reach < nearest && surface_.point_corner[point] != kNone) {
          nearest = membership.reach;
          seed = point;
        }
    change_particle(particle).seed = seed;
  }
  structure_.front.begin(structure_.point_count(), range, structure_.edge_length);
  structure_.front.add(seed, 0.0f);
  structure_.front.run(ring_, [](Index, float, Index) { return true; });
  for (const Index point : members) {
    if (structure_.front.distance(point) < range) continue;  // where it belongs still, as it did
    // What an operation took since, which is to be followed next, it may give back. So it stays a member till then.
    if (surface_.point_corner[point] == kNone) continue;
    left_.push_back(point);
    Work& work = work_of(point);
    const auto kept = std::remove_if(memberships_.begin() + work.first, memberships_.begin() + work.first + work.count,
                                     [&](const ParticleMembership& membership) { return membership.particle == particle; });
    work.count = static_cast<Index>(kept - memberships_.begin()) - work.first;
  }
  for (const Index point : left_) cover(point);
  left_.clear();
  return static_cast<Index>(members.size());
}

void Repair::widen_band(Index points) {
  if (!structure_.band) return;
  structure_.band_front.run(ring_, [&](Index point, float distance, Index from) {
    if (from != kNone) visit_band(point, distance, from);
    return --points > 0;
  });
  if (structure_.band_front.is_done() && structure_.band->to_grow.empty()) structure_.band.reset();
}

void Repair::visit_band(Index point, float distance, Index from) {
  const BesideLip beside = structure_.beside[point] = structure_.beside[from];
  const LipChain& chain = structure_.band->chains[beside.chain];
  if (!(distance < chain.depth)) return;
  keep_to_own_side(point, chain, chain.places[beside.place], distance);
  join_lip_particles(point, chain, chain.places[beside.place], distance);
  cover(point);
}

/// Particles of the other lip end here, as far as the way around the tip is longer than the way through the tear was; on the lip
/// itself in any case.
void Repair::keep_to_own_side(Index point, const LipChain& chain, const LipChain::Place& place, float distance) {
  const auto other_side = [&](const ParticleMembership& membership) {
    const Side* side = structure_.particles[membership.particle].side_of(tear_);
    return side != nullptr && *side != chain.side;
  };
  if (std::ranges::none_of(current(point), other_side)) return;
  Work& work = work_of(point);
  Index kept = 0;
  for (ParticleMembership membership : memberships(work)) {
    if (other_side(membership)) {
      if (!(distance > 0)) continue;
      const float range = structure_.particles[membership.particle].range, to_tip = place.to_tip;
      const float straight = membership.reach * range;
      float around = std::numeric_limits<float>::infinity();
      if (to_tip < 2 * range) around = length_of(to_tip, distance) + length_of(to_tip, std::max(0.0f, straight - distance));
      // Where the band ends sooner than the particle, nothing may jump.
      if (chain.depth < range)
        around = std::min(around, 2 * range) + (straight - std::min(around, 2 * range)) * smoothstep(distance / chain.depth);
      membership.reach = std::max({membership.reach, around / range, 1 - distance / std::min(chain.depth, to_tip)});
      if (!(membership.reach < 1)) continue;
    }
    memberships_[work.first + kept++] = membership;
  }
  work.count = kept;
}

/// What is left to a lip may be too far away, or too large to let it open: then it gets particles of its own.
void Repair::make_lip_particles(LipChain& chain) {
  const auto range = static_cast<float>(structure_.report.range);
  const bool is_short = chain.depth < 0.5f * range;
  const float half_width =
      std::isfinite(chain.length) ? std::min(range, std::max(0.55f * chain.length, structure_.edge_length)) : range;
  const auto is_covered = [&](Index point, float along) {
    for (const LipChain::OfLip& of : chain.particles)
      if (std::abs(along - of.along) < kLipCovered * of.half_width) return true;
    for (const ParticleMembership& membership : current(point)) {
      if (!(membership.reach < kLipCovered)) continue;
      const Side* side = structure_.particles[membership.particle].side_of(tear_);
      if (side != nullptr && *side != chain.side) continue;
      if (!is_short || membership.particle >= change_.particles) return true;
    }
    return false;
  };
  const float end = chain.places.back().along;
  for (std::size_t i = 0; i < chain.places.size(); ++i) {
    if (is_covered(chain.places[i].point, chain.places[i].along)) continue;
    const float wanted = std::min(chain.places[i].along + 0.6f * half_width, 0.5f * (chain.places[i].along + end));
    std::size_t at = i;
    while (at + 1 < chain.places.size() && chain.places[at].along < wanted) ++at;
    const Index seed = chain.places[at].point;
    const Index particle = make_particle(seed, half_width, influences_from(current(seed)));
    structure_.particles[particle].sides.push_back({tear_, chain.side});
    chain.particles.push_back({particle, chain.places[at].along, half_width});
  }
}

void Repair::join_lip_particles(Index point, const LipChain& chain, const LipChain::Place& place, float distance) {
  for (const LipChain::OfLip& of : chain.particles) {
    const float reach = length_of(distance / chain.depth, (place.along - of.along) / of.half_width);
    if (reach < 1 && may_join(point, of.particle)) join(point, {of.particle, reach});
  }
}

/// Keeps a half-edge of a border as an edge of a lip, in place of what was kept of its first point.
void Repair::keep_edge(Index half_edge) {
  const Index a = surface_.corner_point[half_edge], b = surface_.corner_point[Surface::next(half_edge)];
  LipPoint& lip = structure_.lip_points[a];
  if (lip.edge != kNone) {
    if (structure_.lips[lip.edge].points[1] == b) return;
    forget_edge(a);
  }
  log_point(a);
  const Vec3f &at = structure_.positions[a], &to = structure_.positions[b];
  const Vec3f& across = structure_.positions[surface_.corner_point[Surface::previous(half_edge)]];
  const Vec3f edge = to - at;
  const float squared = edge.squaredNorm();
  Vec3f inward = Vec3f::Zero();
  if (squared > 0) inward = (across - at) - (across - at).dot(edge) / squared * edge;
  const float length = inward.norm();
  if (length > 0) inward *= std::sqrt(squared) / length;
  lip.edge = static_cast<Index>(structure_.lips.size());
  structure_.lips.push_back({{a, b}, inward});
}

/// Empties what is kept of the edge that leaves a point.
void Repair::forget_edge(Index point) {
  const Index edge = structure_.lip_points[point].edge;
  if (edge == kNone || structure_.lips[edge].points[0] == structure_.lips[edge].points[1]) return;
  if (edge < change_.lips) change_.changed_lips.emplace_back(edge, structure_.lips[edge]);
  structure_.lips[edge] = {{point, point}, Vec3f::Zero()};
}

void Repair::renew_lip_edges() {
  // A bore's rim is no lip, but new all around.
  const auto is_torn = [&](Index point) { return structure_.lip_points[point].tear != kNone || point >= first_new_; };
  const auto look_at = [&](Index point) {
    const Index leaving = border_.leaving(point), arriving = border_.arriving(point);
    if (leaving == kNone || arriving == kNone) return;
    const Index to = surface_.corner_point[Surface::next(leaving)], from = surface_.corner_point[arriving];
    if (is_torn(point) && is_torn(to)) keep_edge(leaving);
    if ((is_torn(point) && is_torn(from)) || structure_.lip_points[from].edge != kNone) keep_edge(arriving);
    const LipPoint& own = structure_.lip_points[point];
    const Index beyond = own.tear != kNone && !is_torn(to) ? border_.leaving(to) : kNone;  // where the other lip begins
    if (beyond == kNone) return;
    const LipPoint& other = structure_.lip_points[surface_.corner_point[Surface::next(beyond)]];
    if (other.tear != own.tear || other.side == own.side) return;
    keep_edge(leaving);
    keep_edge(beyond);
  };
  for (const Index point : lost_) forget_edge(point);
  for (const Index point : lips_) look_at(point);
  for (Index point = first_new_; point < structure_.point_count(); ++point)
    if (surface_.point_corner[point] != kNone) look_at(point);
}

}  // namespace sunder::particles
