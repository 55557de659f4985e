#include "particles/repair/changed_weights.h"

#include <algorithm>

#include "particles/clusters/member_search.h"
#include "tear/internal/former_weights.h"

namespace sunder::particles {
namespace {

/// Whether a call that tears made a change.
bool is_of_tear(const MeshChange& of_mesh) {
  return of_mesh.vertex_count > 0 || of_mesh.triangle_count > 0 || !of_mesh.rewritten.empty();
}

/// Calls visit(mesh, vertices) for the vertices whose weights changed.
template <class Visit>
void for_each_changed(std::span<const ChangeRecord> changes, Visit visit) {
  for (const ChangeRecord& change : changes)
    for (const MeshChange& of_mesh : change.meshes)
      if (!is_of_tear(of_mesh))
        for (const IndexRange& range : of_mesh.dirty_vertices) visit(of_mesh.mesh, range);
}

/// Calls visit(point) for the points whose terms are those of a vertex.
template <class Visit>
void for_each_point_of(const Structure& structure, Index mesh, Index vertex, Visit visit) {
  const auto visit_own = [&](Index point) {
    if (point >= structure.points.count()) return;
    const VertexRef& of = structure.points.vertices[point];
    if (of.mesh == mesh && of.vertex == vertex) visit(point);
  };
  const VertexPoints& points = structure.vertex_points;
  const auto shared = points.shared.find({mesh, vertex});
  if (shared != points.shared.end())
    for (const Index point : shared->second) visit_own(point);
  else if (points.of_mesh[mesh][vertex] != kNone)
    visit_own(points.of_mesh[mesh][vertex]);
}

/// The weights before the changes, if all of them are known.
std::vector<tear::FormerWeights> weights_before(const TornModel& model,
                                                std::span<const ChangeRecord> changes) {
  // Of several operations, the weights before the first one are not known.
  if (changes.size() != 1 || model.is_in_stroke()) return {};
  std::vector<tear::FormerWeights> former = tear::weights_before_newest_operation(model);
  const bool has_exact =
      std::ranges::any_of(former, [](const tear::FormerWeights& of) { return of.was_exact; });
  return has_exact ? std::vector<tear::FormerWeights>() : former;
}

/// Sums up again the particles that have changed vertices.
void sum_again(StructureEdit& edit, std::span<const ChangeRecord> changes) {
  const Structure& structure = edit.structure();
  const auto count = static_cast<Index>(structure.particles.size());
  Bits particles;
  particles.resize(count);
  for_each_changed(changes, [&](Index mesh, const IndexRange& range) {
    for (Index vertex = range.first; vertex < range.first + range.count; ++vertex)
      for_each_point_of(structure, mesh, vertex, [&](Index point) {
        for (const ParticleMembership& membership : structure.points.memberships_of(point))
          (void)particles.set(membership.particle, true);
      });
  });
  RestSums sums(edit.model(), structure.character.first_slots, structure.points.vertices);
  MemberSearch search(structure);
  particles.take_ones(0, count - 1, [&](Index particle) {
    sums.sum(search.members_of(particle), edit.change_particle(particle));
  });
}

/// A particle that has a vertex.
struct HasVertex {
  Index particle, vertex;  ///< Index of its former weights.
};

/// Replaces the terms of changed vertices, those of a particle in the order of the vertices.
void replace_terms(StructureEdit& edit, std::span<const tear::FormerWeights> former) {
  const Structure& structure = edit.structure();
  std::vector<HasVertex> having;
  for (Index i = 0; i < former.size(); ++i)
    for_each_point_of(structure, former[i].mesh, former[i].vertex, [&](Index point) {
      for (const ParticleMembership& membership : structure.points.memberships_of(point))
        having.push_back({membership.particle, i});
    });
  std::stable_sort(having.begin(), having.end(),
                   [](const HasVertex& a, const HasVertex& b) { return a.particle < b.particle; });
  RestChange change(edit.model(), structure.character.first_slots);
  for (auto of = having.begin(); of != having.end();) {
    const Index particle = of->particle;
    change.begin(edit.change_particle(particle));
    for (; of != having.end() && of->particle == particle; ++of) change.replace(former[of->vertex]);
    change.finish();
  }
}

}  // namespace

void follow_changed_weights(StructureEdit& edit, std::span<const ChangeRecord> changes) {
  bool is_changed = false;
  for_each_changed(changes, [&](Index, const IndexRange&) { is_changed = true; });
  if (!is_changed) return;
  const std::vector<tear::FormerWeights> former = weights_before(edit.model(), changes);
  if (former.empty())
    sum_again(edit, changes);
  else
    replace_terms(edit, former);
}

}  // namespace sunder::particles
