// The verbs with a robot as their model.

#include <algorithm>
#include <string>

#include "support/machine/gltf_validator.h"
#include "support/models/shared_models.h"
#include "tools/command_fixture.h"

namespace sunder::command_test {
namespace {

/// A box that turns on another one, and a joint that mimics nothing that exists.
constexpr const char* kArm = R"(<robot name="arm">
  <link name="base"><visual><geometry><box size="0.4 0.4 0.4"/></geometry></visual></link>
  <link name="upper"><visual><origin xyz="0 0 0.5"/><geometry><cylinder radius="0.1" length="1"/></geometry></visual></link>
  <link name="tool"/>
  <joint name="elbow" type="revolute"><origin xyz="0 0 0.2"/><parent link="base"/><child link="upper"/><axis xyz="0 1 0"/>
    <limit lower="-1" upper="2" effort="1" velocity="1"/></joint>
  <joint name="wrist" type="continuous"><origin xyz="0 0 1"/><parent link="upper"/><child link="tool"/><axis xyz="0 0 1"/>
    <mimic joint="nothing"/></joint>
</robot>)";

class RobotCommand : public CommandSuite {
 protected:
  static std::string arm() { return write("arm.urdf", kArm); }
};

TEST_F(RobotCommand, info_prints_the_tree_the_limits_and_the_findings) {
  const CommandResult result = run_sunder({"info", arm()});
  EXPECT_EQ(result.exit_code, 1) << "a finding is a warning";
  EXPECT_THAT(result.out, HasSubstr("robot      'arm': 3 links, 2 joints, 2 values"));
  EXPECT_THAT(result.out, HasSubstr("    'upper'  by 'elbow', revolute (0, 1, 0), -1 to 2 rad\n"));
  EXPECT_THAT(result.out, HasSubstr("      'tool'  by 'wrist', continuous (0, 0, 1)\n"));
  EXPECT_THAT(result.out,
              HasSubstr("warning     mimic_broken_reference, line 7, joint 'wrist': it mimics"));
  EXPECT_THAT(result.out, HasSubstr("bones      3"));
}

TEST_F(RobotCommand, info_writes_the_same_as_json) {
  const CommandResult result = run_sunder({"info", arm(), "--report", path("arm.json"), "--json"});
  EXPECT_EQ(result.exit_code, 1) << result.err;
  const json info = read_json("arm.json");
  EXPECT_EQ(info, json::parse(result.out));
  EXPECT_EQ(info["robot"]["links"].size(), 3u);
  EXPECT_EQ(info["robot"]["joints"][0]["upper"], 2.0);
  EXPECT_EQ(info["robot"]["values"][1]["name"], "wrist");
  EXPECT_TRUE(info["robot"]["values"][1]["upper"].is_null());
  EXPECT_EQ(info["findings"][0]["code"], "mimic_broken_reference");
  EXPECT_EQ(info["findings"][0]["line"], 7);
  EXPECT_EQ(info["meshes"].size(), 2u);
}

TEST_F(RobotCommand, info_of_a_refused_robot_still_has_its_findings) {
  const std::string file = write("bad.urdf", "<robot name=\"r\"><link/></robot>");
  const CommandResult result = run_sunder({"info", file, "--report", path("bad.json")});
  EXPECT_NE(result.exit_code, 0);
  EXPECT_THAT(result.out, HasSubstr("error       name_missing, line 1"));
  EXPECT_THAT(result.err, HasSubstr("it has no name"));
  const json info = read_json("bad.json");
  EXPECT_TRUE(info["robot"].is_null());
  EXPECT_EQ(info["findings"][0]["code"], "name_missing");
}

TEST_F(RobotCommand, info_describes_a_robot_without_shapes) {
  const std::string file = write("bare.urdf", "<robot name=\"r\"><link name=\"a\"/></robot>");
  const CommandResult result = run_sunder({"info", file});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.out, HasSubstr("1 links, 0 joints, 0 values"));
}

