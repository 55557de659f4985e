#include "particles/motion/moved_vertices.h"

#include <algorithm>

#include "particles/clusters/torn_meshes.h"
#include "tear/internal/surface.h"

namespace sunder::particles {
namespace {

/// What it costs to look at a member of a particle that changed, whose vertices change too, and at
/// a point of the journal, of which few do, in points that are read in order.
constexpr std::size_t kCostOfMember = 7, kCostOfEntry = 3;

}  // namespace

bool MovedVertices::is_point_displaced(const ParticleInfluences& of) const {
  unsigned is = 0;  // without branches, which are unpredictable here
  for (std::size_t k = 0; k < 4; ++k)
    is |= unsigned{of.weights[k] > 0} & unsigned{is_displaced_[of.particles[k]] != 0};
  return is != 0;
}

/// Lists the particles that became displaced or stopped. @return the number of their members.
std::size_t MovedVertices::list_changed_particles(const Structure& structure,
                                                  std::span<const std::uint8_t> is_displaced) {
  changed_.clear();
  changed_.reserve(is_displaced.size());
  std::size_t members = 0;
  for (Index p = 0; p < is_displaced.size(); ++p) {
    const bool was = p < is_displaced_.size() && is_displaced_[p] != 0;
    if (was == (is_displaced[p] != 0)) continue;
    changed_.push_back(p);
    members += structure.particles[p].member_count;
  }
  is_displaced_.assign(is_displaced.begin(), is_displaced.end());
  return members;
}

void MovedVertices::resize(const Structure& structure) {
  points_.resize(structure.points.count());
  const auto& of_mesh = structure.vertex_points.of_mesh;
  meshes_.resize(of_mesh.size());
  for (std::size_t m = 0; m < of_mesh.size(); ++m) {
    const auto count = static_cast<Index>(of_mesh[m].size());
    if (meshes_[m].is_moved.size() == count) continue;
    meshes_[m].is_moved.resize(count);
    meshes_[m].is_listed = false;
  }
}

void MovedVertices::renew_vertex(const Structure& structure, const TornModel& model, Index mesh,
                                 Index vertex) {
  const VertexPoints& of = structure.vertex_points;
  const Index point = of.of_mesh[mesh][vertex];
  bool is_moved = point != kNone && points_[point];
  if (!is_moved && !of.shared.empty())
    if (const auto shared = of.shared.find({mesh, vertex}); shared != of.shared.end())
      is_moved = std::ranges::any_of(shared->second, [&](Index other) {
        return other < points_.size() && points_[other] && has_vertex(model, other, mesh, vertex);
      });
  if (meshes_[mesh].is_moved.set(vertex, is_moved)) meshes_[mesh].is_listed = false;
}

void MovedVertices::renew_point(const Structure& structure, const TornModel& model, Index point) {
  if (point >= points_.size() ||
      !points_.set(point, is_point_displaced(structure.points.influences[point])))
    return;
  for_each_vertex(model, point,
                  [&](Index mesh, Index vertex) { renew_vertex(structure, model, mesh, vertex); });
}

void MovedVertices::renew_all(const Structure& structure, const TornModel& model) {
  const std::vector<ParticleInfluences>& influences = structure.points.influences;
  points_.set_all([&](Index point) { return is_point_displaced(influences[point]); });
  for (Index m = 0; m < meshes_.size(); ++m) {
    const std::vector<Index>& points = structure.vertex_points.of_mesh[m];
    meshes_[m].is_listed = false;
    meshes_[m].is_moved.set_all([&](Index v) { return points[v] != kNone && points_[points[v]]; });
  }
  for (const auto& [vertex, points] : structure.vertex_points.shared)
    if (vertex.second < meshes_[vertex.first].is_moved.size())
      renew_vertex(structure, model, vertex.first, vertex.second);
}

void MovedVertices::renew_changed(const Structure& structure, const TornModel& model) {
  const auto renew = [&](Index point) { renew_point(structure, model, point); };
  for (const Index point : structure.journal.points.since(points_read_)) renew(point);
  for (const Index particle : changed_) structure.for_each_candidate(particle, renew);
  for (const ChangedVertex& of : structure.journal.vertices.since(vertices_read_))
    if (of.vertex < meshes_[of.mesh].is_moved.size())
      renew_vertex(structure, model, of.mesh, of.vertex);
}

std::span<const IndexRange> MovedVertices::of(const Structure& structure, const TornModel& model,
                                              Index mesh, std::uint64_t key,
                                              std::span<const std::uint8_t> is_displaced) {
  const ChangeJournal& journal = structure.journal;
  if (key_ != key) {
    if (is_untouched_) {  // nothing was displaced, so only members of displaced particles can be
      points_read_ = journal.points.end();
      vertices_read_ = journal.vertices.end();
    }
    bool is_known = is_untouched_ || (key_ != 0 && journal.points.has_since(points_read_) &&
                                      journal.vertices.has_since(vertices_read_));
    key_ = 0;  // invalid until the update is complete
    is_untouched_ = false;
    const std::size_t members = list_changed_particles(structure, is_displaced);
    resize(structure);
    if (is_known)
      is_known =
          kCostOfMember * members + kCostOfEntry * journal.points.since(points_read_).size() <
          structure.points.count();
    if (is_known)
      renew_changed(structure, model);
    else
      renew_all(structure, model);
    points_read_ = journal.points.end();
    vertices_read_ = journal.vertices.end();
    key_ = key;
  }
  OfMesh& found = meshes_[mesh];
  if (found.is_listed) return found.ranges;
  found.ranges.clear();
  found.is_moved.for_each_run([&](Index first, Index end) {
    found.ranges.push_back({first, end - first});
  });
  found.is_listed = true;
  return found.ranges;
}

}  // namespace sunder::particles
