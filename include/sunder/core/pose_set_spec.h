#pragma once

#include <sunder/core/named_pose.h>

#include <cstdint>
#include <vector>

namespace sunder {

/// How far a bone turns about one axis. Several limits of one bone are its several axes.
struct JointLimit {
  std::uint32_t bone = 0;
  Vec3d axis = Vec3d(1.0, 0.0, 0.0);  ///< In the bone's own frame; any length but zero.
  double lower = 0.0;                 ///< Radians about rest; <= upper.
  double upper = 0.0;
};

/// The poses over which weights are fitted, and others over which their error is measured.
struct PoseSetSpec {
  /// Of each clip that lasts: so many poses to fit over, and as many between them held out. At most 65,536; 0: no clips.
  std::uint32_t clip_samples = 8;
  bool range_of_motion = false;  ///< Turn every bone that changes a mesh's shape, alone and with its parent.
  /// Bones that turn only so; they do also where no range of motion is asked for. Those that change no shape stay at rest.
  std::vector<JointLimit> joint_limits;
  std::vector<PoseSpec> poses;  ///< As given; every fourth is held out.
};

}  // namespace sunder
