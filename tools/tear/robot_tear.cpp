#include "tools/tear/robot_tear.h"

#include <sunder/io/trajectory_file.h>

#include <algorithm>
#include <optional>
#include <utility>

#include "core/internal/nearest_names.h"
#include "tools/messages/messages.h"
#include "tools/messages/printed.h"
#include "tools/model/load_notes.h"
#include "tools/model/pose_argument.h"

namespace sunder::tools {
namespace {

/// While a clip runs, the blade is sampled at least as often as a game draws.
constexpr double kFrame = 1.0 / 60;

/// "; did you mean 'tool_tip'?".
std::string advice_on_link(const Robot& robot, const std::string& link) {
  std::vector<std::string> names;
  for (const RobotLink& of : robot.links) names.push_back(of.name);
  const std::string near = listed_names(nearest_names(link, names));
  return near.empty() ? near : "; did you mean " + near + "?";
}

void add_warnings(const RobotTearRequest& request, const RobotMotion& motion, RobotTear& made) {
  for (const RobotFinding& finding : made.robot.findings)
    if (finding.severity == RobotSeverity::warning)
      made.warnings.push_back(request.robot.string() + ": " +
                              (finding.place.empty() ? "" : finding.place + ": ") + finding.text);
  for (const LimitExcess& excess : motion.excesses()) {
    const RobotValue& value = made.robot.robot.values[excess.value];
    made.warnings.push_back(
        printed("joint '%s' leaves its limits, %.4g to %.4g: %.4g at %.4g s; %s",
                value.name.c_str(), value.lower, value.upper, excess.number, excess.time,
                request.clamps_to_limits ? "it is kept within them" : "--keep-limits keeps it"));
    made.excesses.push_back({{"joint", value.name},
                             {"lower", value.lower},
                             {"upper", value.upper},
                             {"value", excess.number},
                             {"time", excess.time}});
  }
}

/// The robot along its trajectory.
std::optional<RobotMotion> read_motion(const RobotTearRequest& request, const ModelReading& reading,
                                       RobotTear& made, ExitCode& code) {
  Result<LoadedRobot> robot = load_robot(request.robot, robot_load_options(reading));
  if (!robot) {
    code = complain(request.robot.string(), robot.error(), ExitCode::unreadable_input);
    return {};
  }
  warn_of_protection(request.robot.string(), robot->model.report, Messages(Verbosity::normal));
  made.robot = std::move(*robot);
  const Result<RobotTrajectory> trajectory = request.trajectory.empty()
                                                 ? RobotTrajectory{{}, {0.0}, {}}
                                                 : load_trajectory(request.trajectory);
  if (!trajectory) {
    code = complain(request.trajectory.string(), trajectory.error(), ExitCode::usage);
    return {};
  }
  Result<RobotMotion> motion =
      RobotMotion::create(made.robot.robot, *trajectory, {request.clamps_to_limits});
  if (!motion) {
    code = complain(request.trajectory.string(), motion.error(), ExitCode::usage);
    return {};
  }
  add_warnings(request, *motion, made);
  return std::move(*motion);
}

/// The frame of the robot's root in the character's space.
Affine3d world_from_root(const RobotTearRequest& request, const RobotTear& made) {
  return request.place * made.robot.model_from_root;
}

/// Poses the robot as it stands at a time.
Status pose_robot(const RobotTearRequest& request, const RobotMotion& motion, double time,
                  RobotTear& made) {
  made.last_pose.model_from_bone.resize(motion.link_count());
  made.last_pose.morph_weights = made.robot.model.character->rest_morph_weights;
  return motion.pose_at(time, made.last_pose.model_from_bone, world_from_root(request, made));
}

/// Sweeps the blade and poses the robot as it stands at the end.
Result<BladeSweep> sweep(const RobotTearRequest& request, const RobotMotion& motion,
                         std::uint32_t link, RobotTear& made) {
  SweepOptions options;
  options.spacing = request.spacing;
  if (request.clip_speed > 0) options.seconds = kFrame;
  const Affine3d place = world_from_root(request, made);
  Result<BladeSweep> swept = sweep_blade(motion, {link, request.base, request.tip}, place, options);
  if (!swept) return swept;
  made.first_time = swept->times.front();
  made.last_time = swept->times.back();
  made.times = swept->times;
  if (const Status status = pose_robot(request, motion, made.last_time, made); !status)
    return status;
  return swept;
}

}  // namespace

ExitCode make_robot_tear(const RobotTearRequest& request, const ModelReading& reading,
                         const Character& character, const Messages& messages, RobotTear& made) {
  ExitCode code = ExitCode::ok;
  const std::optional<RobotMotion> motion = read_motion(request, reading, made, code);
  if (!motion) return code;
  for (const std::string& warning : made.warnings) messages.warn(warning);
  const std::uint32_t link = find_link(made.robot.robot, request.link);
  if (link == kNone)
    return complain("--blade",
                    Status::failure(StatusCode::not_found, kNone, "the robot has no link '%.80s'",
                                    request.link.c_str()),
                    ExitCode::usage, advice_on_link(made.robot.robot, request.link));
  const Result<PoseArgument> pose = parse_pose(request.pose, character);
  if (!pose)
    return complain("--pose", pose.error(), ExitCode::usage,
                    advice_on_pose(request.pose, character));
  if (!pose->remark.empty()) messages.warn("--pose: " + pose->remark);
  const Result<BladeSweep> swept = sweep(request, *motion, link, made);
  if (!swept) return complain("--robot", swept.error(), ExitCode::usage);
  Result<TearOperation> tear =
      tear_of_sweep(*swept, pose->spec, request.clip_speed, request.options);
  if (!tear) return complain("--clip-speed", tear.error(), ExitCode::usage);
  made.tear = std::move(*tear);
  messages.say(printed("--robot: blade '%s', %zu places from %.4g s to %.4g s",
                       request.link.c_str(), made.tear.stroke.size(), made.first_time,
                       made.last_time));
  return ExitCode::ok;
}

ExitCode place_robot(const RobotTearRequest& request, const ModelReading& reading,
                     const Messages& messages, RobotTear& made) {
  ExitCode code = ExitCode::ok;
  const std::optional<RobotMotion> motion = read_motion(request, reading, made, code);
  if (!motion) return code;
  for (const std::string& warning : made.warnings) messages.warn(warning);
  made.last_time = motion->last_time();
  const Status status = pose_robot(request, *motion, made.last_time, made);
  return status ? ExitCode::ok : complain("--robot", status, ExitCode::usage);
}

Json robot_tear_json(const RobotTearRequest& request, const RobotTear& made) {
  return {{"file", request.robot.string()},
          {"trajectory", request.trajectory.string()},
          {"link", request.link},
          {"blades", made.tear.stroke.size()},
          {"first_time", made.first_time},
          {"last_time", made.last_time},
          {"exceeded_limits", made.excesses}};
}

PosedRobot posed_robot(const RobotTear& made) {
  return {*made.robot.model.character, made.last_pose};
}

}  // namespace sunder::tools
