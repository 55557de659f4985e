// A robot arm of two links, made by code, presses into a soft tube that bends, and cuts it.

#include <sunder/robot/trajectory.h>
#include <sunder/scene/character_instance.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <memory>
#include <vector>

#include "samples/tube.h"

namespace {

using sunder::Affine3d;
using sunder::Vec3d;

constexpr double kLink = 0.5;         ///< Length of each link, metres.
constexpr double kLinkRadius = 0.02;  ///< Of the capsule around a link, metres.
constexpr double kFrame = 1.0 / 60;
constexpr std::uint32_t kForearm = 2;  ///< Link.

int fail(const char* what, const sunder::Status& status) {
  std::printf("%s: %s\n", what, status.text().data());
  return 1;
}

/// Links along x, joints about z, in the plane z = 0.
sunder::Robot make_arm() {
  sunder::Robot arm;
  arm.name = "two links";
  arm.links = {{"base", sunder::kNone}, {"upper", 0}, {"fore", 1}};
  for (const char* const name : {"shoulder", "elbow"}) {
    const auto index = static_cast<std::uint32_t>(arm.joints.size());
    sunder::RobotJoint joint;
    joint.name = name;
    joint.type = sunder::RobotJointType::revolute;
    joint.axis = Vec3d::UnitZ();
    joint.parent_from_joint.translation() = Vec3d(index == 0 ? 0.0 : kLink, 0, 0);
    joint.first_value = index;
    joint.lower = -3;
    joint.upper = 3;
    arm.joints.push_back(joint);
    arm.values.push_back({name, index, joint.lower, joint.upper, 0.0});
  }
  return arm;
}

/// The end of the forearm goes down along x = 0.67 of the arm's plane, within two seconds.
sunder::RobotTrajectory make_trajectory() {
  sunder::RobotTrajectory trajectory;
  trajectory.names = {"shoulder", "elbow"};
  for (int i = 0; i <= 100; ++i) {
    const double x = 0.67, y = 0.2 - 0.4 * i / 100;
    const double elbow = std::acos((x * x + y * y) / (2 * kLink * kLink) - 1);
    const double shoulder = std::atan2(y, x) - elbow / 2;
    trajectory.times.push_back(0.02 * i);
    trajectory.values.insert(trajectory.values.end(), {shoulder, elbow});
  }
  return trajectory;
}

/// The arm stands in front of the tube (+z) and reaches towards it: its x is the world's -z.
Affine3d arm_place() {
  Affine3d world_from_root = Affine3d::Identity();
  world_from_root.linear().col(0) = -Vec3d::UnitZ();
  world_from_root.linear().col(1) = Vec3d::UnitY();
  world_from_root.linear().col(2) = Vec3d::UnitX();
  world_from_root.translation() = Vec3d(0, 0.55, 0.84);
  return world_from_root;
}

/// A capsule along the x axis of a link's frame.
sunder::Collider capsule_of(const Affine3d& world_from_link) {
  const sunder::Quatd y_to_x(0.7071067811865476, 0, 0, -0.7071067811865476);
  return {sunder::Collider::Capsule{kLinkRadius, kLink / 2},
          world_from_link * Vec3d(kLink / 2, 0, 0),
          sunder::Quatd(sunder::Mat3d(world_from_link.linear())) * y_to_x, 0.2};
}

sunder::Result<sunder::CharacterInstance> make_soft_tube() {
  sunder::CharacterAssetOptions options;
  options.soft.emplace();
  options.soft->materials = {sunder::find_material("fat").value()};
  options.soft->decomposition.range = options.soft->materials[0].range / 2;
  return sunder::CharacterInstance::create(
      std::make_shared<const sunder::Character>(samples::make_tube({32, 60})), options);
}

/// The arm and the tube in one world, frame by frame.
class Scene {
 public:
  Scene(const sunder::RobotMotion& motion, const sunder::BladeSweep& sweep,
        sunder::CharacterInstance& tube)
      : motion_(motion), sweep_(sweep), tube_(tube), frames_(motion.link_count()) {}

  sunder::Status start() {
    if (auto status = tube_.prepare_to_tear(); !status) return status;
    if (auto status = motion_.pose_at(0, frames_, arm_place()); !status) return status;
    const std::array<sunder::Collider, 2> links = {capsule_of(frames_[1]), capsule_of(frames_[2])};
    return tube_.body()->set_colliders(links);
  }

  /// Moves the arm, whose links push the tissue, and draws the blade on in the pose of the moment.
  sunder::Status frame(double time) {
    if (auto status = motion_.pose_at(time, frames_, arm_place()); !status) return status;
    for (std::uint32_t link = 1; link <= kForearm; ++link) {
      const sunder::Collider posed = capsule_of(frames_[link]);
      if (auto status = tube_.body()->move_collider(link - 1, posed.place, posed.turn); !status)
        return status;
    }
    const sunder::ModelPose pose = samples::bent(tube_.character(), 0.05 * time);
    if (auto status = tube_.advance(pose, kFrame); !status) return status;
    for (; next_ < sweep_.times.size() && sweep_.times[next_] <= time; ++next_)
      if (auto status = draw(pose, sweep_.blades[next_]); !status) return status;
    for (const sunder::Vec4f& d : tube_.body()->displacements())
      dent = std::max(dent, double{d.head<3>().norm()});
    deepest = std::max(deepest, tube_.body()->contacts().deepest);
    return {};
  }

  double dent = 0, deepest = 0;

 private:
  sunder::Status draw(const sunder::ModelPose& pose, const sunder::Blade& blade) {
    if (next_ == 0) return tube_.begin_stroke(pose, blade);
    return tube_.extend_stroke(pose, blade, sweep_.times[next_]).error();
  }

  const sunder::RobotMotion& motion_;
  const sunder::BladeSweep& sweep_;
  sunder::CharacterInstance& tube_;
  std::vector<Affine3d> frames_;
  std::size_t next_ = 0;
};

}  // namespace

int main() {
  const auto motion = sunder::RobotMotion::create(make_arm(), make_trajectory());
  if (!motion) return fail("motion", motion.error());
  // The blade continues the forearm by seven centimetres.
  const auto sweep =
      sunder::sweep_blade(*motion, {kForearm, {kLink, 0, 0}, {kLink + 0.07, 0, 0}}, arm_place());
  if (!sweep) return fail("sweep", sweep.error());
  auto tube = make_soft_tube();
  if (!tube) return fail("tube", tube.error());

  Scene scene(*motion, *sweep, *tube);
  if (const auto status = scene.start(); !status) return fail("colliders", status);
  for (int i = 0; i <= 121; ++i)
    if (const auto status = scene.frame(kFrame * i); !status) return fail("frame", status);
  const auto report = tube->end_stroke();
  if (!report) return fail("end", report.error());
  std::printf("%zu blades; %.3f m of tear in %u runs\n", sweep->blades.size(), report->length_posed,
              report->runs);
  std::printf("the links pushed the tissue by %.1f mm; it was inside them by %.2f mm at most\n",
              1e3 * scene.dent, 1e3 * scene.deepest);
  const bool held = report->runs == 1 && report->length_posed > 0.3 && scene.dent > 0.003 &&
                    scene.deepest < 0.005;
  std::puts(held ? "the arm cut the tube that it pressed" : "the arm did NOT do what it should");
  return held ? 0 : 1;
}
