// A robot of a file tears a model of a file in the middle of its animation, and pushes it with its
// links.
//
//   robot_file MODEL ROBOT.urdf TRAJECTORY.csv LINK OUT.glb X Y Z [PACKAGE_ROOT]
//
// The blade reaches 6 cm along the z axis of the link's frame, up to its origin; the robot stands
// at X Y Z in the model's space. The clip of the model, if it has one, runs along.

#include <sunder/io/character_file.h>
#include <sunder/io/robot_file.h>
#include <sunder/io/trajectory_file.h>
#include <sunder/particles/fitted_colliders.h>
#include <sunder/scene/character_instance.h>
#include <sunder/skinning/pose.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <vector>

namespace {

constexpr double kFrame = 1.0 / 60, kBlade = 0.06;

int fail(const char* what, const sunder::Status& status) {
  std::printf("%s: %s\n", what, status.text().data());
  return 1;
}

/// The pose of the model at a time of its first clip.
sunder::Result<sunder::ModelPose> pose_at(const sunder::Character& model, double time) {
  if (model.clips.empty()) return sunder::rest_pose(model);
  return sunder::make_pose(model, sunder::ClipPose{std::uint32_t{0}, time});
}

std::vector<sunder::Collider> pose_links(const std::vector<sunder::BoneCollider>& links,
                                         const std::vector<sunder::Affine3d>& frames) {
  std::vector<sunder::Collider> posed;
  for (const sunder::BoneCollider& link : links)
    posed.push_back(posed_collider(link, frames[link.bone]));
  return posed;
}

/// Plays the motion: each frame moves the links, advances the tissue and extends the stroke.
sunder::Result<sunder::TearReport> play(sunder::CharacterInstance& model,
                                        const std::vector<sunder::BoneCollider>& links,
                                        const sunder::RobotMotion& motion,
                                        const sunder::BladeSweep& sweep,
                                        const sunder::Affine3d& world_from_root) {
  if (auto status = model.prepare_to_tear(); !status) return status;
  std::vector<sunder::Affine3d> frames(motion.link_count());
  std::size_t next = 0;
  for (double time = motion.first_time(); next < sweep.times.size(); time += kFrame) {
    if (auto status = motion.pose_at(time, frames, world_from_root); !status) return status;
    const std::vector<sunder::Collider> posed = pose_links(links, frames);
    if (time == motion.first_time()) {
      if (auto status = model.body()->set_colliders(posed); !status) return status;
    }
    for (std::uint32_t i = 0; i < posed.size(); ++i)
      (void)model.body()->move_collider(i, posed[i].place, posed[i].turn);
    const auto pose = pose_at(model.character(), time);
    if (!pose) return pose.error();
    if (auto status = model.advance(*pose, kFrame); !status) return status;
    for (; next < sweep.times.size() && sweep.times[next] <= time; ++next) {
      const sunder::Status status =
          next == 0 ? model.begin_stroke(*pose, sweep.blades[next])
                    : model.extend_stroke(*pose, sweep.blades[next], time).error();
      if (!status) return status;
    }
  }
  return model.end_stroke();
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 9) {
    std::puts("robot_file MODEL ROBOT.urdf TRAJECTORY.csv LINK OUT.glb X Y Z [PACKAGE_ROOT]");
    return 2;
  }
  const auto model = sunder::load_character(argv[1]);
  if (!model) return fail(argv[1], model.error());
  sunder::RobotLoadOptions load;
  if (argc > 9) load.package_roots = {argv[9]};
  const auto robot = sunder::load_robot(argv[2], load);
  if (!robot) return fail(argv[2], robot.error());
  const auto trajectory = sunder::load_trajectory(argv[3]);
  if (!trajectory) return fail(argv[3], trajectory.error());
  const auto motion = sunder::RobotMotion::create(robot->robot, *trajectory);
  if (!motion) return fail(argv[3], motion.error());
  for (const sunder::LimitExcess& excess : motion->excesses())
    std::printf("joint '%s' leaves its limits at %.3g s\n",
                robot->robot.values[excess.value].name.c_str(), excess.time);

  sunder::Affine3d place = robot->model_from_root;
  place.translation() += sunder::Vec3d(std::atof(argv[6]), std::atof(argv[7]), std::atof(argv[8]));
  const sunder::MountedBlade blade{find_link(robot->robot, argv[4]), {0, 0, -kBlade}, {0, 0, 0}};
  const auto sweep = sunder::sweep_blade(*motion, blade, place);
  if (!sweep) return fail(argv[4], sweep.error());
  const auto links = sunder::fit_colliders(*robot->model.character, 0.2);
  if (!links) return fail("colliders", links.error());

  sunder::CharacterAssetOptions options;
  options.soft.emplace();
  auto instance = sunder::CharacterInstance::create(model->character, options);
  if (!instance) return fail(argv[1], instance.error());
  const auto report = play(*instance, *links, *motion, *sweep, place);
  if (!report) return fail("tear", report.error());
  std::printf("%zu links push; %zu blades made %.3f m of tear\n", links->size(),
              sweep->blades.size(), report->length_posed);
  const auto status = save_glb(argv[5], instance->character(), *model);
  if (!status) return fail(argv[5], status);
  return report->runs > 0 ? 0 : 1;
}
