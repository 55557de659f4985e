#pragma once

#include <sunder/core/character.h>

#include <vector>

#include "tools/model/posed_model.h"
#include "tools/picture/model_looks.h"

namespace sunder::tools {

/// A robot that stands in a picture beside a model.
struct PosedRobot {
  const Character& character;  ///< May have no mesh.
  const ModelPose& pose;       ///< In the model's space.
};

/// The surfaces of a robot for a still scene, in the colour of steel.
[[nodiscard]] Result<std::vector<Mesh>> robot_surfaces(const PosedRobot& robot);

/// Adds them to a scene.
void add_surfaces(const std::vector<Mesh>& surfaces, const ModelLooks& looks, RenderScene& scene);

/// The places of those of its vertices that are within a distance of a place.
[[nodiscard]] std::vector<Vec3d> places_near(const std::vector<Mesh>& surfaces, const Vec3d& place,
                                             double distance);

}  // namespace sunder::tools
