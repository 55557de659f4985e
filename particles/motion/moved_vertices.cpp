#include "particles/motion/moved_vertices.h"

#include <algorithm>
#include <new>

#include "tear/internal/surface.h"

namespace sunder::particles {

namespace {

/// Whether a particle is the first displaced one among those that move a point, so that each point
/// is visited once.
bool is_first_displaced(const ParticleInfluences& of, Index particle,
                        std::span<const std::uint8_t> is_displaced) {
  for (std::size_t k = 0; k < 4 && of.weights[k] > 0; ++k)
    if (is_displaced[of.particles[k]] != 0) return of.particles[k] == particle;
  return false;
}

/// Joins ascending vertices, some of them repeated, into ranges.
void join_ranges(std::span<const Index> vertices, std::vector<IndexRange>& ranges) {
  ranges.clear();
  for (const Index vertex : vertices) {
    if (!ranges.empty() && vertex <= ranges.back().first + ranges.back().count)
      ranges.back().count = vertex + 1 - ranges.back().first;
    else
      ranges.push_back({vertex, 1});
  }
}

}  // namespace

std::span<const IndexRange> MovedVertices::of(const ParticleSet& set, const TornModel& model,
                                              Index mesh, std::uint64_t key,
                                              std::span<const std::uint8_t> is_displaced) {
  if (meshes_.size() <= mesh) meshes_.resize(mesh + 1);
  OfMesh& found = meshes_[mesh];
  if (found.key == key) return found.ranges;
  const tear::Surface& surface = model.surface();
  vertices_.clear();
  const auto add = [&](Index corner) {
    const tear::TriangleRef ref = surface.triangle(corner / 3);
    if (ref.mesh == mesh)
      vertices_.push_back(model.character().meshes[mesh].triangles[ref.triangle][corner % 3]);
  };
  for (Index p = 0; p < is_displaced.size(); ++p) {
    if (is_displaced[p] == 0) continue;
    const auto members = set.members(p);
    if (!members) throw std::bad_alloc();
    for (const Index point : *members)
      if (surface.point_corner[point] != kNone &&
          is_first_displaced(set.influences()[point], p, is_displaced))
        surface.for_each_in_fan(surface.point_corner[point], add);
  }
  std::sort(vertices_.begin(), vertices_.end());
  found.key = 0;  // invalid until the update is complete
  join_ranges(vertices_, found.ranges);
  found.key = key;
  return found.ranges;
}

}  // namespace sunder::particles
