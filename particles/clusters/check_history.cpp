#include "particles/clusters/check_history.h"

#include <algorithm>
#include <utility>

namespace sunder::particles {
namespace {

template <class T, class Same>
bool are_same(const std::vector<T>& a, const std::vector<T>& b, Same is_same) {
  return std::ranges::equal(a, b, is_same);
}

/// Whether a particle is as the decomposition made it.
bool are_same(const Particle& a, const Particle& b) {
  const auto is_same_term = [](const RestTerm& x, const RestTerm& y) {
    return x.slot == y.slot && x.sum == y.sum;
  };
  const auto is_same_morph = [](const RestMorphTerm& x, const RestMorphTerm& y) {
    return x.slot == y.slot && x.morph_weight == y.morph_weight && x.sum == y.sum;
  };
  const auto is_same_neighbour = [](const ParticleNeighbour& x, const ParticleNeighbour& y) {
    return x.particle == y.particle && x.edges == y.edges && x.coupling == y.coupling &&
           x.across == y.across && x.middles == y.middles;
  };
  return a.seed == b.seed && a.member_count == b.member_count && a.area == b.area &&
         a.sides.empty() && a.parents == b.parents && are_same(a.terms, b.terms, is_same_term) &&
         are_same(a.morph_terms, b.morph_terms, is_same_morph) &&
         are_same(a.neighbours, b.neighbours, is_same_neighbour);
}

/// A structure while its operations are undone.
class UndoneStructure {
 public:
  explicit UndoneStructure(const Structure& structure)
      : structure_(structure),
        slabs_(structure.points.slabs),
        lips_(structure.points.lip_points),
        counts_(structure.particles.size(), 0),
        is_changed_(structure.particles.size(), 0),
        is_touched_(structure.particles.size(), 0) {
    for (const Particle& particle : structure.particles) particles_.push_back(&particle);
    for (const MembershipSlab& slab : slabs_)
      for_each_particle(slab, [&](Index particle) { ++counts_[particle]; });
  }

  /// Checks all particles as they are now.
  [[nodiscard]] bool are_sound() const {
    for (Index p = 0; p < particles_.size(); ++p)
      if (!has_count(p) || !are_mutual(p)) return false;
    return true;
  }
  /// Undoes an operation, and checks the particles that it changed. The others were checked, and
  /// lost no neighbour unless that one changed too.
  [[nodiscard]] bool undo(const Change& change) {
    for (std::size_t point = change.points; point < slabs_.size(); ++point)
      count(slabs_[point], -1);
    slabs_.resize(change.points);
    lips_.resize(change.points);
    for (std::size_t i = change.changed_points.size(); i-- > 0;) {
      const Change::OfPoint& of = change.changed_points[i];
      count(slabs_[of.point], -1);
      slabs_[of.point] = of.slab;
      lips_[of.point] = of.lip;
      count(of.slab, 1);
    }
    std::vector<std::pair<Index, const Particle*>> newer;
    for (auto of = change.changed_particles.rbegin(); of != change.changed_particles.rend(); ++of) {
      if (is_changed_[of->first] == 0) newer.emplace_back(of->first, particles_[of->first]);
      is_changed_[of->first] = 1;
      particles_[of->first] = &of->second;
    }
    for (const Index p : touched_) {
      is_touched_[p] = 0;
      if (p < change.particles && !has_count(p)) return false;
    }
    touched_.clear();
    const bool is_sound = std::ranges::all_of(newer, [&](const auto& of) {
      return of.first < change.particles && has_count(of.first) && are_mutual(of.first) &&
             keeps_neighbours(of.first, *of.second, change.particles);
    });
    for (const auto& [p, particle] : newer) is_changed_[p] = 0;
    particles_.resize(change.particles);
    return is_sound;
  }

  /// Whether nothing is left but the decomposition.
  [[nodiscard]] bool is(const Structure& decomposition) const {
    const auto is_same_slab = [](const MembershipSlab& a, const MembershipSlab& b) {
      return a.first == b.first && a.count == b.count;
    };
    const auto is_same_particle = [](const Particle* a, const Particle& b) {
      return are_same(*a, b);
    };
    return are_same(slabs_, decomposition.points.slabs, is_same_slab) &&
           std::ranges::equal(particles_, decomposition.particles, is_same_particle) &&
           std::ranges::all_of(
               lips_, [](const LipPoint& lip) { return lip.tear == kNone && lip.edge == kNone; });
  }

 private:
  template <class Visit>
  void for_each_particle(const MembershipSlab& slab, Visit visit) const {
    for (const ParticleMembership& of : structure_.points.memberships.at(slab.first, slab.count))
      visit(of.particle);
  }
  void count(const MembershipSlab& slab, int sign) {
    for_each_particle(slab, [&](Index particle) {
      counts_[particle] += sign;
      if (std::exchange(is_touched_[particle], std::uint8_t{1}) == 0) touched_.push_back(particle);
    });
  }
  [[nodiscard]] bool has_count(Index p) const {
    return counts_[p] == std::int64_t{particles_[p]->member_count};
  }
  [[nodiscard]] const ParticleNeighbour* find(Index particle, Index other) const {
    const std::vector<ParticleNeighbour>& of = particles_[particle]->neighbours;
    const auto at = std::ranges::lower_bound(of, other, {}, &ParticleNeighbour::particle);
    return at != of.end() && at->particle == other ? &*at : nullptr;
  }
  /// Whether the neighbours of a particle have the same border with it.
  [[nodiscard]] bool are_mutual(Index p) const {
    return std::ranges::all_of(particles_[p]->neighbours, [&](const ParticleNeighbour& of) {
      const ParticleNeighbour* const back = of.particle != p ? find(of.particle, p) : nullptr;
      return back != nullptr && back->edges == of.edges && back->coupling == of.coupling &&
             back->across == -of.across && back->middles == of.middles;
    });
  }
  /// Whether a particle was a neighbour of those of its later neighbours that did not change.
  /// @param count  of particles.
  [[nodiscard]] bool keeps_neighbours(Index p, const Particle& newer, Index count) const {
    return std::ranges::all_of(newer.neighbours, [&](const ParticleNeighbour& of) {
      return of.particle >= count || is_changed_[of.particle] != 0 ||
             find(p, of.particle) != nullptr;
    });
  }

  const Structure& structure_;
  std::vector<MembershipSlab> slabs_;
  std::vector<LipPoint> lips_;
  std::vector<const Particle*> particles_;
  std::vector<std::int64_t> counts_;      ///< Of members.
  std::vector<std::uint8_t> is_changed_;  ///< By the operation that is being undone.
  std::vector<std::uint8_t> is_touched_;  ///< Whether `touched_` lists it.
  std::vector<Index> touched_;            ///< Particles that were counted since the last check.
};

}  // namespace

Status check_history(const Structure& structure, const Structure& decomposition) {
  UndoneStructure undone(structure);
  if (!undone.are_sound())
    return Status::failure(StatusCode::invalid_argument, kNone,
                           "a recorded state of particles: members or neighbours of particles do "
                           "not agree");
  const std::vector<Change>& done = structure.tears.done;
  for (std::size_t i = done.size(); i-- > 0;)
    if (!undone.undo(done[i]))
      return Status::failure(StatusCode::invalid_argument, static_cast<Index>(i),
                             "a recorded state of particles: members or neighbours of particles do "
                             "not agree before operation %zu",
                             i);
  if (undone.is(decomposition)) return {};
  return Status::failure(StatusCode::invalid_argument, 0,
                         "a recorded state of particles: before the first operation it is not the "
                         "decomposition");
}

}  // namespace sunder::particles
