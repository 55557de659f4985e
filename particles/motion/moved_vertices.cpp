#include "particles/motion/moved_vertices.h"

#include <algorithm>

#include "tear/internal/surface.h"

namespace sunder::particles {

std::span<const IndexRange> MovedVertices::of(const ParticleSet& set, const TornModel& model, Index mesh, std::uint64_t key,
                                              std::span<const std::uint8_t> is_displaced) {
  if (meshes_.size() <= mesh) meshes_.resize(mesh + 1);
  OfMesh& found = meshes_[mesh];
  if (found.key == key) return found.ranges;
  const tear::Surface& surface = model.surface();
  vertices_.clear();
  for (Index p = 0; p < is_displaced.size(); ++p) {
    if (is_displaced[p] == 0) continue;
    for (const Index point : set.members(p)) {
      // A point of two that are displaced is told of once: by the first of its particles that is.
      const ParticleInfluences& of = set.influences()[point];
      std::size_t k = 0;
      while (k < 4 && of.weights[k] > 0 && is_displaced[of.particles[k]] == 0) ++k;
      if (k == 4 || !(of.weights[k] > 0) || of.particles[k] != p || surface.point_corner[point] == kNone) continue;
      surface.for_each_in_fan(surface.point_corner[point], [&](Index corner) {
        const tear::TriangleRef ref = surface.triangle(corner / 3);
        if (ref.mesh == mesh) vertices_.push_back(model.character().meshes[mesh].triangles[ref.triangle][corner % 3]);
      });
    }
  }
  std::sort(vertices_.begin(), vertices_.end());
  found.ranges.clear();
  for (const Index vertex : vertices_) {
    if (!found.ranges.empty() && vertex <= found.ranges.back().first + found.ranges.back().count)
      found.ranges.back().count = vertex + 1 - found.ranges.back().first;
    else
      found.ranges.push_back({vertex, 1});
  }
  found.key = key;
  return found.ranges;
}

}  // namespace sunder::particles
