// Shapes of links: where they stand, their winding and colour, which files they may come from, and
// that a robot is a character like any other.

#include <sunder/io/robot_file.h>
#include <sunder/robot/robot_limits.h>
#include <sunder/skinning/pose.h>

#include <algorithm>
#include <filesystem>
#include <numbers>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "io/internal/base_colours.h"
#include "io/urdf/finding_kinds.h"
#include "support/machine/gltf_validator.h"
#include "support/machine/temporary_folder.h"
#include "support/models/random_robot.h"
#include "support/models/shared_models.h"

namespace sunder::test {
namespace {

namespace fs = std::filesystem;
using testing::Contains;
using testing::Field;
using testing::IsEmpty;
using testing::Not;

/// A closed tetrahedron with one long edge along x, as OBJ.
const std::string kTetrahedron =
    "v 0 0 0\nv 3 0 0\nv 0 2 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";

/// A triangle (0 0 0), (1 0 0), (0 2 3) as COLLADA.
std::string collada(const std::string& up_axis, const std::string& metres) {
  return "<?xml version=\"1.0\"?><COLLADA xmlns=\"http://www.collada.org/2005/11/COLLADASchema\" "
         "version=\"1.4.1\"><asset><unit name=\"u\" meter=\"" +
         metres + "\"/>" + (up_axis.empty() ? "" : "<up_axis>" + up_axis + "</up_axis>") +
         "</asset><library_geometries><geometry id=\"g\"><mesh><source id=\"p\"><float_array "
         "id=\"pa\" count=\"9\">0 0 0 1 0 0 0 2 3</float_array><technique_common><accessor "
         "source=\"#pa\" count=\"3\" stride=\"3\"><param name=\"X\" type=\"float\"/><param "
         "name=\"Y\" type=\"float\"/><param name=\"Z\" type=\"float\"/></accessor>"
         "</technique_common></source><vertices id=\"v\"><input semantic=\"POSITION\" "
         "source=\"#p\"/></vertices><triangles count=\"1\"><input semantic=\"VERTEX\" "
         "source=\"#v\" offset=\"0\"/><p>0 1 2</p></triangles></mesh></geometry>"
         "</library_geometries><library_visual_scenes><visual_scene id=\"s\"><node id=\"n\">"
         "<instance_geometry url=\"#g\"/></node></visual_scene></library_visual_scenes><scene>"
         "<instance_visual_scene url=\"#s\"/></scene></COLLADA>";
}

std::string link_with_shapes(const std::string& shapes) {
  return "<robot name=\"r\"><link name=\"a\">" + shapes + "</link></robot>";
}

std::string visual(const std::string& geometry, const std::string& rest = "") {
  return "<visual>" + rest + "<geometry>" + geometry + "</geometry></visual>";
}

double signed_volume(const Mesh& mesh) {
  double volume = 0;
  for (const Triangle& t : mesh.triangles)
    volume += mesh.positions[t[0]].cast<double>().dot(
                  mesh.positions[t[1]].cast<double>().cross(mesh.positions[t[2]].cast<double>())) /
              6;
  return volume;
}

std::pair<Vec3f, Vec3f> box_of(const Mesh& mesh) {
  Vec3f least = mesh.positions[0], most = least;
  for (const Vec3f& position : mesh.positions) {
    least = least.cwiseMin(position);
    most = most.cwiseMax(position);
  }
  return {least, most};
}

/// A folder with a mesh, and a robot of one link whose only mesh is asked for.
class UrdfMeshes : public testing::Test {
 protected:
  Mesh mesh_of(const std::string& urdf, const RobotLoadOptions& options = {}) {
    const auto loaded = load_robot(folder_.write("robot.urdf", urdf), options, &findings_);
    EXPECT_TRUE(loaded) << loaded.error().text();
    if (!loaded || loaded->model.character->meshes.size() != 1) return {};
    EXPECT_TRUE(validate_character(*loaded->model.character));
    return loaded->model.character->meshes[0];
  }

