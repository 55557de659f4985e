#include "scene/drawing/draw_order.h"

#include <algorithm>

namespace sunder::scene {

DrawOrder::DrawOrder(const Mesh& mesh) : triangle_count_(mesh.triangle_count()) {
  std::vector<Index> first(mesh.submeshes.size() + 1, 0);
  for (const Index submesh : mesh.triangle_submesh) ++first[submesh + 1];
  for (Index s = 0; s < mesh.submeshes.size(); ++s) {
    if (first[s + 1] > 0) ranges_.push_back({s, first[s], first[s + 1]});
    first[s + 1] += first[s];
  }
  if (std::is_sorted(mesh.triangle_submesh.begin(), mesh.triangle_submesh.end())) return;
  places_.resize(triangle_count_);
  grouped_.resize(triangle_count_);
  for (Index t = 0; t < triangle_count_; ++t) {
    places_[t] = first[mesh.triangle_submesh[t]]++;
    grouped_[places_[t]] = mesh.triangles[t];
  }
}

std::size_t DrawOrder::memory_bytes() const {
  return grouped_.capacity() * sizeof(Triangle) + places_.capacity() * sizeof(Index) +
         ranges_.capacity() * sizeof(DrawRange);
}

}  // namespace sunder::scene
