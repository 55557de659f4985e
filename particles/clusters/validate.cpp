#include <algorithm>
#include <functional>

#include "particles/clusters/describe.h"
#include "tear/internal/surface.h"

namespace sunder::particles {
namespace {

/// The counts of a structure at some time.
struct Counts {
  std::size_t points, particles, lips;
  TableEnds ends;
  std::span<const Index> vertices;
};

/// Checks the indices of a state. The first fault is kept.
class Check {
 public:
  Check(const Structure& structure, const TornModel& model)
      : structure_(structure), model_(model) {}

  void require(bool holds, const char* what, Index index = kNone) {
    if (!holds && status_)
      status_ = Status::failure(StatusCode::index_out_of_range, index,
                                "a recorded state of particles: %s", what);
  }
  void sizes();
  void influences(const ParticleInfluences& of, const Counts& in);
  void lip_point(const LipPoint& of, const Counts& in);
  void slab(const MembershipSlab& of, const Counts& in);
  void particle(const Particle& of, const Counts& in);
  void pending(const PendingWork& of, const Counts& in);
  void point(Index point, const MembershipSlab& slab, const ParticleInfluences& influences,
             Index owner, const LipPoint& lip);
  void history(std::vector<Counts> levels);
  void change(const Change& of, Index level);
  void now();
  void band(const Counts& in);
  [[nodiscard]] const Status& status() const { return status_; }

