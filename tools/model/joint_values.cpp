#include "tools/model/joint_values.h"

#include <sunder/io/robot_file.h>
#include <sunder/robot/trajectory.h>

#include <numbers>
#include <optional>

#include "tools/model/quantity.h"
#include "tools/model/robot_joints.h"

namespace sunder::tools {
namespace {

/// Radians or metres, also "30deg" and "10mm".
std::optional<double> value_in(const std::string& text) {
  if (text.ends_with("deg")) {
    const std::optional<double> degrees = quantity_in(text, Quantity::angle);
    return degrees ? std::optional(*degrees * std::numbers::pi / 180) : std::nullopt;
  }
  return quantity_in(text, Quantity::length);
}

/// The values at one time, so that the rules for names are those of trajectories.
Result<RobotTrajectory> values_in(const std::vector<std::string>& texts) {
  RobotTrajectory values{{}, {0.0}, {}};
  for (const std::string& text : texts) {
    const std::size_t equals = text.rfind('=');
    const std::optional<double> value =
        equals == std::string::npos ? std::nullopt : value_in(text.substr(equals + 1));
    if (!value)
      return Status::failure(StatusCode::invalid_argument, kNone,
                             "'%.80s': expected NAME=VALUE, in radians or metres, or 30deg, 10mm",
                             text.c_str());
    values.names.push_back(text.substr(0, equals));
    values.values.push_back(*value);
  }
  return values;
}

}  // namespace

Result<ModelPose> pose_of_joints(const std::vector<std::string>& texts,
                                 const std::filesystem::path& model) {
  if (!is_urdf(model))
    return Status::failure(StatusCode::invalid_argument, kNone, "the model is no robot (URDF)");
  const Result<RobotTrajectory> given = values_in(texts);
  if (!given) return given.error();
  const Result<LoadedRobot> loaded = load_robot(model, {.shapes = RobotShapes::none});
  if (!loaded) return loaded.error();
  const Result<RobotMotion> motion = RobotMotion::create(loaded->robot, *given);
  if (!motion) return motion.error();
  std::vector<double> values(motion->value_count());
  if (const Status status = motion->values_at(0.0, values); !status) return status;
  if (const Status status = check_limits(loaded->robot, values); !status) return status;
  ModelPose pose;
  pose.model_from_bone.resize(motion->link_count());
  if (const Status status = motion->pose_at(0.0, pose.model_from_bone, loaded->model_from_root);
      !status)
    return status;
  return pose;
}

}  // namespace sunder::tools
