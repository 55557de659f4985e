#include "io/urdf/robot_model.h"

#include <memory>
#include <utility>
#include <vector>

#include "io/gltf/rigid_weights.h"
#include "io/gltf_write/new_document.h"

namespace sunder::urdf {
namespace {

Result<Skeleton> make_skeleton(const Robot& robot, const Affine3d& model_from_root) {
  const Result<RobotKinematics> kinematics = RobotKinematics::create(robot);
  if (!kinematics) return kinematics.error();
  std::vector<Affine3d> frames(robot.links.size());
  Pose pose;
  if (const Status status = kinematics->evaluate(rest_values(robot), frames, model_from_root);
      !status)
    return status;
  if (const Status status = pose_of_links(robot, frames, pose); !status) return status;
  Skeleton skeleton;
  for (std::size_t i = 0; i < robot.links.size(); ++i)
    skeleton.bones.push_back(
        {robot.links[i].name, robot.links[i].parent, pose.parent_from_bone[i]});
  return skeleton;
}

void add_meshes(std::vector<Mesh> of_link, Character& character) {
  for (std::uint32_t link = 0; link < of_link.size(); ++link) {
    Mesh& mesh = of_link[link];
    if (mesh.triangles.empty()) continue;
    const std::string& name = character.skeleton.bones[link].name;
    mesh.name = name;
    mesh.skin = static_cast<std::uint32_t>(character.skins.size());
    mesh.weights = gltf::rigid_weights(mesh.vertex_count());
    character.skins.push_back({name, {link}, {Affine3f::Identity()}});
    character.meshes.push_back(std::move(mesh));
  }
}

/// glTF nodes may be nested this deep.
constexpr std::uint32_t kMaximumDepth = 1024;

/// @return limit_exceeded with the first link that is too deep.
Status check_depth(const Robot& robot) {
  std::vector<std::uint32_t> depth;
  for (const RobotLink& link : robot.links) {
    depth.push_back(link.parent == kNone ? 1 : depth[link.parent] + 1);
    if (depth.back() > kMaximumDepth)
      return Status::failure(StatusCode::limit_exceeded,
                             static_cast<std::uint32_t>(depth.size() - 1),
                             "link '%.80s': a robot with meshes can have at most %u links in a row",
                             link.name.c_str(), kMaximumDepth);
  }
  return {};
}

}  // namespace

Affine3d y_up_from_z_up() {
  Affine3d turn = Affine3d::Identity();
  turn.linear() << 1, 0, 0, 0, 0, 1, 0, -1, 0;
  return turn;
}

Result<LoadedCharacter> make_model(const Robot& robot, LinkMeshes meshes,
                                   const Affine3d& model_from_root, const LoadOptions& options) {
  Character character;
  character.name = robot.name;
  Result<Skeleton> skeleton = make_skeleton(robot, model_from_root);
  if (!skeleton) return skeleton.error();
  character.skeleton = std::move(*skeleton);
  add_meshes(std::move(meshes.of_link), character);

  LoadedCharacter loaded;
  if (character.meshes.empty()) {
    loaded.character = std::make_shared<const Character>(std::move(character));
  } else {
    if (const Status status = check_depth(robot); !status) return status;
    // Read back, so that the character is what its document says, to the bit.
    LoadOptions reading = options;
    reading.strict = false;
    reading.keep_stored_influences = false;
    const std::size_t bone_count = character.skeleton.bones.size();
    auto read = load_glb(gltf::new_document(character, meshes.materials), reading);
    if (!read) return read;
    loaded = std::move(*read);
    if (loaded.character->skeleton.bones.size() != bone_count)
      return Status::failure(StatusCode::internal_error, kNone, "bones of the robot were changed");
    loaded.report.notes.clear();  // the findings say the same of the files themselves
  }
  loaded.report.format = "URDF by urdfdom";
  loaded.report.space = "metres, y up; converted from z up";
  return loaded;
}

}  // namespace sunder::urdf
