#include <algorithm>

#include "particles/clusters/describe.h"
#include "tear/internal/surface.h"

namespace sunder::particles {
namespace {

/// The counts of a structure at some time.
struct Counts {
  std::size_t points, particles, lips, memberships;
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
  void change(const Change& of, const Counts& in);
  void now(const Counts& in);
  void band(const Counts& in);
  [[nodiscard]] const Status& status() const { return status_; }

 private:
  const Structure& structure_;
  const TornModel& model_;
  Status status_;
};

void Check::sizes() {
  const PointTable& points = structure_.points;
  const std::size_t count = points.positions.size();
  require(count == model_.point_count(), "it has another number of points than the model");
  require(points.vertices.size() == count && points.slabs.size() == count &&
              points.influences.size() == count && points.lip_points.size() == count,
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
  require(of.older == kNone || of.older < structure_.points.older_lips.size(), "an older lip");
  require(of.edge == kNone || of.edge < in.lips, "the lip edge of a point");
}

void Check::slab(const MembershipSlab& of, const Counts& in) {
  const bool fits = std::size_t{of.first} + of.count <= in.memberships;
  require(fits, "memberships of a point");
  const std::vector<ParticleMembership>& memberships = structure_.points.memberships;
  for (Index i = 0; fits && i < of.count; ++i)
    require(memberships[of.first + i].particle < in.particles, "a membership of a point");
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

void Check::change(const Change& of, const Counts& in) {
  require(of.points == in.points && of.particles == in.particles && of.lips == in.lips &&
              of.memberships_before == in.memberships && of.vertices.size() == in.vertices.size(),
          "the counts before an operation");
  for (const Change::OfPoint& changed : of.changed_points) {
    require(changed.point < in.points, "a changed point", changed.point);
    slab(changed.slab, in);
    influences(changed.influences, in);
    lip_point(changed.lip, in);
  }
  for (const auto& [index, before] : of.changed_particles) {
    require(index < in.particles, "a changed particle", index);
    particle(before, in);
  }
  for (const Change::OfVertex& changed : of.changed_vertices)
    require(changed.mesh < in.vertices.size() && changed.vertex < in.vertices[changed.mesh] &&
                (changed.point == kNone || changed.point < in.points),
            "a changed vertex");
  for (const auto& [index, lip] : of.changed_lips)
    require(index < in.lips && lip.points[0] < in.points && lip.points[1] < in.points,
            "a changed lip");
  if (of.pending_before) pending(*of.pending_before, in);
}

void Check::now(const Counts& in) {
  const PointTable& points = structure_.points;
  for (Index p = 0; p < in.points; ++p) {
    slab(points.slabs[p], in);
    influences(points.influences[p], in);
    lip_point(points.lip_points[p], in);
  }
  for (Index i = 0; i < points.older_lips.size(); ++i)
    require(points.older_lips[i].older == kNone || points.older_lips[i].older < i,
            "an older lip of a lip");
  for (const Particle& of : structure_.particles) particle(of, in);
  for (const LipEdge& lip : structure_.lips)
    require(lip.points[0] < in.points && lip.points[1] < in.points, "a lip");
  for (const std::vector<Index>& of_mesh : structure_.vertex_points.of_mesh)
    for (const Index point : of_mesh)
      require(point == kNone || point < in.points, "the point of a vertex");
  for (const auto& [vertex, shared] : structure_.vertex_points.shared)
    require(vertex.first < in.vertices.size(), "a vertex of several points");
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
    require(chain.depth > 0, "the depth of a band");
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
  const Counts counts{structure.points.count(), structure.particles.size(), structure.lips.size(),
                      structure.points.memberships_end, vertices};
  check.now(counts);
  // The values before each operation must fit the structure to which undo returns.
  Counts later = counts;
  for (auto change = structure.tears.done.rbegin(); change != structure.tears.done.rend();
       ++change) {
    const Counts before{change->points, change->particles, change->lips, change->memberships_before,
                        change->vertices};
    check.require(before.points <= later.points && before.particles <= later.particles &&
                      before.lips <= later.lips && before.memberships <= later.memberships &&
                      std::ranges::equal(before.vertices, later.vertices, std::less_equal<>()),
                  "the counts before an operation");
    check.change(*change, before);
    later = before;
  }
  return check.status();
}

}  // namespace sunder::particles
