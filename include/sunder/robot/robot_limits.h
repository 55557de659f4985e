#pragma once

#include <sunder/certificate/certificate.h>
#include <sunder/core/status.h>
#include <sunder/operation/pose_spec.h>
#include <sunder/robot/robot.h>

#include <vector>

namespace sunder {

/// How the joints of a robot let the bones of its character move, for certificates: bone i is link
/// i, and bind is the pose of rest_values(). A mimic joint has the range that its driving value
/// gives it; joints are taken as independent of one another. Continuous joints turn fully; planar
/// and floating ones, and prismatic ones without limits, slide without a range.
/// @return the first fault of validate_robot(); limit_exceeded: out of memory.
[[nodiscard]] SUNDER_API Result<JointLimits> joint_limits_of(const Robot& robot);

/// The turning joints of a robot as limits of a pose set, for fits of weights: one entry per bone
/// that a joint turns, relative to rest_values(). Others stay at rest.
/// @return as above.
[[nodiscard]] SUNDER_API Result<std::vector<JointLimit>> pose_limits_of(const Robot& robot);

}  // namespace sunder
