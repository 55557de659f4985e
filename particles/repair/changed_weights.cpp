#include "particles/repair/changed_weights.h"

#include <algorithm>

#include "particles/clusters/member_search.h"

namespace sunder::particles {
namespace {

void add_particles_of(const Structure& structure, Index mesh, const IndexRange& vertices,
                      std::vector<Index>& particles) {
  for (Index vertex = vertices.first; vertex < vertices.first + vertices.count; ++vertex) {
    const Index point = structure.vertex_points.of_mesh[mesh][vertex];
    if (point == kNone) continue;
    for (const ParticleMembership& membership : structure.points.memberships_of(point))
      particles.push_back(membership.particle);
  }
}

/// Whether a call that tears made a change.
bool is_of_tear(const MeshChange& of_mesh) {
  return of_mesh.vertex_count > 0 || of_mesh.triangle_count > 0 || !of_mesh.rewritten.empty();
}

}  // namespace

void follow_changed_weights(StructureEdit& edit, std::span<const ChangeRecord> changes) {
  const Structure& structure = edit.structure();
  std::vector<Index> particles;
  for (const ChangeRecord& change : changes)
    for (const MeshChange& of_mesh : change.meshes) {
      if (is_of_tear(of_mesh)) continue;
      for (const IndexRange& range : of_mesh.dirty_vertices)
        add_particles_of(structure, of_mesh.mesh, range, particles);
    }
  if (particles.empty()) return;
  std::sort(particles.begin(), particles.end());
  particles.erase(std::unique(particles.begin(), particles.end()), particles.end());
  RestSums sums(edit.model(), structure.character.first_slots, structure.points.vertices);
  MemberSearch search(structure);
  for (const Index particle : particles)
    sums.sum(search.members_of(particle), edit.change_particle(particle));
}

}  // namespace sunder::particles
