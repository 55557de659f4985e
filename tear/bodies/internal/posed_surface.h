#pragma once

#include <sunder/core/api.h>
#include <sunder/core/character.h>

#include <vector>

namespace sunder::bodies {

/// The surface of all meshes of a character in a pose, in model space.
struct PosedSurface {
  std::vector<Vec3d> positions;
  std::vector<Triangle> triangles;   ///< Retired ones too; turned around where a bone mirrors.
  std::vector<std::uint32_t> bones;  ///< Per triangle: main_bone(), or kNone of a retired one.
};

/// @param character  satisfies validate_character(). @return the first fault of the pose.
/// @throws std::bad_alloc
[[nodiscard]] SUNDER_API Result<PosedSurface> pose_surface(const Character& character,
                                                           const ModelPose& pose);

}  // namespace sunder::bodies