 private:
  const Structure& structure_;
  const TornModel& model_;
  /// The counts before each operation, and now at the end.
  std::vector<Counts> levels_;
  /// Per element the level since which it has the value that is looked at: undo returns to all
  /// levels down to that one before it exchanges the value.
  struct Since {
    std::vector<Index> points, particles, lips;
    std::vector<std::vector<Index>> vertices;  ///< Per mesh.
  } since_;
  Status status_;
};

void Check::sizes() {
  const PointTable& points = structure_.points;
  const std::size_t count = points.positions.size();
  require(count == model_.point_count(), "it has another number of points than the model");
  require(points.vertices.size() == count && points.slabs.size() == count &&
              points.influences.size() == count && points.owners.size() == count &&
              points.lip_points.size() == count,
          "its points have other data than they need");
  require(structure_.members.joined.size() == structure_.particles.size(),
          "its particles have no members");
  require(structure_.tears.triangle_count == model_.surface().triangle_count(),
          "it has another number of triangles than the model");
  require(structure_.tears.done.size() == model_.undo_count(),
          "it followed another number of operations than the model has");
  for (std::size_t m = 0; m < structure_.vertex_points.of_mesh.size(); ++m)
    require(
        structure_.vertex_points.of_mesh[m].size() == model_.character().meshes[m].vertex_count(),
        "a mesh has another number of vertices", static_cast<Index>(m));
}

void Check::influences(const ParticleInfluences& of, const Counts& in) {
  for (std::size_t k = 0; k < 4; ++k)
    require(of.particles[k] < in.particles && of.weights[k] >= 0, "influences of a point");
}

void Check::lip_point(const LipPoint& of, const Counts& in) {
  require(of.tear == kNone || of.tear < structure_.tears.done.size(), "the lip of a point");
  require(of.older == kNone || of.older < in.ends.older_lips, "an older lip");
  require(of.edge == kNone || of.edge < in.lips, "the lip edge of a point");
}

void Check::slab(const MembershipSlab& of, const Counts& in) {
  const MembershipList& memberships = structure_.points.memberships;
  const std::size_t end = std::size_t{of.first} + of.count;
  const bool fits = end <= in.ends.memberships && (of.first >= memberships.decomposed_count() ||
                                                   end <= memberships.decomposed_count());
  require(fits, "memberships of a point");
  if (!fits) return;
  for (const ParticleMembership& membership : memberships.at(of.first, of.count))
    require(membership.particle < in.particles, "a membership of a point");
}

void Check::particle(const Particle& of, const Counts& in) {
  const CharacterLink& character = structure_.character;
  require(of.seed < in.points && of.range > 0, "the seed of a particle");
  for (const RestTerm& term : of.terms)
    require(term.slot < character.first_slots.back(), "a bone of a particle");
  for (const RestMorphTerm& term : of.morph_terms)
    require(term.slot < character.first_slots.back() &&
                term.morph_weight < character.morph_weight_count,
            "a morph target of a particle");
  for (const ParticleNeighbour& neighbour : of.neighbours)
    require(neighbour.particle < in.particles, "a neighbour of a particle");
}

void Check::pending(const PendingWork& of, const Counts& in) {
  for (const PendingLips& lips : of.lips)
    require(lips.tear < structure_.tears.done.size(), "the tear of lips");
  for (const Index particle : of.to_grow) require(particle < in.particles, "a particle to grow");
}

void Check::point(Index point, const MembershipSlab& of, const ParticleInfluences& by, Index owner,
                  const LipPoint& lip) {
  const Counts& in = levels_[since_.points[point]];
  slab(of, in);
  influences(by, in);
  require(owner == kNone || owner < in.particles, "the cell of a point", point);
  lip_point(lip, in);
}

/// Per element, the first level that has it.
template <class CountOf>
std::vector<Index> births(std::span<const Counts> levels, CountOf count_of) {
  std::vector<Index> births;
  for (Index level = 0; level < levels.size(); ++level)
    births.resize(std::max(births.size(), std::size_t{count_of(levels[level])}), level);
  return births;
}

void Check::history(std::vector<Counts> levels) {
  levels_ = std::move(levels);
  since_.points = births(levels_, [](const Counts& of) { return of.points; });
  since_.particles = births(levels_, [](const Counts& of) { return of.particles; });
  since_.lips = births(levels_, [](const Counts& of) { return of.lips; });
  for (std::size_t m = 0; m < structure_.vertex_points.of_mesh.size(); ++m)
    since_.vertices.push_back(births(levels_, [m](const Counts& of) { return of.vertices[m]; }));
  for (Index level = 0; level + 1 < levels_.size(); ++level)
    change(structure_.tears.done[level], level);
  now();
}

void Check::change(const Change& of, Index level) {
  const Counts& in = levels_[level];
  for (const Change::OfPoint& changed : of.changed_points) {
    require(changed.point < in.points, "a changed point", changed.point);
    if (!status_) return;
    point(changed.point, changed.slab, changed.influences, changed.owner, changed.lip);
    since_.points[changed.point] = level + 1;
  }
  for (const auto& [index, before] : of.changed_particles) {
    require(index < in.particles, "a changed particle", index);
    if (!status_) return;
    particle(before, levels_[since_.particles[index]]);
    since_.particles[index] = level + 1;
  }
  for (const Change::OfVertex& changed : of.changed_vertices) {
    require(changed.mesh < in.vertices.size() && changed.vertex < in.vertices[changed.mesh],
            "a changed vertex");
    if (!status_) return;
    Index& since = since_.vertices[changed.mesh][changed.vertex];
    // Undo ends with the first of several values.
    if (since == level + 1) continue;
    require(changed.point == kNone || changed.point < levels_[since].points,
            "the point of a changed vertex");
    since = level + 1;
  }
  for (const auto& [index, lip] : of.changed_lips) {
    require(index < in.lips, "a changed lip");
    if (!status_) return;
    const std::size_t points = levels_[since_.lips[index]].points;
    require(lip.points[0] < points && lip.points[1] < points, "the points of a changed lip");
    since_.lips[index] = level + 1;
  }
  if (of.pending_before) pending(*of.pending_before, in);
}

void Check::now() {
  if (!status_) return;
  const PointTable& points = structure_.points;
  for (Index p = 0; p < points.count(); ++p)
    point(p, points.slabs[p], points.influences[p], points.owners[p], points.lip_points[p]);
  for (Index i = 0; i < points.older_lips.size(); ++i)
    require((points.older_lips[i].older == kNone || points.older_lips[i].older < i) &&
                (points.older_lips[i].tear == kNone ||
                 points.older_lips[i].tear < structure_.tears.done.size()),
            "an older lip of a lip");
  for (Index p = 0; p < structure_.particles.size(); ++p)
    particle(structure_.particles[p], levels_[since_.particles[p]]);
  for (Index i = 0; i < structure_.lips.size(); ++i) {
    const std::size_t count = levels_[since_.lips[i]].points;
    require(structure_.lips[i].points[0] < count && structure_.lips[i].points[1] < count, "a lip");
  }
  for (std::size_t m = 0; m < since_.vertices.size(); ++m)
    for (Index v = 0; v < since_.vertices[m].size(); ++v) {
      const Index of = structure_.vertex_points.of_mesh[m][v];
      require(of == kNone || of < levels_[since_.vertices[m][v]].points, "the point of a vertex");
    }
  for (const auto& [vertex, shared] : structure_.vertex_points.shared)
    require(vertex.first < since_.vertices.size(), "a vertex of several points");
  const Counts& in = levels_.back();
  if (structure_.tears.waiting) pending(*structure_.tears.waiting, in);
  if (structure_.tears.band) band(in);
}

void Check::band(const Counts& in) {
  const Band& of = *structure_.tears.band;
  require(of.tear < structure_.tears.done.size(), "the tear of a band");
  require(of.growing == kNone || of.growing < in.particles, "the particle that grows");
  for (const Index point : of.lips) require(point < in.points, "a lip of a band");
  for (const Index point : of.unreached) require(point < in.points, "a point to be left");
  for (const LipChain& chain : of.chains) {
    require(chain.depth > 0 && chain.spacing >= 0, "the depth of a band, or its spacing");
    require(!chain.places.empty(), "a lip without points");
    for (const LipChain::End& end : {chain.front, chain.back})
      require((end.tip == kNone || end.tip < in.points) &&
                  (end.other == kNone || end.other < of.chains.size()),
              "the end of a lip");
    for (const LipChain::Place& place : chain.places)
      require(place.point < in.points, "a place on a lip");
    for (const LipChain::OfLip& particle : chain.particles)
      require(particle.particle < in.particles && particle.half_width > 0, "a particle of a lip");
  }
  pending(of.pending, in);
  if (!of.is_begun && of.growing == kNone) return;
  structure_.scratch.band_front.for_each_met([&](Index point) {
    require(point < in.points && model_.surface().point_corner[point] != kNone,
            "a point of a front");
  });
}

}  // namespace

Status validate(const Structure& structure, const TornModel& model) {
  Check check(structure, model);
  check.sizes();
  if (!check.status()) return check.status();
  std::vector<Index> vertices;
  for (const auto& of_mesh : structure.vertex_points.of_mesh)
    vertices.push_back(static_cast<Index>(of_mesh.size()));
  std::vector<Counts> levels;
  for (const Change& of : structure.tears.done)
    levels.push_back({of.points, of.particles, of.lips, of.ends_before, of.vertices});
  levels.push_back({structure.points.count(), structure.particles.size(), structure.lips.size(),
                    structure.points.ends, vertices});
  for (std::size_t i = 0; i < levels.size(); ++i) {
    const Counts& of = levels[i];
    check.require(of.vertices.size() == vertices.size(), "the meshes before an operation");
    if (!check.status()) return check.status();
    if (i == 0) continue;
    const Counts& before = levels[i - 1];
    check.require(before.points <= of.points && before.particles <= of.particles &&
                      before.lips <= of.lips && before.ends.memberships <= of.ends.memberships &&
                      before.ends.older_lips <= of.ends.older_lips &&
                      std::ranges::equal(before.vertices, of.vertices, std::less_equal<>()),
                  "the counts before an operation");
  }
  if (!check.status()) return check.status();
  check.history(std::move(levels));
  return check.status();
}

}  // namespace sunder::particles
