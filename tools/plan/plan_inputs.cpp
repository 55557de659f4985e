#include "tools/plan/plan_inputs.h"

#include <sunder/skinning/pose.h>

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "tools/messages/lines.h"
#include "tools/model/load_notes.h"
#include "tools/model/name_advice.h"
#include "tools/model/pose_argument.h"
#include "tools/plan/curve_file.h"

namespace sunder::tools {
namespace {

/// One shape around a bent link reaches into its neighbours.
constexpr std::uint32_t kShapesPerLink = 4;

/// The curve of the wound of another model.
ExitCode read_wound(const PlanRequest& request, const Messages& messages, PlanInputs& inputs) {
  const std::string& file = request.like->string();
  const Result<LoadedCharacter> other =
      load_character(*request.like, load_options(request.reading));
  if (!other) return complain(file, other.error(), ExitCode::unreadable_input);
  warn_of_repairs(file, other->report, messages);
  Result<WoundTarget> target = wound_like(*other->character, inputs.loaded.character);
  if (!target) return complain(file, target.error(), ExitCode::usage);
  inputs.target = std::move(*target);
  inputs.target.depth = {request.like_depth};
  return ExitCode::ok;
}

}  // namespace

ExitCode read_character(const PlanRequest& request, const Messages& messages, PlanInputs& inputs) {
  Result<LoadedCharacter> loaded = load_character(request.model, load_options(request.reading));
  if (!loaded) return complain(request.model.string(), loaded.error(), ExitCode::unreadable_input);
  inputs.loaded = std::move(*loaded);
  warn_of_repairs(request.model.string(), inputs.loaded.report, messages);
  const Character& character = *inputs.loaded.character;
  const Result<PoseArgument> pose = parse_pose(request.robot.pose, character);
  if (!pose)
    return complain("--pose", pose.error(), ExitCode::usage,
                    advice_on_pose(request.robot.pose, character));
  if (!pose->remark.empty()) messages.warn("--pose: " + pose->remark);
  inputs.timing = request.timing;
  inputs.timing.pose = pose->spec;
  inputs.timing.clip_speed = request.robot.clip_speed;
  const Result<ModelPose> posed = make_pose(character, pose->spec);
  if (!posed) return complain("--pose", posed.error(), ExitCode::usage);
  if (request.like) return read_wound(request, messages, inputs);
  Result<WoundTarget> target = read_curve(request.curve, inputs.loaded.character, *posed);
  if (!target) return complain(request.curve.string(), target.error(), ExitCode::usage);
  inputs.target = std::move(*target);
  return ExitCode::ok;
}

ExitCode read_robot(const PlanRequest& request, const Messages& messages, PlanInputs& inputs) {
  const std::string& file = request.robot.robot.string();
  Result<LoadedRobot> loaded = load_robot(request.robot.robot, robot_load_options(request.reading));
  if (!loaded) return complain(file, loaded.error(), ExitCode::unreadable_input);
  warn_of_protection(file, loaded->model.report, messages);
  for (const RobotFinding& finding : loaded->findings)
    if (finding.severity == RobotSeverity::warning)
      messages.warn(file + ": " + (finding.place.empty() ? "" : finding.place + ": ") +
                    finding.text);
  std::vector<std::string> names;
  for (const RobotLink& link : loaded->robot.links) names.push_back(link.name);
  inputs.tool.blade = {find_link(loaded->robot, request.robot.link), request.robot.base,
                       request.robot.tip};
  if (inputs.tool.blade.link == kNone)
    return complain("--blade",
                    Status::failure(StatusCode::not_found, kNone, "the robot has no link '%.80s'",
                                    request.robot.link.c_str()),
                    ExitCode::usage, name_advice(request.robot.link, "links", names));
  if (loaded->model.character != nullptr) {
    Result<std::vector<BoneCollider>> shapes =
        fit_colliders(*loaded->model.character, 0, kShapesPerLink);
    if (!shapes) return complain(file, shapes.error(), ExitCode::unreadable_input);
    inputs.tool.shapes = std::move(*shapes);
  }
  inputs.tool.robot = std::move(loaded->robot);
  inputs.tool.world_from_root = request.robot.place * loaded->model_from_root;
  return ExitCode::ok;
}

}  // namespace sunder::tools
