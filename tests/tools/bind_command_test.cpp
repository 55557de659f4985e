// `sunder bind` from the outside: exit codes, words, JSON, and what it leaves on disk.

#include <sunder/skinning/pose.h>

#include <algorithm>
#include <set>

#include "support/machine/gltf_validator.h"
#include "support/models/rigs.h"
#include "tools/command_fixture.h"

namespace sunder::command_test {
namespace {

/// The cactus as one rigid model: no bone moves it.
Character stiff_cactus() {
  Character character = tools::make_cactus();
  Bone node;
  node.name = "Plant";
  character.skeleton.bones = {node};
  character.skins = {{"Plant", {0}, {Affine3f::Identity()}}};
  character.clips.clear();
  const std::vector<Influence> all = {{0, 1.0f}};
  for (Mesh& mesh : character.meshes) {
    mesh.skin = 0;
    mesh.weights = {};
    for (Index v = 0; v < mesh.vertex_count(); ++v) mesh.weights.append(all);
  }
  return character;
}

Character renamed_cactus() {
  Character character = tools::make_cactus();
  for (Bone& bone : character.skeleton.bones) bone.name = "link_" + bone.name;
  return character;
}

class BindCommand : public CommandSuite {
 protected:
  static void SetUpTestSuite() {
    CommandSuite::SetUpTestSuite();
    ASSERT_TRUE(save_glb(source(), tools::make_cactus()));
    ASSERT_TRUE(save_glb(stiff(), stiff_cactus()));
    ASSERT_TRUE(save_glb(robot(), renamed_cactus()));
  }
  static std::string source() { return path("source.glb"); }
  static std::string stiff() { return path("stiff.glb"); }
  static std::string robot() { return path("robot.glb"); }
  static Character load(const std::string& name) {
    const auto loaded = load_character(path(name));
    EXPECT_TRUE(loaded) << loaded.error().text();
    return loaded ? *loaded->character : Character();
  }
  static std::string map_of_all() {
    json map = json::object();
    for (const Bone& bone : tools::make_cactus().skeleton.bones)
      map[bone.name] = "link_" + bone.name;
    return write("map.json", map.dump());
  }
  static std::set<std::string> bone_names(const Character& character) {
    std::set<std::string> names;
    for (const Bone& bone : character.skeleton.bones) names.insert(bone.name);
    return names;
  }
  static void expect_valid(const std::string& name) {
    if (!test::has_gltf_validator()) return;
    const auto verdict = test::validate_glb(path(name));
    EXPECT_EQ(verdict.errors, 0) << verdict.output;
  }
};

TEST_F(BindCommand, automatic_weights_move_a_stiff_model_by_the_skeleton) {
  const CommandResult result = run_sunder({"bind", stiff(), "--skeleton", robot(), "-o",
                                           path("bound.glb"), "--report", path("r.json")});
  ASSERT_LE(result.exit_code, 1) << result.err << result.out;
  EXPECT_THAT(result.out, HasSubstr("by automatic weights"));
  const json report = read_json("r.json");
  EXPECT_EQ(report["sunder_bind"], 1);
  EXPECT_EQ(report["method"], "heat");
  EXPECT_GT(report["heated_points"], 0);
  EXPECT_LE(report["largest_shape_error"], 1e-6);

  const Character bound = load("bound.glb"), before = load("stiff.glb");
  EXPECT_THAT(bone_names(bound), testing::IsSupersetOf(bone_names(renamed_cactus())));
  EXPECT_FALSE(bone_names(bound).contains("Plant"));
  EXPECT_EQ(bound.clips.size(), renamed_cactus().clips.size());
  ASSERT_EQ(bound.meshes.size(), before.meshes.size());
  for (Index m = 0; m < bound.meshes.size(); ++m) {
    EXPECT_EQ(bound.meshes[m].positions, before.meshes[m].positions);
    EXPECT_EQ(bound.meshes[m].submeshes.size(), before.meshes[m].submeshes.size());
  }
  expect_valid("bound.glb");
  const CommandResult judged =
      run_sunder({"validate", path("bound.glb"), path("bound.glb"), "--fail-on", "error"});
  EXPECT_EQ(judged.exit_code, 0) << judged.out << judged.err;
}

TEST_F(BindCommand, a_map_keeps_the_weights_and_the_shape) {
  const CommandResult result =
      run_sunder({"bind", source(), "--skeleton", robot(), "--map", map_of_all(), "--pose", "bind",
                  "-o", path("mapped.glb"), "--report", path("r.json")});
  ASSERT_EQ(result.exit_code, 1) << result.err << result.out;  // clips are left out
  EXPECT_THAT(result.err, HasSubstr("clip"));
  EXPECT_EQ(read_json("r.json")["method"], "map");
  EXPECT_LE(read_json("r.json")["farthest_distance"], 1e-5);
  const Character mapped = load("mapped.glb"), truth = load("robot.glb");
  const auto pose = bind_pose(truth);
  for (Index m = 0; m < mapped.meshes.size(); ++m) {
    const auto of_mapped = test::posed_positions(mapped, m, *bind_pose(mapped));
    const auto expected = test::posed_positions(load("source.glb"), m, *bind_pose(truth));
    ASSERT_EQ(of_mapped.size(), expected.size());
    for (std::size_t v = 0; v < expected.size(); ++v)
      EXPECT_LE((of_mapped[v] - expected[v]).norm(), 1e-4);
  }
  expect_valid("mapped.glb");
}

TEST_F(BindCommand, a_place_moves_the_model) {
  const CommandResult result =
      run_sunder({"bind", stiff(), "--skeleton", robot(), "--place", "1,2,3,0,90,0,0.5", "-o",
                  path("placed.glb"), "--report", path("r.json")});
  ASSERT_EQ(result.exit_code, 1) << result.err << result.out;
  EXPECT_THAT(result.err, HasSubstr("does the model stand on the rig?"));
  const json place = read_json("r.json")["place"];
  EXPECT_NEAR(place[0][2], 0.5, 1e-12);
  EXPECT_NEAR(place[2][0], -0.5, 1e-12);
  EXPECT_EQ(place[1][3], 2.0);
  for (const char* const text :
       {"1,2", "1,2,3,4", "1,2,x", "1,2,3,", "1,2,3,0,0,0,0", "1,2,3,0,0,0,-1", "nan,0,0", ""})
    EXPECT_EQ(run_sunder({"bind", stiff(), "--skeleton", robot(), "--place", text, "-o",
                          path("never.glb")})
                  .exit_code,
              2)
        << text;
  EXPECT_FALSE(exists("never.glb"));
}

TEST_F(BindCommand, a_robot_is_a_skeleton_in_a_pose_of_its_joints) {
  const std::string arm = std::string(SUNDER_SOURCE_DIR) + "/docs/pictures/robot/arm.urdf";
  const auto bind = [&](const std::string& joints) {
    return run_sunder({"bind", stiff(), "--skeleton", arm, "--joints", joints, "--place", "0.4,0,0",
                       "-o", path("on_arm.glb"), "--report", path("r.json")});
  };
  const CommandResult result = bind("shoulder=0.5,elbow=-0.7");
  ASSERT_LE(result.exit_code, 1) << result.err;
  const Character bound = load("on_arm.glb");
  EXPECT_THAT(bone_names(bound), testing::IsSupersetOf({"column", "upper", "fore", "scalpel"}));
  EXPECT_LE(read_json("r.json")["largest_shape_error"], 1e-6);
  expect_valid("on_arm.glb");
  EXPECT_THAT(bind("elbow=9").err, HasSubstr("'elbow' is 9; its limits are -2.6 and 2.6"));
  EXPECT_THAT(bind("elbwo=1").err, HasSubstr("did you mean 'elbow'"));
  EXPECT_THAT(bind("elbow").err, HasSubstr("expected NAME=VALUE"));
}

TEST_F(BindCommand, shapes_that_a_robot_lacks_are_told_and_its_links_stay) {
  const std::string link = "<visual><geometry><mesh filename=\"none.stl\"/></geometry></visual>";
  const std::string tree =
      "<joint name=\"j\" type=\"continuous\"><parent link=\"a\"/><child link=\"b\"/>"
      "<origin xyz=\"0 0 1\"/></joint></robot>";
  const auto bind = [&](const std::string& of_a) {
    const std::string robot =
        write("robot.urdf", "<robot name=\"r\"><link name=\"a\">" + of_a +
                                "</link><link name=\"b\">" + link + "</link>" + tree);
    return run_sunder({"bind", stiff(), "--skeleton", robot, "-o", path("on_robot.glb")});
  };
  const std::string box = "<visual><geometry><box size=\"1 1 1\"/></geometry></visual>";
  for (const std::string& of_a : {box, link}) {  // some meshes, none
    const CommandResult result = bind(of_a);
    EXPECT_EQ(result.exit_code, 1) << result.err;
    EXPECT_THAT(result.err, HasSubstr("link 'b': mesh_not_found"));
    EXPECT_THAT(bone_names(load("on_robot.glb")), testing::IsSupersetOf({"a", "b"}));
    expect_valid("on_robot.glb");
  }
}

TEST_F(BindCommand, names_are_blamed_on_what_has_them) {
  const std::string bone = tools::make_cactus().skeleton.bones[0].name;
  const std::string map = write("bad.json", "{\"" + bone + "\": \"nowhere\"}");
  EXPECT_THAT(
      run_sunder({"bind", source(), "--skeleton", robot(), "--map", map, "-o", path("never.glb")})
          .err,
      HasSubstr("bad.json: "));
  EXPECT_THAT(run_sunder({"bind", stiff(), "--skeleton", robot(), "--bones", "nowhere", "-o",
                          path("never.glb")})
                  .err,
              HasSubstr("--bones: "));
}

TEST_F(BindCommand, wrong_maps_are_refused_with_their_cause) {
  const auto bind = [&](const std::string& map, const std::vector<std::string>& more = {}) {
    std::vector<std::string> arguments = {"bind",  source(),         "--skeleton",
                                          robot(), "--map",          write("bad.json", map),
                                          "-o",    path("never.glb")};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run_sunder(arguments);
  };
  const std::string bone = tools::make_cactus().skeleton.bones[0].name;
  EXPECT_THAT(bind("[]").err, HasSubstr("not one JSON object"));
  EXPECT_THAT(bind("{\"" + bone + "\": 3}").err, HasSubstr("expected the name of a bone"));
  EXPECT_THAT(bind("{\"" + bone + "\": \"link_" + bone + "x\"}").err,
              HasSubstr("did you mean 'link_" + bone + "'"));
  EXPECT_EQ(bind("{}").exit_code, 2);
  EXPECT_EQ(bind("{}", {"--refuse-unmapped"}).exit_code, 2);
  EXPECT_EQ(bind("{}", {"--heat", "2"}).exit_code, 2);
  EXPECT_EQ(run_sunder({"bind", source(), "--skeleton", robot(), "-o", source()}).exit_code, 2);
  EXPECT_EQ(run_sunder({"bind", path("none.glb"), "--skeleton", robot(), "-o", path("never.glb")})
                .exit_code,
            3);
  EXPECT_FALSE(exists("never.glb"));
}

}  // namespace
}  // namespace sunder::command_test
