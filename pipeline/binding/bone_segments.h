#pragma once

#include <string>
#include <vector>

#include "pipeline/binding/joined.h"

namespace sunder::binding {

/// A part of a bone that heats the surface.
struct BoneSegment {
  Index bone = 0;
  Vec3d begin = Vec3d::Zero(), end = Vec3d::Zero();  ///< Rig space; may be one point.
};

/// The bones of a rig that may get weight: those named, else those with weight in the rig's own
/// meshes, else all. @return not_found for a name; empty_input.
[[nodiscard]] Result<std::vector<bool>> choose_bones(const Character& rig,
                                                     const std::vector<std::string>& names);

/// The segments of the chosen bones: from the bone's joint to the joints of the nearest chosen
/// bones below it. A bone that leads to none, or only to joints at its own, reaches through the
/// part of the rig's meshes that it moves; if there is none, it continues the bone above it by its
/// length.
[[nodiscard]] std::vector<BoneSegment> bone_segments(const Joined& joined,
                                                     const std::vector<bool>& is_chosen);

}  // namespace sunder::binding
