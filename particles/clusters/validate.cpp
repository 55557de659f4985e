#include "particles/clusters/validate.h"

#include <algorithm>
#include <functional>
#include <utility>

#include "particles/clusters/band.h"
#include "particles/clusters/check_history.h"
#include "particles/clusters/check_sums.h"
#include "particles/clusters/check_vertex_history.h"
#include "particles/clusters/derive.h"
#include "particles/clusters/lip_spacing.h"
#include "particles/clusters/state_bounds.h"
#include "particles/internal/recorded_limits.h"
#include "tear/internal/operation_counts.h"

namespace sunder::particles {
namespace {

/// The counts of a structure at some time.
struct Counts {
  std::size_t points, particles, lips;
  TableEnds ends;
  std::span<const Index> vertices;
  Index tears;
};

/// Checks the indices of a state, and the range of its numbers. The first fault is kept.
class Check {
 public:
  Check(const Structure& structure, const Structure& decomposition, const TornModel& model)
      : structure_(structure),
        decomposition_(decomposition),
        model_(model),
        bounds_(decomposition, model) {}

  void require(bool holds, const char* what, Index index = kNone) {
    if (!holds && status_)
      status_ = Status::failure(StatusCode::index_out_of_range, index,
                                "a recorded state of particles: %s", what);
  }
  void sizes();
  void counts_of_model();
  void counts(std::span<const Counts> levels);
  void lip_point(const LipPoint& of, const Counts& in);
  void lip_edge(const LipEdge& of, const Counts& in);
  void slab(const MembershipSlab& of, const Counts& in);
  void parents(const ParticleInfluences& of, const Counts& in);
  void particle(Index index, const Particle& of, const Counts& in);
  void particles_now();
  void pending(const PendingWork& of, const Counts& in);
  void point(Index point, const MembershipSlab& slab, const LipPoint& lip);
  void new_points();
  void history(std::vector<Counts> levels);
  void change(const Change& of, Index level);
  void now();
  void memberships_of_last();
  void chain(const LipChain& of, const Counts& in);
  void band(const Counts& in);
  [[nodiscard]] const Status& status() const { return status_; }

