#include "bench/plan/plan_cases.h"

#include <sunder/io/character_file.h>
#include <sunder/io/robot_file.h>
#include <sunder/skinning/pose.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numbers>

#include "pipeline/plan/target_path.h"
#include "plan/plan_scene.h"
#include "support/models/animated_rig.h"
#include "support/models/rigs.h"
#include "tools/demo/demo_rig.h"

namespace sunder::bench {
namespace {

namespace fs = std::filesystem;

const fs::path kShared = SUNDER_SHARED_MODELS;
constexpr std::uint32_t kShapesPerLink = 4;  ///< As in `sunder plan`.
constexpr double kHeight = 1.8;              ///< Metres, of a character of size 1.

MovingRig rig_of(const std::string& name, Character character) {
  MovingRig rig{name, std::make_shared<const Character>(std::move(character)), 1};
  rig.size = test::posed_diagonal(*rig.character, *rest_pose(*rig.character)) / kHeight;
  return rig;
}

void scale(Collider& collider, double size) {
  collider.place *= size;
  if (auto* const ball = std::get_if<Collider::Sphere>(&collider.shape)) ball->radius *= size;
  if (auto* const box = std::get_if<Collider::Box>(&collider.shape)) box->half_size *= size;
  if (auto* const capsule = std::get_if<Collider::Capsule>(&collider.shape)) {
    capsule->radius *= size;
    capsule->half_length *= size;
  }
}

/// The vertices of each link, whose meshes are bound where the links rest.
std::vector<std::vector<Vec3d>> link_vertices(const Character& shown, std::size_t links) {
  std::vector<std::vector<Vec3d>> vertices(links);
  for (const Mesh& mesh : shown.meshes) {
    const Skin& skin = shown.skins[mesh.skin];
    for (std::uint32_t v = 0; v < mesh.vertex_count(); ++v)
      for (const Influence& influence : mesh.weights.of(v))
        vertices[skin.bones[influence.slot]].push_back(
            (skin.bone_from_bind[influence.slot] * mesh.positions[v]).cast<double>());
  }
  return vertices;
}

/// The arm with all lengths scaled.
PlanTool scaled(PlanTool tool, double size) {
  for (RobotJoint& joint : tool.robot.joints) {
    joint.parent_from_joint.translation() *= size;
    if (joint.type != RobotJointType::prismatic) continue;
    joint.lower *= size;
    joint.upper *= size;
    joint.velocity *= size;
  }
  for (RobotValue& value : tool.robot.values)
    if (tool.robot.joints[value.joint].type == RobotJointType::prismatic) {
      value.lower *= size;
      value.upper *= size;
    }
  for (BoneCollider& of_link : tool.shapes) scale(of_link.collider, size);
  tool.blade.base *= size;
  tool.blade.tip *= size;
  return tool;
}

/// Places the arm such that its blade is at a sample.
bool place_arm(PlanCase& made, const plan::TargetSample& sample, const Vec3d& centre,
               test::Random& random) {
  const Robot& robot = made.tool.robot;
  made.middle_values = rest_values(robot);
  for (std::size_t i = 0; i < robot.values.size(); ++i) {
    const double low = std::max(robot.values[i].lower, -2.0);
    const double high = std::min(robot.values[i].upper, 2.0);
    made.middle_values[i] = low + random.uniform(0.15, 0.85) * (high - low);
  }
  const auto kinematics = RobotKinematics::create(robot);
  std::vector<Affine3d> frames(robot.links.size());
  if (!kinematics || !kinematics->evaluate(made.middle_values, frames)) return false;
  const Vec3d base = frames[made.tool.blade.link] * made.tool.blade.base;
  const Vec3d tip = frames[made.tool.blade.link] * made.tool.blade.tip;
  const Eigen::Vector3d handle = (base - tip).normalized(), wanted = sample.handle;
  const Eigen::Matrix3d to_wanted =
      Eigen::Quaterniond::FromTwoVectors(handle, wanted).toRotationMatrix();
  const double first = random.uniform(0, 2 * std::numbers::pi);
  double farthest = -1;
  for (int i = 0; i < 8; ++i) {  // the root as far from the character as the arm allows
    Affine3d place = Affine3d::Identity();
    place.linear() =
        Eigen::AngleAxisd(first + i * std::numbers::pi / 4, wanted).toRotationMatrix() * to_wanted;
    place.translation() = sample.place - sample.depth * sample.handle - place.linear() * tip;
    const double distance = (place.translation() - centre).norm();
    if (distance <= farthest) continue;
    farthest = distance;
    made.tool.world_from_root = place;
  }
  return true;
}

}  // namespace

std::vector<MovingRig> moving_rigs() {
  std::vector<MovingRig> rigs;
  rigs.push_back(rig_of("cactus", tools::make_cactus()));
  rigs.push_back(rig_of("tube", test::make_tube(60, 32, 4)));
  for (const char* const name :
       {"fox.glb", "mannequiny.glb", "cactoro.glb", "robot_expressive.glb"}) {
    auto loaded = load_character(kShared / "rigged" / name);
    if (loaded && !loaded->character->clips.empty())
      rigs.push_back(rig_of(name, *loaded->character));
  }
  test::Random random(17);
  for (int i = 0; rigs.size() < 10; ++i) {
    test::AnimatedRig wanted;
    wanted.bones = 3 + random.index(8);
    wanted.clips = 2;
    wanted.wildest = 0.8;
    rigs.push_back(rig_of("tree" + std::to_string(i), make_animated_rig(wanted, random)));
  }
  return rigs;
}

std::vector<Arm> arms() {
  struct File {
    const char* name;
    fs::path path;
    const char* link;
    Vec3d base, tip;
  };
  const fs::path urdf = kShared / "urdf";
  const File files[] = {
      {"six_axes",
       fs::path(SUNDER_SOURCE_DIR) / "docs/pictures/plan/arm.urdf",
       "tool",
       {0, 0, 0.14},
       {0, 0, 0.24}},
      {"dvrk_psm", urdf / "dvrk_psm/dvrk_psm.urdf", "PSM1_tool_tip_link", {0, 0, 0}, {0, 0, 0.05}},
      {"panda", urdf / "panda/panda.urdf", "panda_hand_tcp", {0, 0, 0}, {0, 0, 0.08}}};
  std::vector<Arm> found;
  for (const File& file : files) {
    RobotLoadOptions options;
    options.package_roots = {urdf};
    options.meshes.import_helper = SUNDER_IMPORT_HELPER;
    options.meshes.import_seconds = 120;
    const auto loaded = load_robot(file.path, options);
    if (!loaded) continue;
    Arm arm{file.name, {}, {}};
    arm.tool.robot = loaded->robot;
    arm.tool.blade = {find_link(arm.tool.robot, file.link), file.base, file.tip};
    const auto shapes = fit_colliders(*loaded->model.character, 0, kShapesPerLink);
    if (!shapes || arm.tool.blade.link == kNone) continue;
    arm.tool.shapes = *shapes;
    arm.vertices = link_vertices(*loaded->model.character, arm.tool.robot.links.size());
    found.push_back(std::move(arm));
  }
  return found;
}

std::optional<PlanCase> make_case(const std::vector<MovingRig>& rigs, const std::vector<Arm>& arms,
                                  std::uint64_t seed) {
  test::Random random(seed);
  PlanCase made;
  made.rig = rigs[seed % rigs.size()];
  const Arm& arm = arms[random.index(static_cast<std::uint32_t>(arms.size()))];
  made.arm = arm.name;
  made.tool = scaled(arm.tool, made.rig.size);
  made.vertices = arm.vertices;
  for (std::vector<Vec3d>& of_link : made.vertices)
    for (Vec3d& vertex : of_link) vertex *= made.rig.size;
  const Character& character = *made.rig.character;
  const Clip& clip =
      character.clips[random.index(static_cast<std::uint32_t>(character.clips.size()))];
  made.timing.pose = ClipPose{static_cast<std::uint32_t>(&clip - character.clips.data()),
                              random.uniform(0, 0.5) * static_cast<double>(clip.duration)};
  made.timing.clip_speed = 0.3;
  made.timing.cut = 2;
  made.timing.approach = made.timing.retreat = 0.6;
  made.timing.standoff = 0.02 * made.rig.size;
  const auto pose = make_pose(character, made.timing.pose);
  if (!pose) return {};
  const double length = random.uniform(0.06, 0.2) * made.rig.size;
  made.target.places = test::random_curve(made.rig.character, *pose, length, random);
  if (made.target.places.size() < 2) return {};
  made.target.depth = {0.01 * made.rig.size};
  const auto path = plan::TargetPath::create(made.rig.character, made.target, *pose);
  if (!path) return {};
  const auto samples = plan::sample_target(character, *path, made.timing, 200);
  if (!samples) return {};
  Vec3d centre = Vec3d::Zero(), low = Vec3d::Constant(1e30), high = -low;
  for (std::uint32_t mesh = 0; mesh < character.meshes.size(); ++mesh)
    for (const Vec3d& place : test::posed_positions(character, mesh, *pose)) {
      low = low.cwiseMin(place);
      high = high.cwiseMax(place);
    }
  centre = 0.5 * (low + high);
  if (!place_arm(made, (*samples)[100], centre, random)) return {};
  return made;
}

}  // namespace sunder::bench
