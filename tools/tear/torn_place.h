#pragma once

#include <sunder/tear/torn_model.h>

#include <optional>
#include <string>
#include <vector>

namespace sunder::tools {

/// The number of triangles per mesh.
using TriangleCounts = std::vector<std::uint32_t>;
[[nodiscard]] TriangleCounts triangle_counts(const Character& character);

/// Where an operation changed the surface, from at most 300 of its new triangles per mesh.
struct TornPlace {
  Vec3d centre = Vec3d::Zero();  ///< Of these triangles, posed, model space.
  Vec3d normal = Vec3d::Zero();  ///< The sum of their normals, posed, by area.
  std::string bone;              ///< The one that moves them most.
};

/// @param before  the counts before the operation; later triangles are its own.
/// @return empty if there are none, apart from walls and caps.
[[nodiscard]] std::optional<TornPlace> torn_place(const TornModel& model,
                                                  const TriangleCounts& before,
                                                  const ModelPose& pose);

}  // namespace sunder::tools