 private:
  const Structure &structure_, &decomposition_;
  const TornModel& model_;
  StateBounds bounds_;
  /// The counts before each operation, and now at the end.
  std::vector<Counts> levels_;
  /// Per element the level since which it has the value that is looked at: undo returns to all
  /// levels down to that one before it exchanges the value.
  struct Since {
    std::vector<Index> births;  ///< Of points.
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
              points.lip_points.size() == count,
          "its points have other data than they need");
  require(structure_.particles.size() >= decomposition_.particles.size() &&
              structure_.revision < kMostRecordedNumber &&
              structure_.next_serial < kMostRecordedNumber,
          "the numbers of its particles");
  require(structure_.tears.triangle_count == model_.surface().triangle_count(),
          "it has another number of triangles than the model");
  require(structure_.tears.done.size() == model_.undo_count(),
          "it followed another number of operations than the model has");
  for (std::size_t m = 0; m < structure_.vertex_points.of_mesh.size(); ++m)
    require(
        structure_.vertex_points.of_mesh[m].size() == model_.character().meshes[m].vertex_count(),
        "a mesh has another number of vertices", static_cast<Index>(m));
}

/// Undo must find what the model had.
void Check::counts_of_model() {
  const std::vector<tear::OperationCounts> before = tear::counts_before_operations(model_);
  for (Index i = 0; i < before.size(); ++i) {
    const Change& change = structure_.tears.done[i];
    require(change.points == before[i].points && change.vertices == before[i].vertices,
            "an operation began with other points or vertices than in the model", i);
  }
}

/// The counts before each operation, the first of which began with the decomposition.
void Check::counts(std::span<const Counts> levels) {
  const Counts& first = levels.front();
  require(first.points == decomposition_.points.count() &&
              first.particles == decomposition_.particles.size() && first.lips == 0 &&
              first.ends.memberships == decomposition_.points.memberships.size() &&
              first.ends.older_lips == 0,
          "the first operation did not begin with the decomposition");
  for (std::size_t i = 1; i < levels.size(); ++i) {
    const Counts &of = levels[i], &before = levels[i - 1];
    require(before.points <= of.points && before.particles <= of.particles &&
                before.lips <= of.lips && before.ends.memberships <= of.ends.memberships &&
                before.ends.older_lips <= of.ends.older_lips,
            "the counts before an operation", static_cast<Index>(i));
  }
}

void Check::lip_point(const LipPoint& of, const Counts& in) {
  require(of.tear == kNone || of.tear < in.tears, "the lip of a point");
  require(of.older == kNone || of.older < in.ends.older_lips, "an older lip");
  require(of.edge == kNone || of.edge < in.lips, "the lip edge of a point");
}

void Check::lip_edge(const LipEdge& of, const Counts& in) {
  const auto& [a, b] = of.points;
  require(a < in.points && b < in.points, "the points of a lip");
  if (!status_) return;
  const float length = (structure_.points.positions[b] - structure_.points.positions[a]).norm();
  require(of.inward.norm() <= 1.001f * length, "a lip is longer than between its points");
}

void Check::slab(const MembershipSlab& of, const Counts& in) {
  const MembershipList& memberships = structure_.points.memberships;
  const std::size_t end = std::size_t{of.first} + of.count;
  const bool fits = end <= in.ends.memberships && (of.first >= memberships.decomposed_count() ||
                                                   end <= memberships.decomposed_count());
  require(fits, "memberships of a point");
  if (!fits) return;
  Index next = 0;
  for (const ParticleMembership& membership : memberships.at(of.first, of.count)) {
    require(membership.particle >= next && membership.particle < in.particles &&
                membership.reach >= 0 && membership.reach < 1,
            "a membership of a point");
    next = membership.particle + 1;
  }
}

void Check::parents(const ParticleInfluences& of, const Counts& in) {
  float sum = 0;
  for (std::size_t k = 0; k < 4; ++k) {
    require(of.particles[k] < in.particles && of.weights[k] >= 0, "the parents of a particle");
    sum += of.weights[k];
  }
  require(sum == 0 || std::abs(sum - 1) < 1e-3f, "the parents of a particle add up to something");
}

/// @param index  of the particle, of which there is a state now.
void Check::particle(Index index, const Particle& of, const Counts& in) {
  const CharacterLink& character = structure_.character;
  require(of.seed < in.points && of.revision <= structure_.revision, "the seed of a particle");
  require(of.serial == structure_.particles[index].serial &&
              of.range == structure_.particles[index].range,
          "a particle was another one before");
  for (const RestTerm& term : of.terms)
    require(term.slot < character.first_slots.back(), "a bone of a particle");
  for (const RestMorphTerm& term : of.morph_terms)
    require(term.slot < character.first_slots.back() &&
                term.morph_weight < character.morph_weight_count,
            "a morph target of a particle");
  for (const ParticleNeighbour& neighbour : of.neighbours)
    require(neighbour.particle < in.particles, "a neighbour of a particle");
  for (const Particle::OfTear& side : of.sides)
    require(side.tear < in.tears, "the tear of a particle");
  parents(of.parents, in);
  require(bounds_.fits(of), "a sum of a particle is out of its range", index);
}

void Check::particles_now() {
  std::uint64_t next = 0;
  for (Index p = 0; p < structure_.particles.size(); ++p) {
    const Particle& of = structure_.particles[p];
    require(of.serial >= next && of.serial < structure_.next_serial, "the serial of a particle", p);
    next = of.serial + 1;
    if (p < decomposition_.particles.size())
      require(of.serial == decomposition_.particles[p].serial &&
                  of.range == decomposition_.particles[p].range,
              "a particle of the decomposition is another one", p);
    particle(p, of, levels_[since_.particles[p]]);
  }
}

void Check::pending(const PendingWork& of, const Counts& in) {
  for (const PendingLips& lips : of.lips) require(lips.tear < in.tears, "the tear of lips");
  for (const Index particle : of.to_grow) require(particle < in.particles, "a particle to grow");
}

void Check::point(Index point, const MembershipSlab& of, const LipPoint& lip) {
  const Counts& in = levels_[since_.points[point]];
  slab(of, in);
  lip_point(lip, in);
  const bool is_own = point < decomposition_.points.count() &&
                      of.first == decomposition_.points.slabs[point].first &&
                      of.count == decomposition_.points.slabs[point].count;
  require(of.count == 0 || is_own || of.first >= structure_.points.memberships.decomposed_count(),
          "a point has memberships that the decomposition gave another one", point);
  require(of.count == 0 || structure_.points.vertices[point].vertex != kNone,
          "a point without a vertex belongs to particles", point);
}

/// The places of points that tears made, and the vertices that they had when they came.
void Check::new_points() {
  const PointTable& points = structure_.points;
  for (Index p = decomposition_.points.count(); p < points.count(); ++p) {
    const VertexRef& of = points.vertices[p];
    const Counts& in = levels_[since_.births[p]];
    const bool has_vertex = of.mesh < in.vertices.size() && of.vertex < in.vertices[of.mesh];
    require(has_vertex || (of.vertex == kNone && model_.surface().point_corner[p] == kNone),
            "the vertex of a point", p);
    require(bounds_.is_place(points.positions[p]) || of.vertex == kNone, "the place of a point", p);
  }
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
  since_.births = births(levels_, [](const Counts& of) { return of.points; });
  since_.points = since_.births;
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
  for (std::size_t i = 0; i < of.changed_points.size(); ++i) {
    const Change::OfPoint& changed = of.changed_points[i];
    require(changed.point < in.points, "a changed point", changed.point);
    if (!status_) return;
    point(changed.point, changed.slab, changed.lip);
    since_.points[changed.point] = level + 1;
  }
  for (const auto& [index, before] : of.changed_particles) {
    require(index < in.particles, "a changed particle", index);
    if (!status_) return;
    particle(index, before, levels_[since_.particles[index]]);
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
    lip_edge(lip, levels_[since_.lips[index]]);
    since_.lips[index] = level + 1;
  }
  if (of.pending_before) pending(*of.pending_before, in);
}

/// settle() writes over memberships of the last operation, so each belongs to one point.
void Check::memberships_of_last() {
  if (!status_ || structure_.tears.done.empty()) return;
  const PointTable& points = structure_.points;
  const std::size_t from = structure_.tears.done.back().ends_before.memberships;
  std::vector<std::uint8_t> is_taken(points.memberships.size() - from);
  for (Index p = 0; p < points.count(); ++p) {
    const MembershipSlab& of = points.slabs[p];
    if (of.first < from) continue;
    for (std::size_t i = of.first - from; i < of.first - from + of.count; ++i)
      require(std::exchange(is_taken[i], std::uint8_t{1}) == 0,
              "two points have the same memberships", p);
  }
}

void Check::now() {
  if (!status_) return;
  const PointTable& points = structure_.points;
  for (Index p = 0; p < points.count(); ++p) point(p, points.slabs[p], points.lip_points[p]);
  memberships_of_last();
  new_points();
  for (Index i = 0; i < points.older_lips.size(); ++i)
    require((points.older_lips[i].older == kNone || points.older_lips[i].older < i) &&
                (points.older_lips[i].tear == kNone ||
                 points.older_lips[i].tear < structure_.tears.done.size()),
            "an older lip of a lip");
  particles_now();
  for (Index i = 0; i < structure_.lips.size(); ++i)
    lip_edge(structure_.lips[i], levels_[since_.lips[i]]);
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

void Check::chain(const LipChain& of, const Counts& in) {
  const auto range = static_cast<float>(structure_.report.range);
  const float edge = structure_.character.edge_length;
  require(of.length >= 0 && of.depth == band_depth(range, edge, of.length) &&
              (of.spacing == 0 || of.spacing == lip_spacing(range, edge, of.length)),
          "the depth of a band, or its spacing");
  require(!of.places.empty(), "a lip without points");
  for (const LipChain::End& end : {of.front, of.back})
    require((end.tip == kNone || end.tip < in.points) && end.distance >= 0 &&
                (end.other == kNone || end.other < structure_.tears.band->chains.size()),
            "the end of a lip");
  for (const LipChain::Place& place : of.places)
    require(place.point < in.points && place.along >= 0 && place.to_tip >= 0, "a place on a lip");
  for (const LipChain::OfLip& particle : of.particles)
    require(particle.particle < in.particles &&
                particle.half_width == structure_.particles[particle.particle].range,
            "a particle of a lip");
}

void Check::band(const Counts& in) {
  const Band& of = *structure_.tears.band;
  require(of.tear < in.tears, "the tear of a band");
  require(of.growing == kNone || of.growing < in.particles, "the particle that grows");
  require(of.uncovered == kNone ||
              (of.uncovered < in.points && model_.surface().point_corner[of.uncovered] != kNone),
          "a point that is not covered");
  require(of.met_count <= (of.uncovered == kNone ? 0 : in.points),
          "the points that a front has met");
  for (const Index point : of.lips) require(point < in.points, "a lip of a band");
  for (const Index point : of.unreached) require(point < in.points, "a point to be left");
  if (!status_) return;
  for (const LipChain& each : of.chains) chain(each, in);
  pending(of.pending, in);
  if (!of.is_begun && of.growing == kNone) return;
  structure_.scratch.band_front.for_each_met([&](Index point) {
    require(point < in.points && model_.surface().point_corner[point] != kNone,
            "a point of a front");
  });
}

/// The counts before each operation, and now at the end.
std::vector<Counts> levels_of(const Structure& structure, std::span<const Index> vertices) {
  std::vector<Counts> levels;
  Index tears = 0;
  for (const Change& of : structure.tears.done)
    levels.push_back({of.points, of.particles, of.lips, of.ends_before, of.vertices, tears++});
  levels.push_back({structure.points.count(), structure.particles.size(), structure.lips.size(),
                    structure.points.ends, vertices, tears});
  return levels;
}

}  // namespace

Status validate(Structure& structure, const Structure& decomposition, const TornModel& model) {
  Check check(structure, decomposition, model);
  check.sizes();
  if (!check.status()) return check.status();
  check.counts_of_model();
  if (!check.status()) return check.status();
  std::vector<Index> vertices;
  for (const auto& of_mesh : structure.vertex_points.of_mesh)
    vertices.push_back(static_cast<Index>(of_mesh.size()));
  std::vector<Counts> levels = levels_of(structure, vertices);
  check.counts(levels);
  if (!check.status()) return check.status();
  check.history(std::move(levels));
  if (!check.status()) return check.status();
  derive(structure, decomposition);
  if (Status status = check_history(structure, decomposition); !status) return status;
  if (Status status = check_vertex_history(structure, decomposition, model); !status) return status;
  return check_sums(structure, decomposition, model);
}

}  // namespace sunder::particles
