#pragma once

#include <sunder/core/skeleton.h>

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
/// How operations and pose sets name a pose. What was played is logged as a ModelPose: bone
/// matrices in full.
using PoseSpec = std::variant<RestPose, BindPose, ClipPose, BonesPose, ModelPose>;

/// How far a bone turns about one axis. Several limits of one bone are its several axes.
struct JointLimit {
  std::uint32_t bone = 0;
  Vec3d axis = Vec3d(1.0, 0.0, 0.0);  ///< In the bone's own frame; any length but zero.
  double lower = 0.0;                 ///< Radians about rest; <= upper.
  double upper = 0.0;
};

/// The poses over which weights are fitted, and others over which their error is measured.
struct PoseSetSpec {
  /// Of each clip that lasts: so many poses to fit over, and as many between them held out. At most
  /// 65,536; 0: no clips.
  std::uint32_t clip_samples = 8;
  bool range_of_motion =
      false;  ///< Turn every bone that changes a mesh's shape, alone and with its parent.
  /// Bones that turn only so; they do also where no range of motion is asked for. Those that change
  /// no shape stay at rest.
  std::vector<JointLimit> joint_limits;
  std::vector<PoseSpec> poses;  ///< As given; every fourth is held out.
};

}  // namespace sunder
