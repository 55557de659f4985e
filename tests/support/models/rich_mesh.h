#pragma once

#include <sunder/core/mesh.h>

#include "support/models/rigs.h"

namespace sunder::test {

/// The tube of make_tube(5, 7, 4) with attributes of every kind.
inline Mesh rich_mesh() {
  Mesh mesh = make_tube(5, 7, 4).meshes[0];
  Random random(11);
  for (const Vec3f& normal : mesh.normals) {
    const Eigen::Vector3f tangent = Eigen::Vector3f(normal).unitOrthogonal();
    mesh.tangents.emplace_back(tangent.x(), tangent.y(), tangent.z(), 1.0f);
  }
  mesh.color_sets.emplace_back();
  mesh.custom_attributes = {{"_HEAT", 2, true, {}}, {"_PART", 1, false, {}}};
  for (std::uint32_t v = 0; v < mesh.vertex_count(); ++v) {
    mesh.color_sets[0].emplace_back(random.uniform(0, 1), random.uniform(0, 1),
                                    random.uniform(0, 1), 1.0f);
    mesh.custom_attributes[0].values.push_back(static_cast<float>(random.uniform(0, 9)));
    mesh.custom_attributes[0].values.push_back(static_cast<float>(random.uniform(0, 9)));
    mesh.custom_attributes[1].values.push_back(static_cast<float>(v));
  }
  return mesh;
}

}  // namespace sunder::test
