#include "particles/repair/repair.h"

#include <algorithm>
#include <cmath>

#include "particles/clusters/decompose.h"
#include "tear/internal/surface.h"

namespace sunder::particles {
namespace {

/// A point with no particle nearer than this, in its range, gets one of its own: what moves it would fade where it stands.
constexpr float kUncovered = 0.97f;

}  // namespace

Repair::Repair(const TornModel& model, Structure& structure, Change& change, Index tear)
    : model_(model),
      surface_(model.surface()),
      structure_(structure),
      change_(change),
      tear_(tear),
      first_new_(structure.point_count()),
      border_(model),
      ring_(model.surface(), structure.positions),
      other_ring_(model.surface(), structure.positions) {
  structure.make_room(surface_.point_count());
  structure.scratch.worked.begin(surface_.point_count());
}

void Repair::follow(std::span<const ChangeRecord> changes) {
  append_points();
  renew_weights(changes);
  leave_lost_points(changes);
  renew_vertex_points(changes);
  take_up_lips(changes);
  is_before_sides_ = !lips_.empty();
  spread_to_new_points();
  is_before_sides_ = false;
  if (!lips_.empty()) {
    choose_sides();
    begin_band();
  } else {
    cover();
    if (!lost_.empty()) begin_hole();
  }
  renew_lip_edges();
}

void Repair::append_points() {
  const Character& character = model_.character();
  for (Index point = first_new_; point < surface_.point_count(); ++point) {
    const VertexRef of = vertex_of(model_, point);
    structure_.vertices.push_back(of);
    structure_.positions.push_back(of.vertex == kNone ? Vec3f(Vec3f::Zero())
                                                      : structure_.posed_points.at(character.meshes[of.mesh], of.vertex));
    structure_.slabs.emplace_back();
    structure_.influences.emplace_back();
    structure_.lip_points.emplace_back();
  }
  for (Index m = 0; m < character.meshes.size(); ++m) structure_.vertex_points[m].resize(character.meshes[m].vertex_count(), kNone);
}

void Repair::set_vertex_point(Index mesh, Index vertex, Index point) {
  Index& known = structure_.vertex_points[mesh][vertex];
  if (vertex < change_.vertices[mesh]) change_.changed_vertices.push_back({mesh, vertex, known});
  known = point;
}

/// Whether a face around a point has it in a vertex.
bool Repair::has_vertex(Index point, Index mesh, Index vertex) const {
  if (point >= surface_.point_count() || surface_.point_corner[point] == kNone) return false;
  bool has = false;
  surface_.for_each_in_fan(surface_.point_corner[point], [&](Index corner) {
    const tear::TriangleRef ref = surface_.triangle(corner / 3);
    has |= ref.mesh == mesh && model_.character().meshes[mesh].triangles[ref.triangle][corner % 3] == vertex;
  });
  return has;
}

void Repair::renew_vertex_points(std::span<const ChangeRecord> changes) {
  const auto renew = [&](Index corner) {
    const tear::TriangleRef ref = surface_.triangle(corner / 3);
    const Index vertex = model_.character().meshes[ref.mesh].triangles[ref.triangle][corner % 3];
    const Index known = structure_.vertex_points[ref.mesh][vertex], now = surface_.corner_point[corner];
    if (known == now) return;
    if (known != kNone && has_vertex(known, ref.mesh, vertex)) structure_.share_vertex(ref.mesh, vertex, known, now);
    set_vertex_point(ref.mesh, vertex, now);
  };
  // Vertices are new, or go along with a point that is.
  for (Index point = first_new_; point < structure_.point_count(); ++point)
    if (surface_.point_corner[point] != kNone) surface_.for_each_in_fan(surface_.point_corner[point], renew);
  for (Index corner = 3 * structure_.triangle_count; corner < surface_.corner_point.size(); ++corner)
    if (!surface_.has_repeated_point(corner / 3)) renew(corner);
  // One that several points share may have lost the one that it is at.
  if (structure_.shared_vertices.empty()) return;
  for (const ChangeRecord& change : changes)
    for (const MeshChange& of_mesh : change.meshes)
      for (const RewrittenTriangle& rewritten : of_mesh.rewritten)
        for (const Index vertex : rewritten.before) {
          const auto shared = structure_.shared_vertices.find({of_mesh.mesh, vertex});
          if (shared == structure_.shared_vertices.end()) continue;
          for (const Index point : shared->second) lose(point);
          if (has_vertex(structure_.vertex_points[of_mesh.mesh][vertex], of_mesh.mesh, vertex)) continue;
          for (const Index point : shared->second)
            if (has_vertex(point, of_mesh.mesh, vertex)) {
              set_vertex_point(of_mesh.mesh, vertex, point);
              break;
            }
        }
}

/// A point that has no face any more belongs to nothing.
void Repair::lose(Index point) {
  if (point >= structure_.point_count() || surface_.point_corner[point] != kNone || current(point).empty()) return;
  work_of(point).count = 0;
  lost_.push_back(point);
}

void Repair::leave_lost_points(std::span<const ChangeRecord> changes) {
  for (const ChangeRecord& change : changes)
    for (const MeshChange& of_mesh : change.meshes) {
      if (of_mesh.retired.empty()) continue;
      for (const RewrittenTriangle& rewritten : of_mesh.rewritten)
        for (const Index vertex : rewritten.before)
          if (const Index point = structure_.vertex_points[of_mesh.mesh][vertex]; point != kNone) lose(point);
    }
}

void Repair::take_up_lips(std::span<const ChangeRecord> changes) {
  const auto add = [&](Index point, Side side) {
    if (point >= structure_.point_count() || surface_.point_corner[point] == kNone) return;
    const LipPoint& lip = structure_.lip_points[point];
    if (lip.tear == tear_ && lip.side == side) return;
    log_point(point);
    structure_.put_on_lip(point, tear_, side);
    lips_.push_back(point);
  };
  for (const ChangeRecord& change : changes) {
    for (const LipPair& pair : change.lips) {
      add(pair.left, Side::left);
      add(pair.right, Side::right);
    }
    for (const Index point : change.rims.left) add(point, Side::left);
    for (const Index point : change.rims.right) add(point, Side::right);
  }
  take_up_older_lips();
}

/// Points that a tear made on the lips of older ones are on those too.
void Repair::take_up_older_lips() {
  std::vector<Particle::OfTear> found;
  for (int pass = 0; pass < 2; ++pass)  // those beside one another may both be new
    for (Index point = first_new_; point < structure_.point_count(); ++point) {
      const Index before = border_.previous(point), after = before == kNone ? kNone : border_.next(point);
      if (after == kNone) continue;
      found.clear();
      const bool is_own = structure_.lip_points[point].tear == tear_;
      const auto look_at = [&](Index beside, Index other) {
        structure_.for_each_lip(beside, [&](Index tear, Side side) {
          // Where the new lip ends in an old one, that goes on to one side; elsewhere the old one passes by.
          const bool passes = is_own ? structure_.lip_points[beside].tear != tear_ : structure_.is_on_lip(other, tear, side);
          if (passes && tear != tear_) found.push_back({tear, side});
        });
      };
      look_at(before, after);
      if (is_own) look_at(after, before);
      for (const Particle::OfTear& of : found) {
        const auto is_other = [&](const Particle::OfTear& other) { return other.tear == of.tear && other.side != of.side; };
        const bool is_tip = std::ranges::any_of(found, is_other);
        if (!is_tip && !structure_.is_on_lip(point, of.tear, Side::left) && !structure_.is_on_lip(point, of.tear, Side::right))
          structure_.put_on_lip(point, of.tear, of.side);
      }
    }
}

/// Gives a point the memberships of those around it that have theirs. @return false where none has.
bool Repair::spread_to(Index point) {
  const Marks& is_ready = structure_.scratch.seen;
  const Ring around = ring_(point);
  const auto knows = [&](Index other) { return other < first_new_ || is_ready.has(other); };
  bool has_any = false;
  for (std::size_t i = 0; i < around.size(); ++i) {
    if (!knows(around.point(i))) continue;
    has_any = true;
    const bool has_next = i + 1 < around.size() && knows(around.point(i + 1));
    for (std::size_t m = 0; m < current(around.point(i)).size(); ++m) {  // join() moves them
      const ParticleMembership membership = current(around.point(i))[m];
      if (!may_join(point, membership.particle)) continue;
      const float range = structure_.particles[membership.particle].range, at = membership.reach * range;
      float distance = at + around.length(i);
      if (has_next)
        for (const ParticleMembership& beside : current(around.point(i + 1)))
          if (beside.particle == membership.particle)
            distance = std::min(distance, std::sqrt(one_by_one::square_across(around.opposite(i), around.length(i),
                                                                              around.length(i + 1), at, beside.reach * range)));
      if (distance < range) join(point, {membership.particle, distance / range});
    }
  }
  return has_any;
}

/// Gives new points the memberships of those around them, over the surface as it is now torn: so the two lips get theirs each from
/// its own side.
void Repair::spread_to_new_points() {
  Marks& is_ready = structure_.scratch.seen;
  is_ready.begin(structure_.point_count());
  std::vector<Index> open, ready, later;
  for (Index point = first_new_; point < structure_.point_count(); ++point)
    if (surface_.point_corner[point] != kNone) open.push_back(point);
  while (!open.empty()) {
    ready.clear();
    later.clear();
    for (const Index point : open) (spread_to(point) ? ready : later).push_back(point);
    for (const Index point : open) (void)work_of(point);
    if (ready.empty()) return;
    for (const Index point : ready) is_ready.mark(point);
    open.swap(later);
  }
}

void Repair::renew_weights(std::span<const ChangeRecord> changes) {
  std::vector<Index> particles;
  for (const ChangeRecord& change : changes)
    for (const MeshChange& of_mesh : change.meshes) {
      // Of what tears append only the vertices themselves are new, and nobody knew them.
      if (of_mesh.vertex_count > 0 || of_mesh.triangle_count > 0 || !of_mesh.rewritten.empty()) continue;
      for (const IndexRange& range : of_mesh.dirty_vertices)
        for (Index vertex = range.first; vertex < range.first + range.count; ++vertex)
          if (const Index point = structure_.vertex_points[of_mesh.mesh][vertex]; point != kNone)
            for (const ParticleMembership& membership : structure_.memberships_of(point)) particles.push_back(membership.particle);
    }
  if (particles.empty()) return;
  std::sort(particles.begin(), particles.end());
  particles.erase(std::unique(particles.begin(), particles.end()), particles.end());
  RestSums sums(model_, structure_);
  for (const Index particle : particles) sums.sum(structure_.members_of(particle), change_particle(particle));
}

/// What moved a point before the tear; of one that came with it: what moved those around.
ParticleInfluences Repair::influences_before(Index point) {
  if (point < change_.points) {
    for (const Change::OfPoint& of : change_.changed_points)
      if (of.point == point) return of.influences;
    return structure_.influences[point];
  }
  const Ring around = other_ring_(point);
  for (std::size_t i = 0; i < around.size(); ++i)
    if (around.point(i) < change_.points) return influences_before(around.point(i));
  return {};
}

void Repair::cover(Index seed) {
  if (surface_.point_corner[seed] == kNone) return;
  if (std::ranges::any_of(current(seed), [](const ParticleMembership& membership) { return membership.reach < kUncovered; }))
    return;
  const auto range = static_cast<float>(structure_.report.range);
  const Index particle = make_particle(seed, range, influences_before(seed));
  structure_.front.begin(structure_.point_count(), range, structure_.edge_length);
  structure_.front.add(seed, 0.0f);
  structure_.front.run(other_ring_, [&](Index point, float distance, Index) {
    if (may_join(point, particle)) join(point, {particle, distance / range});
    return true;
  });
}

void Repair::cover() {
  for (std::size_t w = 0; w < works_.size(); ++w) cover(works_[w].point);
}

void follow_operation(const TornModel& model, Structure& structure, std::span<const ChangeRecord> changes) {
  if (structure.done.empty() || structure.done.back().operation != 0) {
    structure.undone.clear();
    structure.memberships.resize(structure.memberships_end);
    Change& change = structure.done.emplace_back();
    change.points = structure.point_count();
    change.particles = static_cast<Index>(structure.particles.size());
    change.lips = static_cast<Index>(structure.lips.size());
    change.memberships_before = structure.memberships_end;
    for (const auto& points : structure.vertex_points) change.vertices.push_back(static_cast<Index>(points.size()));
    structure.scratch.logged_points.begin(change.points);
    structure.scratch.logged_particles.begin(change.particles);
  }
  Repair repair(model, structure, structure.done.back(), static_cast<Index>(structure.done.size() - 1));
  repair.follow(changes);
  repair.finish();
}

void widen_band(const TornModel& model, Structure& structure, Index points) {
  Repair repair(model, structure, structure.done.back(), structure.band->tear);
  repair.widen(points);
  repair.finish();
}

void complete_band(const TornModel& model, Structure& structure) {
  while (structure.band) widen_band(model, structure, kNone);
}

}  // namespace sunder::particles
