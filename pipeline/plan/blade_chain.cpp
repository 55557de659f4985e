#include "pipeline/plan/blade_chain.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "io/robot/internal/planar_axes.h"

namespace sunder::plan {
namespace {

Status check_blade(const PlanTool& tool) {
  const MountedBlade& blade = tool.blade;
  if (blade.link >= tool.robot.links.size())
    return Status::failure(StatusCode::index_out_of_range, blade.link,
                           "link %u does not exist; the robot has %zu", blade.link,
                           tool.robot.links.size());
  if (!blade.base.allFinite() || !blade.tip.allFinite() ||
      !tool.world_from_root.matrix().allFinite())
    return Status::failure(StatusCode::non_finite_value, kNone,
                           "the blade or the place of the robot is not finite");
  if (blade.base == blade.tip)
    return Status::failure(StatusCode::invalid_argument, kNone,
                           "base and tip of the blade are at one place");
  return {};
}

}  // namespace

BladeChain::BladeChain(const PlanTool& tool, RobotKinematics kinematics)
    : robot_(tool.robot),
      blade_(tool.blade),
      world_from_root_(tool.world_from_root),
      kinematics_(std::move(kinematics)),
      values_(rest_values(tool.robot)),
      frames_(tool.robot.links.size()) {}

Result<BladeChain> BladeChain::create(const PlanTool& tool) {
  Result<RobotKinematics> kinematics = RobotKinematics::create(tool.robot);
  if (!kinematics) return kinematics.error();
  if (const Status status = check_blade(tool); !status) return status;
  BladeChain chain(tool, std::move(*kinematics));
  if (const Status status = chain.find_values(); !status) return status;
  chain.find_speed_limits();
  return chain;
}

Status BladeChain::find_values() {
  for (std::uint32_t link = blade_.link; link != 0; link = robot_.links[link].parent) {
    const RobotJoint& joint = robot_.joints[link - 1];
    if (joint.type == RobotJointType::floating && joint.first_value != kNone)
      return Status::failure(StatusCode::unsupported_feature, link - 1,
                             "joint '%.80s' is floating; a blade cannot be planned behind it",
                             joint.name.c_str());
    if (joint.type == RobotJointType::fixed || joint.first_value == kNone) continue;
    for (std::uint32_t i = 0; i < value_count_of(joint.type); ++i)
      moved_.push_back(joint.first_value + i);
  }
  if (moved_.empty())
    return Status::failure(StatusCode::invalid_argument, blade_.link,
                           "no joint moves link '%.80s', which carries the blade",
                           robot_.links[blade_.link].name.c_str());
  std::sort(moved_.begin(), moved_.end());
  moved_.erase(std::unique(moved_.begin(), moved_.end()), moved_.end());
  place_of_value_.assign(robot_.values.size(), kNone);
  for (std::uint32_t i = 0; i < moved_.size(); ++i) place_of_value_[moved_[i]] = i;
  return {};
}

void BladeChain::find_speed_limits() {
  speed_limits_.assign(moved_.size(), 0.0);
  for (const RobotJoint& joint : robot_.joints) {
    if (joint.first_value == kNone || joint.velocity <= 0 || joint.multiplier == 0) continue;
    const std::uint32_t count = value_count_of(joint.type);
    const double limit = joint.velocity / std::abs(joint.multiplier);
    for (std::uint32_t i = 0; i < count; ++i) {
      const std::uint32_t place = place_of_value_[joint.first_value + i];
      if (place == kNone) continue;
      double& known = speed_limits_[place];
      known = known > 0 ? std::min(known, limit) : limit;
    }
  }
}

Values BladeChain::rest() const {
  Values rest(static_cast<Eigen::Index>(moved_.size()));
  for (std::size_t i = 0; i < moved_.size(); ++i)
    rest[static_cast<Eigen::Index>(i)] = robot_.values[moved_[i]].rest;
  return rest;
}

void BladeChain::add_rates(const RobotJoint& joint, std::uint32_t parent, const Vec3d& at,
                           PlaceRates& rates) const {
  const Affine3d world_from_joint = frames_[parent] * joint.parent_from_joint;
  const Mat3d turn = world_from_joint.linear();
  const std::uint32_t column = place_of_value_[joint.first_value];
  const auto slide = [&](std::uint32_t of, const Vec3d& along, double by) {
    rates.col(of) += by * along;
  };
  const auto rotate = [&](std::uint32_t of, const Vec3d& axis, const Vec3d& origin, double by) {
    rates.col(of) += by * axis.cross(Vec3d(at - origin));
  };
  const Vec3d axis = turn * joint.axis, origin = world_from_joint.translation();
  switch (joint.type) {
    case RobotJointType::revolute:
    case RobotJointType::continuous: return rotate(column, axis, origin, joint.multiplier);
    case RobotJointType::prismatic: return slide(column, axis, joint.multiplier);
    case RobotJointType::planar: {
      const robot::PlanarAxes axes = robot::planar_axes(joint.axis);
      const Vec3d x = turn * axes.x, y = turn * axes.y;
      slide(column, x, 1);
      slide(column + 1, y, 1);
      const Vec3d centre =
          origin + values_[joint.first_value] * x + values_[joint.first_value + 1] * y;
      return rotate(column + 2, axis, centre, 1);
    }
    case RobotJointType::fixed:
    case RobotJointType::floating: return;
  }
}

void BladeChain::place(std::span<const double> values, BladePlace& place, bool with_rates) {
  for (std::size_t i = 0; i < moved_.size(); ++i) values_[moved_[i]] = values[i];
  // Fails for a wrong size or number only; numbers that are not finite give such places.
  if (!kinematics_.evaluate(values_, frames_, world_from_root_)) {
    place.base = place.tip = Vec3d::Constant(std::numeric_limits<double>::quiet_NaN());
    return;
  }
  const Affine3d& world_from_link = frames_[blade_.link];
  place.base = world_from_link * blade_.base;
  place.tip = world_from_link * blade_.tip;
  if (!with_rates) return;
  place.base_rates = rates_of(blade_.link, place.base);
  place.tip_rates = rates_of(blade_.link, place.tip);
}

PlaceRates BladeChain::rates_of(std::uint32_t link, const Vec3d& at) const {
  PlaceRates rates = PlaceRates::Zero(3, static_cast<Eigen::Index>(size()));
  for (; link != 0; link = robot_.links[link].parent) {
    const RobotJoint& joint = robot_.joints[link - 1];
    const bool moves = joint.first_value != kNone && joint.type != RobotJointType::fixed &&
                       place_of_value_[joint.first_value] != kNone;
    if (moves) add_rates(joint, robot_.links[link].parent, at, rates);
  }
  return rates;
}

}  // namespace sunder::plan
