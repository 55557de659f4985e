#include "support/models/atlas_tube.h"

#include <algorithm>

#include "support/models/rigs.h"

namespace sunder::test {

Character make_atlas_tube(std::uint32_t rings, std::uint32_t sides) {
  Character tube = make_tube(rings, sides, 3);
  auto& uvs = tube.meshes[0].uv_sets[0];
  const std::uint32_t first_cap = (rings + 1) * (sides + 1), second_cap = first_cap + sides + 1;
  for (std::uint32_t v = 0; v < uvs.size(); ++v) {
    if (v < first_cap)
      uvs[v] = Vec2f(0.08f + 0.5f * uvs[v].x(), 0.08f + 0.84f * uvs[v].y());
    else
      uvs[v] = Vec2f(0.68f, v < second_cap ? 0.1f : 0.6f) + 0.25f * uvs[v];
  }
  return tube;
}

double texel_size(const Mesh& mesh, std::uint32_t size) {
  double largest = 0;
  for (const Triangle& t : mesh.triangles)
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t a = t[k], b = t[(k + 1) % 3];
      const double uv = double{(mesh.uv_sets[0][b] - mesh.uv_sets[0][a]).norm()} * size;
      if (uv > 0)
        largest = std::max(largest, double{(mesh.positions[b] - mesh.positions[a]).norm()} / uv);
    }
  return largest;
}

}  // namespace sunder::test
