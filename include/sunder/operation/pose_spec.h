#pragma once

#include <sunder/core/skeleton.h>

#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace sunder {

/// The rest pose: bone transforms as stored in the file.
struct RestPose {};
/// The bind pose: the pose in which the skins were attached.
struct BindPose {};
/// A clip at a point in time.
struct ClipPose {
  std::variant<std::string, std::uint32_t> clip;  ///< By name or by index.
  double time = 0.0;                              ///< Seconds.
};
/// The rest pose with some bone transforms replaced. Parts that are not given keep the rest value.
struct BonesPose {
  struct Bone {
    std::string name;
    std::optional<Vec3f> translation;
    std::optional<Quatf> rotation;  ///< x y z w; normalised when read.
    std::optional<Vec3f> scale;
  };
  std::vector<Bone> bones;
};
/// How operations and pose sets specify a pose. A recorded operation stores its pose as a
/// ModelPose, with all bone matrices.
using PoseSpec = std::variant<RestPose, BindPose, ClipPose, BonesPose, ModelPose>;

/// The range in which a bone turns about one axis. A bone with several axes has several limits.
struct JointLimit {
  std::uint32_t bone = 0;
  Vec3d axis = Vec3d(1.0, 0.0, 0.0);  ///< In the bone's own frame; any length except zero.
  double lower = 0.0;                 ///< Radians relative to rest; <= upper.
  double upper = 0.0;
};

/// The poses over which weights are fitted, and the held-out poses that measure their error.
struct PoseSetSpec {
  /// Largest number of poses taken from each clip: one for every 15 degrees that a bone turns, at
  /// least 16, at equal steps of motion, and one from a clip that does not move. Many clips share
  /// 768 poses. The same number, halfway between them, is held out. At most 65,536; 0: no clips.
  std::uint32_t clip_samples = 32;
  /// Adds poses that turn each bone that changes a mesh's shape, alone and with its parent.
  bool range_of_motion = false;
  /// Bones listed here turn within their limits only, and turn also without `range_of_motion`.
  /// Bones that change no mesh's shape stay at rest.
  std::vector<JointLimit> joint_limits;
  std::vector<PoseSpec> poses;  ///< Further poses; every fourth is held out.
};

}  // namespace sunder