  void expect_box(const Mesh& mesh, const Vec3f& least, const Vec3f& most) {
    ASSERT_FALSE(mesh.positions.empty());
    const auto [low, high] = box_of(mesh);
    EXPECT_LT((low - least).norm(), 1e-5f) << low.transpose();
    EXPECT_LT((high - most).norm(), 1e-5f) << high.transpose();
  }

  TemporaryFolder folder_;
  std::vector<RobotFinding> findings_;
};

TEST_F(UrdfMeshes, solids_are_closed_and_face_outwards) {
  const Mesh box = mesh_of(link_with_shapes(visual("<box size=\"1 2 3\"/>")));
  EXPECT_NEAR(signed_volume(box), 6, 1e-5);
  expect_box(box, Vec3f(-0.5f, -1, -1.5f), Vec3f(0.5f, 1, 1.5f));
  const Mesh cylinder =
      mesh_of(link_with_shapes(visual("<cylinder radius=\"0.5\" length=\"2\"/>")));
  EXPECT_NEAR(signed_volume(cylinder), std::numbers::pi * 0.25 * 2, 0.02);
  expect_box(cylinder, Vec3f(-0.5f, -0.5f, -1), Vec3f(0.5f, 0.5f, 1));
  const Mesh sphere = mesh_of(link_with_shapes(visual("<sphere radius=\"0.5\"/>")));
  EXPECT_NEAR(signed_volume(sphere), 4.0 / 3 * std::numbers::pi / 8, 0.03);
  for (const Mesh& mesh : {box, cylinder, sphere})
    for (const Triangle& t : mesh.triangles) {
      const Vec3f normal = (mesh.positions[t[1]] - mesh.positions[t[0]])
                               .cross(Vec3f(mesh.positions[t[2]] - mesh.positions[t[0]]));
      EXPECT_GT(normal.norm(), 0);
      EXPECT_GT(normal.dot(mesh.normals[t[0]]), 0);
    }
}

TEST_F(UrdfMeshes, origins_and_scales_are_applied) {
  folder_.write("t.obj", kTetrahedron);
  const Mesh plain = mesh_of(link_with_shapes(visual("<mesh filename=\"t.obj\"/>")));
  expect_box(plain, Vec3f(0, 0, 0), Vec3f(3, 2, 1));
  EXPECT_NEAR(signed_volume(plain), 1, 1e-5);
  // Scaled, then turned by a quarter about z, then moved.
  const Mesh moved =
      mesh_of(link_with_shapes(visual("<mesh filename=\"t.obj\" scale=\"2 1 0.5\"/>",
                                      "<origin xyz=\"10 0 0\" rpy=\"0 0 1.5707963267948966\"/>")));
  expect_box(moved, Vec3f(8, 0, 0), Vec3f(10, 6, 0.5f));
  const Mesh mirrored =
      mesh_of(link_with_shapes(visual("<mesh filename=\"t.obj\" scale=\"-1 1 1\"/>")));
  expect_box(mirrored, Vec3f(-3, 0, 0), Vec3f(0, 2, 1));
  EXPECT_NEAR(signed_volume(mirrored), 1, 1e-5) << "the winding follows the mirror";
}

TEST_F(UrdfMeshes, several_shapes_are_one_mesh_of_the_link) {
  folder_.write("t.obj", kTetrahedron);
  const Mesh mesh =
      mesh_of(link_with_shapes(visual("<mesh filename=\"t.obj\"/>") +
                               visual("<box size=\"1 1 1\"/>", "<origin xyz=\"5 0 0\"/>")));
  EXPECT_EQ(mesh.name, "a");
  EXPECT_GE(mesh.submeshes.size(), 2u);
  EXPECT_NEAR(signed_volume(mesh), 2, 1e-5);
}

TEST_F(UrdfMeshes, the_unit_of_collada_is_applied_and_its_up_axis_is_not) {
  for (const char* const up : {"Z_UP", "Y_UP", "X_UP", ""}) {
    folder_.write("t.dae", collada(up, "0.1"));
    const Mesh mesh = mesh_of(link_with_shapes(visual("<mesh filename=\"t.dae\"/>")));
    expect_box(mesh, Vec3f(0, 0, 0), Vec3f(0.1f, 0.2f, 0.3f));
    const bool is_told = std::any_of(findings_.begin(), findings_.end(), [](const auto& finding) {
      return finding.code == "collada_up_axis";
    });
    EXPECT_EQ(is_told, std::string(up) != "Z_UP") << up;
  }
  RobotLoadOptions options;
  options.applies_collada_up_axis = true;
  folder_.write("t.dae", collada("Z_UP", "1"));
  expect_box(mesh_of(link_with_shapes(visual("<mesh filename=\"t.dae\"/>")), options),
             Vec3f(0, 0, 0), Vec3f(1, 2, 3));
  folder_.write("t.dae", collada("Y_UP", "1"));
  expect_box(mesh_of(link_with_shapes(visual("<mesh filename=\"t.dae\"/>")), options),
             Vec3f(0, -3, 0), Vec3f(1, 0, 2));
}

TEST_F(UrdfMeshes, packages_are_found_in_the_given_roots_only) {
  const TemporaryFolder root;
  fs::create_directories(root.path() / "pack" / "meshes");
  root.write("pack/meshes/t.obj", kTetrahedron);
  const std::string urdf =
      link_with_shapes(visual("<mesh filename=\"package://pack/meshes/t.obj\"/>"));
  EXPECT_TRUE(mesh_of(urdf).triangles.empty());
  EXPECT_THAT(findings_, Contains(Field(&RobotFinding::code, "package_unknown")));
  RobotLoadOptions options;
  options.package_roots = {folder_.path(), root.path()};
  EXPECT_EQ(mesh_of(urdf, options).triangles.size(), 4u);
  EXPECT_THAT(findings_, IsEmpty());
  options.package_roots = {root.path() / "pack"};
  EXPECT_EQ(mesh_of(urdf, options).triangles.size(), 4u) << "the package itself may be given";
  const std::string by_path = link_with_shapes(
      visual("<mesh filename=\"file://" + (root.path() / "pack/meshes/t.obj").string() + "\"/>"));
  EXPECT_EQ(mesh_of(by_path, options).triangles.size(), 4u);
  EXPECT_TRUE(mesh_of(by_path).triangles.empty());
  EXPECT_THAT(findings_, Contains(Field(&RobotFinding::code, "mesh_path_not_allowed")));
}

TEST_F(UrdfMeshes, links_lead_to_no_file_outside) {
  const TemporaryFolder outside;
  const fs::path secret = outside.write("t.obj", kTetrahedron);
  fs::create_symlink(secret, folder_.path() / "link.obj");
  EXPECT_TRUE(mesh_of(link_with_shapes(visual("<mesh filename=\"link.obj\"/>"))).triangles.empty());
  EXPECT_THAT(findings_, Contains(Field(&RobotFinding::code, "mesh_path_not_allowed")));
  RobotLoadOptions options;
  fs::create_directories(folder_.path() / "pack");
  options.package_roots = {folder_.path()};
  const std::string escape =
      "package://pack/../../" + outside.path().filename().string() + "/t.obj";
  EXPECT_TRUE(mesh_of(link_with_shapes(visual("<mesh filename=\"" + escape + "\"/>")), options)
                  .triangles.empty());
  EXPECT_THAT(findings_, Contains(Field(&RobotFinding::code, "mesh_path_not_allowed")));
}

TEST_F(UrdfMeshes, a_mesh_that_may_be_in_millimetres_is_told) {
  folder_.write("t.obj", kTetrahedron);
  const Mesh mesh = mesh_of(link_with_shapes(visual("<mesh filename=\"t.obj\" scale=\"4 4 4\"/>")));
  EXPECT_EQ(mesh.triangles.size(), 4u);
  EXPECT_THAT(findings_, Contains(Field(&RobotFinding::code, "mesh_huge")));
}

TEST_F(UrdfMeshes, broken_mesh_files_leave_the_link) {
  folder_.write("t.stl", "this is no STL file");
  EXPECT_TRUE(mesh_of(link_with_shapes(visual("<mesh filename=\"t.stl\"/>"))).triangles.empty());
  EXPECT_THAT(findings_, Contains(Field(&RobotFinding::code, "mesh_unreadable")));
}

TEST_F(UrdfMeshes, shapes_above_the_limit_are_refused) {
  RobotLoadOptions options;
  options.meshes.maximum_memory = 1000;
  const auto loaded =
      load_robot(folder_.write("robot.urdf", link_with_shapes(visual("<sphere radius=\"1\"/>"))),
                 options, &findings_);
  EXPECT_EQ(loaded.error().code(), StatusCode::limit_exceeded);
  EXPECT_THAT(findings_, Contains(Field(&RobotFinding::code, "shapes_too_large")));
}

/// A grid of that many squares a side, as OBJ.
std::string grid(int side) {
  std::string text;
  for (int y = 0; y <= side; ++y)
    for (int x = 0; x <= side; ++x)
      text += "v " + std::to_string(x) + " " + std::to_string(y) + " 0\n";
  for (int y = 0; y < side; ++y)
    for (int x = 0; x < side; ++x) {
      const int corner = y * (side + 1) + x + 1;
      text += "f " + std::to_string(corner) + " " + std::to_string(corner + 1) + " " +
              std::to_string(corner + side + 2) + " " + std::to_string(corner + side + 1) + "\n";
    }
  return text;
}

TEST_F(UrdfMeshes, one_mesh_that_is_shown_very_often_is_refused) {
  folder_.write("grid.obj", grid(60));
  const auto robot_with = [](int visuals) {
    std::string shapes;
    for (int i = 0; i < visuals; ++i) shapes += visual("<mesh filename=\"grid.obj\"/>");
    return link_with_shapes(shapes);
  };
  EXPECT_EQ(mesh_of(robot_with(20)).triangles.size(), 20u * 2 * 60 * 60);
  const auto loaded =
      load_robot(folder_.write("robot.urdf", robot_with(500)), RobotLoadOptions(), &findings_);
  EXPECT_EQ(loaded.error().code(), StatusCode::limit_exceeded);
  EXPECT_THAT(findings_, Contains(Field(&RobotFinding::code, "shapes_too_large")));
}

TEST_F(UrdfMeshes, colours_come_from_the_urdf_unless_the_mesh_has_its_own) {
  const std::string urdf =
      "<robot name=\"r\"><material name=\"red\"><color rgba=\"1 0 0 1\"/></material><link "
      "name=\"a\">" +
      visual("<box size=\"1 1 1\"/>", "<material name=\"red\"/>") + "</link></robot>";
  const auto loaded = load_robot(folder_.write("robot.urdf", urdf));
  ASSERT_TRUE(loaded) << loaded.error().text();
  const auto colours = read_base_colours(*loaded->model.source, 1 << 20);
  ASSERT_TRUE(colours);
  const Submesh& submesh = loaded->model.character->meshes[0].submeshes[0];
  EXPECT_EQ(submesh.name, "red");
  EXPECT_EQ(colours->materials.at(submesh.material).factor, Vec4f(1, 0, 0, 1));
}

TEST_F(UrdfMeshes, shapes_can_be_chosen) {
  const std::string urdf =
      link_with_shapes("<collision><geometry><box size=\"1 1 1\"/></geometry></collision>");
  EXPECT_EQ(mesh_of(urdf).triangles.size(), 12u);
  RobotLoadOptions options;
  options.shapes = RobotShapes::visual;
  EXPECT_TRUE(mesh_of(urdf, options).triangles.empty());
  options.shapes = RobotShapes::none;
  EXPECT_TRUE(mesh_of(urdf, options).triangles.empty());
}

// ---- The character

std::string two_links() {
  return "<robot name=\"r\"><link name=\"base\">" + visual("<box size=\"1 1 1\"/>") +
         "</link><link name=\"arm\">" + visual("<box size=\"1 1 1\"/>", "<origin xyz=\"1 0 0\"/>") +
         "</link><joint name=\"elbow\" type=\"revolute\"><origin xyz=\"0 0 1\" rpy=\"0.3 0 0\"/>"
         "<parent link=\"base\"/><child link=\"arm\"/><axis xyz=\"0 1 0\"/><limit lower=\"0.25\" "
         "upper=\"1\" effort=\"1\" velocity=\"1\"/></joint></robot>";
}

TEST(UrdfCharacter, bones_are_links_and_follow_the_kinematics) {
  const TemporaryFolder folder;
  const auto loaded = load_robot(folder.write("robot.urdf", two_links()));
  ASSERT_TRUE(loaded) << loaded.error().text();
  const Character& character = *loaded->model.character;
  ASSERT_EQ(character.skeleton.bones.size(), loaded->robot.links.size());
  for (std::size_t i = 0; i < character.skeleton.bones.size(); ++i) {
    EXPECT_EQ(character.skeleton.bones[i].name, loaded->robot.links[i].name);
    EXPECT_EQ(character.skeleton.bones[i].parent, loaded->robot.links[i].parent);
  }
  const auto kinematics = RobotKinematics::create(loaded->robot);
  std::vector<Affine3d> frames(2);
  EXPECT_EQ(rest_values(loaded->robot), std::vector<double>{0.25}) << "the limit nearest to zero";
  ASSERT_TRUE(kinematics->evaluate(rest_values(loaded->robot), frames, loaded->model_from_root));
  Pose pose;
  ASSERT_TRUE(pose_of_links(loaded->robot, frames, pose));
  for (std::size_t i = 0; i < frames.size(); ++i)
    EXPECT_TRUE(character.skeleton.bones[i].rest.rotation.isApprox(
        pose.parent_from_bone[i].rotation, 1e-6f))
        << i;
  // z of the robot is y of the model.
  EXPECT_NEAR((frames[1].translation() - Vec3d(0, 1, 0)).norm(), 0, 1e-12);
}

TEST(UrdfCharacter, a_saved_robot_passes_the_validator) {
  SUNDER_SKIP_WITHOUT_GLTF_VALIDATOR();
  const TemporaryFolder folder;
  const fs::path urdf = folder.write("robot.urdf", two_links());
  const auto loaded = load_character(urdf);
  ASSERT_TRUE(loaded) << loaded.error().text();
  EXPECT_EQ(loaded->report.format, "URDF by urdfdom");
  const fs::path glb = folder.path() / "robot.glb";
  ASSERT_TRUE(save_glb(glb, *loaded->character, *loaded));
  const ValidatorReport report = validate_glb(glb);
  EXPECT_EQ(report.errors, 0) << report.output;
}

TEST(UrdfCharacter, a_robot_without_shapes_is_no_model_for_load_character) {
  const TemporaryFolder folder;
  const auto loaded =
      load_character(folder.write("robot.urdf", "<robot name=\"r\"><link name=\"a\"/></robot>"));
  EXPECT_EQ(loaded.error().code(), StatusCode::empty_input);
}

TEST(UrdfCharacter, every_shared_robot_is_one) {
  SUNDER_SKIP_WITHOUT_SHARED_MODELS();
  LoadOptions options;
  options.roots = {shared_models() / "urdf"};
  for (const auto& file : files_below(shared_models() / "urdf", {".urdf"})) {
    const auto loaded = load_character(file, options);
    ASSERT_TRUE(loaded) << file << ": " << loaded.error().text();
    EXPECT_TRUE(validate_character(*loaded->character)) << file;
    for (const LoadNote& note : loaded->report.notes)
      EXPECT_EQ(note.kind, LoadNote::Kind::information) << note.place << ": " << note.text;
  }
}

// ---- Limits for certificates and fits

TEST(RobotLimitsOf, links_stay_within_their_joint_ranges) {
  const TemporaryFolder folder;
  const auto loaded = load_robot(folder.write("robot.urdf", two_links()));
  ASSERT_TRUE(loaded);
  const auto limits = joint_limits_of(loaded->robot);
  ASSERT_TRUE(limits) << limits.error().text();
  ASSERT_EQ(limits->of_bone.size(), 2u);
  EXPECT_EQ(limits->of_bone[0].angle, 0.0);
  EXPECT_EQ(limits->of_bone[1].turn, JointRange::Turn::hinge);
  EXPECT_EQ(limits->of_bone[1].axis, Vec3d(0, 1, 0));
  EXPECT_EQ(limits->of_bone[1].lower, 0.0);
  EXPECT_EQ(limits->of_bone[1].upper, 0.75);
  const auto bind = bind_pose(*loaded->model.character);
  ASSERT_TRUE(bind);
  EXPECT_TRUE(JointTree::create(loaded->model.character->skeleton, *bind, *limits));
  const auto turns = pose_limits_of(loaded->robot);
  ASSERT_TRUE(turns);
  ASSERT_EQ(turns->size(), 1u);
  EXPECT_EQ(turns->front().bone, 1u);
  EXPECT_EQ(turns->front().upper, 0.75);
}

TEST(RobotLimitsOf, hold_in_random_poses_of_random_robots) {
  const TemporaryFolder folder;
  Random random(5);
  for (int round = 0; round < 20; ++round) {
    const auto loaded =
        load_robot(folder.write("robot.urdf", random_urdf(random, 2 + random.index(12), 0.5)));
    ASSERT_TRUE(loaded);
    const Robot& robot = loaded->robot;
    const auto limits = joint_limits_of(robot);
    ASSERT_TRUE(limits) << limits.error().text();
    const auto kinematics = RobotKinematics::create(robot);
    std::vector<Affine3d> rest(robot.links.size()), posed(robot.links.size());
    ASSERT_TRUE(kinematics->evaluate(rest_values(robot), rest));
    ASSERT_TRUE(kinematics->evaluate(random_values(random, robot), posed));
    for (std::size_t i = 1; i < robot.links.size(); ++i) {
      const JointRange& range = limits->of_bone[i];
      const std::uint32_t parent = robot.links[i].parent;
      // The motion since rest, in the link's frame at rest.
      const Affine3d motion =
          (rest[parent].inverse() * rest[i]).inverse() * (posed[parent].inverse() * posed[i]);
      const Eigen::AngleAxisd turn(Eigen::Matrix3d(motion.linear()));
      if (range.turn == JointRange::Turn::hinge && turn.angle() > 1e-6) {
        const double sine = turn.axis().cross(Eigen::Vector3d(range.axis)).norm();
        EXPECT_LT(sine, 1e-5) << robot.joints[i - 1].name;
      } else if (range.turn == JointRange::Turn::ball) {
        EXPECT_LE(turn.angle(), range.angle + 1e-6) << robot.joints[i - 1].name;
      }
      if (std::isinf(range.slide_radius)) continue;
      const Vec3d along = range.slide_to - range.slide_from;
      const double length = along.squaredNorm();
      const Vec3d moved = motion.translation();
      const double share =
          length > 0 ? std::clamp((moved - range.slide_from).dot(along) / length, 0.0, 1.0) : 0.0;
      EXPECT_LT((moved - range.slide_from - share * along).norm(), 1e-9)
          << robot.joints[i - 1].name;
    }
  }
}

}  // namespace
}  // namespace sunder::test
