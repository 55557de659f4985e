#pragma once

#include <sunder/core/pose.h>

#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace sunder {

/// "rest": the file's own bone transforms.
struct RestPose {};
/// "bind": the pose in which the skins were attached.
struct BindPose {};
/// A clip at a time; clip by name or by index.
struct ClipPose {
  std::variant<std::string, std::uint32_t> clip;
  double time = 0.0;  ///< Seconds.
};
/// Bone transforms over rest. A part that the log does not give keeps its rest value.
struct BonesPose {
  struct Bone {
    std::string name;
    std::optional<Vec3f> translation;
    std::optional<Quatf> rotation;  ///< x y z w; normalised when read.
    std::optional<Vec3f> scale;
  };
  std::vector<Bone> bones;
};
/// How operations and pose sets name a pose. What was played is logged as a ModelPose: bone matrices in full.
using PoseSpec = std::variant<RestPose, BindPose, ClipPose, BonesPose, ModelPose>;

}  // namespace sunder
