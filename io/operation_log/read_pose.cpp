#include "core/operation/internal/describe_weights.h"
#include "io/operation_log/read_fields.h"

namespace sunder::operation_log {
namespace {

BonesPose read_bones_pose(const Place& place) {
  place.check_fields({"bones"});
  const Place bones = place.at("bones");
  if (!bones.value.is_object()) bones.expected("an object");
  BonesPose pose;
  bones.for_each_field([&](const std::string& name, const Place& bone) {
    BonesPose::Bone read;
    read.name = name;
    read_fields(bone, read);
    if (name.empty()) bone.malformed("a bone's name must not be empty");
    pose.bones.push_back(std::move(read));
  });
  return pose;
}

template <class Pose>
Pose read_described(const Place& place) {
  Pose pose;
  read_fields(place, pose);
  return pose;
}

}  // namespace

PoseSpec read_pose(const Place& place) {
  if (place.value.is_string()) {
    if (place.value == kPoseName<RestPose>) return RestPose{};
    if (place.value == kPoseName<BindPose>) return BindPose{};
    place.malformed("expected \"rest\" or \"bind\"");
  }
  if (!place.value.is_object()) place.expected("\"rest\", \"bind\" or an object");
  if (place.has("bones")) return read_bones_pose(place);
  if (place.has("matrices")) return read_described<ModelPose>(place);
  return read_described<ClipPose>(place);
}

}  // namespace sunder::operation_log
