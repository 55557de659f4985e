#include "particles/clusters/source_border.h"

#include <algorithm>
#include <utility>

namespace sunder::particles {
namespace {

using tear::Surface;
using tear::TriangleRef;

std::vector<Index> borders_of(const Surface& surface) {
  std::vector<Index> borders;
  for (Index h = 0; h < surface.twin.size(); ++h)
    if (surface.twin[h] == kNone && !surface.has_repeated_point(h / 3)) borders.push_back(h);
  return borders;
}

/// Whether a vertex of a part of a source triangle lies on the side opposite of a corner.
bool is_opposite(Index mesh, Index vertex, Index corner_vertex, const TornModel& model) {
  const Mesh& source = model.source().meshes[mesh];
  if (vertex < source.vertex_count()) return vertex != corner_vertex;
  const Birth birth = model.birth(mesh, vertex);
  const Triangle& parents = source.triangles[birth.triangle];
  for (std::size_t k = 0; k < 3; ++k)
    if (parents[k] == corner_vertex && birth.barycentric[k] != 0) return false;
  return true;
}

}  // namespace

SourceBorder::SourceBorder(const TornModel& model) {
  std::vector<Index> borders = model.newest_operation() == 0
                                   ? borders_of(model.surface())
                                   : borders_of(tear::build_surface(model.source()));
  half_edges_ = std::make_shared<const std::vector<Index>>(std::move(borders));
}

bool SourceBorder::has(Index half_edge, const TornModel& model) const {
  if (!half_edges_ || half_edges_->empty()) return false;
  const Surface& surface = model.surface();
  const TriangleRef ref = surface.triangle(half_edge / 3);
  const Index first = 3 * (surface.first_triangle[ref.mesh] + ref.source_triangle);
  const auto& triangles = model.source().meshes[ref.mesh].triangles;
  if (ref.source_triangle >= triangles.size()) return false;
  const Triangle &origin = triangles[ref.source_triangle],
                 &part = model.character().meshes[ref.mesh].triangles[ref.triangle];
  const auto is_on = [&](Index corner, Index k) {
    return is_opposite(ref.mesh, part[corner % 3], origin[(k + 2) % 3], model);
  };
  for (Index k = 0; k < 3; ++k)
    if (is_on(half_edge, k) && is_on(Surface::next(half_edge), k))
      return std::binary_search(half_edges_->begin(), half_edges_->end(), first + k);
  return false;
}

}  // namespace sunder::particles
