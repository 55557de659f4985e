#include "tools/written_weights/joint_limits_file.h"

#include <sunder/robot/robot.h>
#include <sunder/robot/robot_limits.h>
#include <sunder/skinning/pose.h>
#include <sunder/validation/validation.h>

#include <algorithm>
#include <map>
#include <numbers>
#include <string_view>

#include "tools/messages/json_file.h"
#include "tools/model/robot_joints.h"

namespace sunder::tools {
namespace {

double radians(const Json& degrees) { return degrees.get<double>() * std::numbers::pi / 180.0; }

/// A limit in degrees: {"angle": 60} for a ball, {"axis": [0, 0, 1], "lower": -10, "upper": 90}
/// for a hinge.
Status read_range(const Json& json, const std::string& bone, JointRange& range) {
  const auto is_number = [&](const char* name) {
    return json.contains(name) && json[name].is_number();
  };
  if (json.is_object() && is_number("angle")) {
    range.turn = JointRange::Turn::ball;
    range.angle = radians(json["angle"]);
    return {};
  }
  if (!json.is_object() || !is_number("lower") || !is_number("upper") || !json.contains("axis") ||
      !json["axis"].is_array() || json["axis"].size() != 3 ||
      !std::all_of(json["axis"].begin(), json["axis"].end(),
                   [](const Json& value) { return value.is_number(); }))
    return Status::failure(StatusCode::malformed_file, kNone,
                           "/limits/%.80s: expected angle, or axis, lower and upper", bone.c_str());
  range.turn = JointRange::Turn::hinge;
  for (int i = 0; i < 3; ++i)
    range.axis[i] = json["axis"][static_cast<std::size_t>(i)].get<double>();
  range.lower = radians(json["lower"]);
  range.upper = radians(json["upper"]);
  return {};
}

/// Those of a robot, for the bones that have the names of its links.
Result<JointLimits> limits_of_urdf(const std::filesystem::path& file, const Character& character) {
  const Result<Robot> robot = load_joints(file);
  if (!robot) return robot.error();
  const Result<JointLimits> of_links = joint_limits_of(*robot);
  if (!of_links) return of_links.error();
  const Result<ModelPose> bind = bind_pose(character);
  if (!bind) return bind.error();
  Result<JointLimits> limits = free_joint_limits(character, *bind);
  if (!limits) return limits.error();
  std::size_t found = 0;
  for (std::size_t bone = 0; bone < limits->of_bone.size(); ++bone) {
    const std::uint32_t link = find_link(*robot, character.skeleton.bones[bone].name);
    if (link == kNone) continue;
    limits->of_bone[bone] = of_links->of_bone[link];
    ++found;
  }
  if (found > 0) return limits;
  return Status::failure(StatusCode::not_found, kNone,
                         "no bone of the model has the name of a link of the robot");
}

}  // namespace

Result<JointLimits> read_joint_limits(const std::filesystem::path& file,
                                      const Character& character) {
  if (is_urdf(file)) return limits_of_urdf(file, character);
  const Result<Json> json = read_json_object(file);
  if (!json) return json.error();
  const Result<ModelPose> bind = bind_pose(character);
  if (!bind) return bind.error();
  Result<JointLimits> limits = free_joint_limits(character, *bind);
  if (!limits) return limits.error();
  const auto of_bones = json->find("limits");
  if (of_bones == json->end() || !of_bones->is_object())
    return Status::failure(StatusCode::malformed_file, kNone, "/limits: expected an object");
  const auto& bones = character.skeleton.bones;
  std::map<std::string_view, std::size_t> index_of;  // a name that several have: of the first
  for (std::size_t i = 0; i < bones.size(); ++i) index_of.emplace(bones[i].name, i);
  for (const auto& [name, range] : of_bones->items()) {
    const auto bone = index_of.find(name);
    if (bone == index_of.end())
      return Status::failure(StatusCode::not_found, kNone, "/limits: no bone '%.80s'",
                             name.c_str());
    if (const Status status = read_range(range, name, limits->of_bone[bone->second]); !status)
      return status;
  }
  return limits;
}

Result<JointLimits> joint_limits_named(const std::string& name, const Character& character,
                                       const ModelPose& bind) {
  if (name == "none") return free_joint_limits(character, bind);
  if (name != "clips") return read_joint_limits(name, character);
  if (character.clips.empty())
    return Status::failure(StatusCode::empty_input, kNone,
                           "the model has no clips that could limit its joints");
  return joint_limits_of_clips(character, bind, ValidationOptions{}.clip_margin);
}

}  // namespace sunder::tools
