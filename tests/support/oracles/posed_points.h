#pragma once

#include <sunder/tear/torn_model.h>

#include <map>

#include "support/models/rigs.h"

namespace sunder::test {

/// Posed positions of the points that have a face.
inline std::map<std::uint32_t, Vec3d> posed_points(const TornModel& model, const ModelPose& pose) {
  std::map<std::uint32_t, Vec3d> places;
  for (std::uint32_t m = 0; m < model.character().meshes.size(); ++m) {
    const Mesh& mesh = model.character().meshes[m];
    const auto positions = posed_positions(model.character(), m, pose);
    for (std::uint32_t t = 0; t < mesh.triangle_count(); ++t)
      for (std::uint32_t k = 0; k < 3 && !is_retired(mesh.triangles[t]); ++k)
        places.emplace(model.point_at(m, t, k), positions[mesh.triangles[t][k]]);
  }
  return places;
}

}  // namespace sunder::test
