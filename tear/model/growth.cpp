#include "tear/model/growth.h"

#include <cstddef>

#include "tear/surface/capacity_exceeded.h"

namespace sunder::tear {

void check_growth(const TornCapacity& capacity, const Character& source, const Character& torn) {
  if (!is_limit(capacity)) return;
  for (std::size_t m = 0; m < source.meshes.size(); ++m) {
    const Mesh &before = source.meshes[m], &now = torn.meshes[m];
    if (now.vertex_count() > std::size_t{before.vertex_count()} + capacity.vertices)
      throw CapacityExceeded{"vertices"};
    if (now.triangles.size() > before.triangles.size() + capacity.triangles)
      throw CapacityExceeded{"triangles"};
  }
}

}  // namespace sunder::tear
