#include "particles/repair/changed_weights.h"

#include "particles/clusters/member_search.h"

namespace sunder::particles {
namespace {

void add_particles_of(const Structure& structure, Index mesh, const IndexRange& vertices,
                      Bits& particles) {
  for (Index vertex = vertices.first; vertex < vertices.first + vertices.count; ++vertex) {
    const Index point = structure.vertex_points.of_mesh[mesh][vertex];
    if (point == kNone) continue;
    for (const ParticleMembership& membership : structure.points.memberships_of(point))
      (void)particles.set(membership.particle, true);
  }
}

/// Whether a call that tears made a change.
bool is_of_tear(const MeshChange& of_mesh) {
  return of_mesh.vertex_count > 0 || of_mesh.triangle_count > 0 || !of_mesh.rewritten.empty();
}

}  // namespace

void follow_changed_weights(StructureEdit& edit, std::span<const ChangeRecord> changes) {
  const Structure& structure = edit.structure();
  const auto count = static_cast<Index>(structure.particles.size());
  Bits particles;
  for (const ChangeRecord& change : changes)
    for (const MeshChange& of_mesh : change.meshes) {
      if (is_of_tear(of_mesh) || of_mesh.dirty_vertices.empty()) continue;
      particles.resize(count);
      for (const IndexRange& range : of_mesh.dirty_vertices)
        add_particles_of(structure, of_mesh.mesh, range, particles);
    }
  if (particles.size() == 0) return;
  RestSums sums(edit.model(), structure.character.first_slots, structure.points.vertices);
  MemberSearch search(structure);
  particles.take_ones(0, count - 1, [&](Index particle) {
    sums.sum(search.members_of(particle), edit.change_particle(particle));
  });
}

}  // namespace sunder::particles