TEST_F(RobotCommand, package_roots_can_be_given_more_than_once) {
  std::filesystem::create_directories(path("roots/pack"));
  write("roots/pack/t.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  const std::string file =
      write("packed.urdf",
            "<robot name=\"r\"><link name=\"a\"><visual><geometry><mesh "
            "filename=\"package://pack/t.obj\"/></geometry></visual></link></robot>");
  const CommandResult without = run_sunder({"info", file});
  EXPECT_EQ(without.exit_code, 1);
  EXPECT_THAT(without.out, HasSubstr("package_unknown"));
  std::filesystem::create_directories(path("other"));
  const CommandResult with = run_sunder(
      {"info", file, "--package-root", path("other"), "--package-root", path("roots"), "--json"});
  EXPECT_EQ(with.exit_code, 0) << with.err;
  EXPECT_EQ(json::parse(with.out)["meshes"][0]["triangles"], 1);
}

TEST_F(RobotCommand, a_robot_is_torn_and_the_result_is_valid) {
  const std::string log = write("cut.json", R"({"sunder_operations": 1, "operations": [
    {"op": "cut", "plane": {"point": [0, 0.7, 0], "normal": [0, 1, 0]}}]})");
  const CommandResult result =
      run_sunder({"tear", arm(), "--ops", log, "-o", path("torn.glb"), "--report", path("t.json")});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  ASSERT_TRUE(exists("torn.glb"));
  // y is up: the cylinder stands on the box, and the cut opens it all around.
  const json untorn = json::parse(run_sunder({"info", arm(), "--json"}).out);
  EXPECT_EQ(read_json("t.json")["result"]["topology"]["components"].get<int>(),
            untorn["topology"]["components"].get<int>() + 1);
  if (test::has_gltf_validator()) {
    const test::ValidatorReport validity = test::validate_glb(path("torn.glb"));
    EXPECT_EQ(validity.errors, 0) << validity.output;
  }
  const CommandResult validated =
      run_sunder({"validate", arm(), path("torn.glb"), "--ops", log, "--report", path("v.json")});
  EXPECT_LE(validated.exit_code, 1) << validated.err;
  EXPECT_TRUE(exists("v.json"));
}

TEST_F(RobotCommand, limits_of_a_robot_certify_a_model_on_its_bones) {
  const std::string log = write("cut.json", R"({"sunder_operations": 1, "operations": [
    {"op": "cut", "plane": {"point": [0, 0.7, 0], "normal": [0, 1, 0]}}]})");
  ASSERT_EQ(run_sunder({"tear", arm(), "--ops", log, "-o", path("torn2.glb"), "--max-error", "1mm",
                        "--limits", arm()})
                .exit_code,
            0);
  const CommandResult unknown =
      run_sunder({"validate", path("torn2.glb"), path("torn2.glb"), "--limits",
                  write("x.urdf",
                        "<robot name=\"r\"><link "
                        "name=\"x\"/></robot>")});
  EXPECT_EQ(unknown.exit_code, 2);
  EXPECT_THAT(unknown.err, HasSubstr("no bone of the model has the name of a link"));
  const CommandResult known =
      run_sunder({"validate", path("torn2.glb"), path("torn2.glb"), "--limits", arm()});
  EXPECT_EQ(known.exit_code, 0) << known.err << known.out;
}

TEST_F(RobotCommand, limits_without_max_error_are_for_fits_only) {
  const CommandResult result = run_sunder(
      {"tear", arm(), "--ops", write("none.json", R"({"sunder_operations": 1, "operations": []})"),
       "--dry-run", "--limits", "clips"});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(result.err, HasSubstr("--max-error"));
}

TEST_F(RobotCommand, joints_of_a_picture_are_checked) {
  const auto refusal = [&](const std::string& joints) {
    const CommandResult result =
        run_sunder({"picture", arm(), "-o", path("p.png"), "--joints", joints});
    EXPECT_EQ(result.exit_code, 2);
    return result.err;
  };
  EXPECT_THAT(refusal("knee=1"), HasSubstr("'knee': the robot has no joint of that name"));
  EXPECT_THAT(refusal("elbow=3"), HasSubstr("its limits are -1 and 2"));
  EXPECT_THAT(refusal("elbwo=1"), HasSubstr("did you mean 'elbow'"));
  EXPECT_THAT(refusal("elbow"), HasSubstr("expected NAME=VALUE"));
  EXPECT_THAT(refusal("elbow=1,elbow=1"), HasSubstr("'elbow' occurs twice"));
}

}  // namespace
}  // namespace sunder::command_test
