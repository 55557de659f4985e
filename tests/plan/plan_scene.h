#pragma once

#include <sunder/plan/plan.h>
#include <sunder/tear/torn_model.h>

#include <cmath>
#include <memory>
#include <vector>

#include "support/machine/random.h"
#include "support/models/rigs.h"

namespace sunder::test {

/// An arm of six turning joints with limits and speeds: shoulder (two), elbow, wrist (three). Its
/// root stands at the origin, y up. Link 6 carries a blade of 8 cm.
inline PlanTool six_axis_arm(const Vec3d& place) {
  PlanTool tool;
  Robot& robot = tool.robot;
  robot.name = "six axes";
  robot.links = {{"base", kNone}};
  struct Axis {
    const char* name;
    Vec3d axis, at;
    double limit, speed;
  };
  const Axis axes[] = {{"turn", Vec3d::UnitY(), Vec3d(0, 0.3, 0), 2.9, 2.5},
                       {"shoulder", Vec3d::UnitX(), Vec3d(0, 0, 0), 2.2, 2.5},
                       {"elbow", Vec3d::UnitX(), Vec3d(0, 0.5, 0), 2.6, 2.5},
                       {"roll", Vec3d::UnitY(), Vec3d(0, 0.4, 0), 3.0, 4},
                       {"bend", Vec3d::UnitX(), Vec3d(0, 0, 0), 2.1, 4},
                       {"twist", Vec3d::UnitY(), Vec3d(0, 0.1, 0), 3.0, 4}};
  for (const Axis& of : axes) {
    RobotJoint joint;
    joint.name = of.name;
    joint.type = RobotJointType::revolute;
    joint.axis = of.axis;
    joint.parent_from_joint.translation() = of.at;
    joint.first_value = static_cast<std::uint32_t>(robot.values.size());
    joint.lower = -of.limit;
    joint.upper = of.limit;
    joint.velocity = of.speed;
    robot.values.push_back(
        {of.name, static_cast<std::uint32_t>(robot.joints.size()), -of.limit, of.limit, 0});
    robot.links.push_back({of.name, static_cast<std::uint32_t>(robot.joints.size())});
    robot.joints.push_back(joint);
  }
  tool.blade = {6, Vec3d(0, 0.02, 0), Vec3d(0, 0.1, 0)};
  tool.world_from_root.translation() = place;
  return tool;
}

/// The places of a surface in a pose that are nearest to given ones.
inline std::vector<SurfaceAnchor> nearest_places(const std::shared_ptr<const Character>& character,
                                                 const ModelPose& pose,
                                                 const std::vector<Vec3d>& near) {
  std::vector<SurfaceAnchor> found;
  const auto model = TornModel::create(character);
  auto query = SurfaceQuery::create(*model);
  if (!query->set_pose(pose)) return found;
  for (const Vec3d& place : near) found.push_back((*query->find_nearest(place))->anchor);
  return found;
}

/// A random curve along a posed surface: it starts anywhere and bends evenly.
/// @return fewer than two places where the surface ends too soon.
inline std::vector<SurfaceAnchor> random_curve(const std::shared_ptr<const Character>& character,
                                               const ModelPose& pose, double length,
                                               Random& random) {
  std::vector<SurfaceAnchor> curve;
  const auto model = TornModel::create(character);
  auto query = SurfaceQuery::create(*model);
  if (!query->set_pose(pose)) return curve;
  const std::uint32_t mesh = random.index(static_cast<std::uint32_t>(character->meshes.size()));
  const SurfaceAnchor start{
      mesh, {random.index(character->meshes[mesh].triangle_count()), {0.3, 0.3, 0.4}}};
  const auto first = query->locate(start);
  if (!first || !first->has_value()) return curve;
  SurfaceContact at = **first;
  Vec3d along = random.direction();
  const double turn = random.uniform(-1.2, 1.2);
  constexpr int kSteps = 16;
  for (int i = 0; i <= kSteps; ++i) {
    curve.push_back(at.anchor);
    along = (along - along.dot(at.normal) * at.normal).normalized();
    along = Eigen::AngleAxisd(turn / kSteps, Eigen::Vector3d(at.normal)) * Eigen::Vector3d(along);
    const Vec3d wanted = at.place + length / kSteps * along;
    const auto next = query->find_nearest(wanted);
    if (!next || !next->has_value()) return {};
    if (((*next)->place - at.place).norm() < 0.5 * length / kSteps) return {};
    at = **next;
  }
  return curve;
}

}  // namespace sunder::test
