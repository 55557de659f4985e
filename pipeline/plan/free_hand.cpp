#include <sunder/plan/plan.h>
#include <sunder/skinning/pose.h>

#include <array>
#include <cmath>
#include <utility>

#include "core/internal/out_of_memory.h"
#include "pipeline/plan/target_path.h"

namespace sunder {
namespace {

Robot hand_robot() {
  Robot robot;
  robot.name = "hand";
  robot.links = {{"place", kNone}};
  const std::array<std::pair<const char*, Vec3d>, 6> joints = {{{"x", Vec3d::UnitX()},
                                                                {"y", Vec3d::UnitY()},
                                                                {"z", Vec3d::UnitZ()},
                                                                {"turn_x", Vec3d::UnitX()},
                                                                {"turn_y", Vec3d::UnitY()},
                                                                {"turn_z", Vec3d::UnitZ()}}};
  for (std::uint32_t i = 0; i < joints.size(); ++i) {
    RobotJoint joint;
    joint.name = joints[i].first;
    joint.type = i < 3 ? RobotJointType::prismatic : RobotJointType::continuous;
    joint.axis = joints[i].second;
    joint.first_value = i;
    robot.links.push_back({std::string("moved_") + joints[i].first, i});
    robot.values.push_back({joints[i].first, i});
    robot.joints.push_back(std::move(joint));
  }
  robot.links.back().name = "blade";
  return robot;
}

Result<Affine3d> hand_place(const std::shared_ptr<const Character>& character,
                            const WoundTarget& target, const PlanTiming& timing) {
  const Result<ModelPose> pose = make_pose(*character, timing.pose);
  if (!pose) return pose.error();
  const Result<plan::TargetPath> path = plan::TargetPath::create(character, target, *pose);
  if (!path) return path.error();
  plan::TargetSample middle, later;
  middle.share = 0.5;
  later.share = 0.51;
  plan::PosedPath posed;
  if (const Status status = path->pose(*pose, posed); !status) return status;
  path->sample(posed, 0, middle);
  path->sample(posed, 0, later);
  const Vec3d z = middle.normal;
  Vec3d x = Vec3d(later.place - middle.place).cross(z);
  x = x.norm() > 0 ? Vec3d(x.normalized()) : Vec3d(z.unitOrthogonal());
  Affine3d world_from_root = Affine3d::Identity();
  world_from_root.linear() << x, z.cross(x), z;
  world_from_root.translation() = middle.place;
  return world_from_root;
}

}  // namespace

Result<PlanTool> free_hand(const std::shared_ptr<const Character>& character,
                           const WoundTarget& target, const PlanTiming& timing, double length) {
  if (character == nullptr)
    return Status::failure(StatusCode::empty_input, kNone, "there is no character");
  if (!(length > 0) || !std::isfinite(length))
    return Status::failure(StatusCode::invalid_argument, kNone,
                           "the blade's length is %g; it must be above 0", length);
  return or_out_of_memory([&]() -> Result<PlanTool> {
    const Result<Affine3d> place = hand_place(character, target, timing);
    if (!place) return place.error();
    PlanTool tool;
    tool.robot = hand_robot();
    tool.blade = {6, Vec3d(0, 0, length), Vec3d::Zero()};
    tool.world_from_root = *place;
    return tool;
  });
}

}  // namespace sunder
