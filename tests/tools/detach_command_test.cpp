// `sunder tear --pieces`: detached pieces as files.

#include "support/machine/gltf_validator.h"
#include "tools/command_fixture.h"

namespace sunder::command_test {
namespace {

class DetachCommand : public CactusSuite {};

/// The top comes off, is put back, and comes off again; a later detachment is undone.
const char* const kTwice = R"({"sunder_operations": 1, "operations": [
  {"op": "cut", "plane": {"point": [0, 1.2, 0], "normal": [0, 1, 0]}, "caps": true},
  {"op": "detach", "pose": {"clip": "Sway", "time": 0.8}, "piece": {"near": [0, 3, 0]}},
  {"op": "undo"}, {"op": "redo"},
  {"op": "cut", "plane": {"point": [0, 0.5, 0], "normal": [0, 1, 0]}, "caps": true},
  {"op": "detach", "piece": {"near": [0, 0.9, 0]}},
  {"op": "undo"}]})";

json topology_of(const std::string& file) {
  const CommandResult info = run_sunder({"info", file, "--json"});
  EXPECT_EQ(info.exit_code, 0) << info.err;
  return json::parse(info.out)["topology"];
}

TEST_F(DetachCommand, pieces_that_came_free_are_written) {
  for (const bool is_animated : {false, true}) {
    const std::string prefix = path(is_animated ? "animated" : "frozen");
    std::vector<std::string> arguments = {
        "tear", model(),    "--ops", write("twice.json", kTwice), "-o", prefix + ".glb", "--report",
        "-",    "--pieces", prefix};
    if (is_animated) arguments.push_back("--animated-pieces");
    const CommandResult result = run_sunder(arguments);
    ASSERT_EQ(result.exit_code, 0) << result.err;
    const json report = json::parse(result.out);
    const json& detached = report["operations"].at(1);
    EXPECT_EQ(detached["op"], "detach");
    EXPECT_EQ(detached["status"], "detached");
    EXPECT_GT(detached["triangles_retired"], 0);
    EXPECT_TRUE(std::filesystem::exists(prefix + "1.glb"));
    EXPECT_FALSE(std::filesystem::exists(prefix + "2.glb"));
    EXPECT_EQ(topology_of(prefix + "1.glb")["components"], 1);
    EXPECT_EQ(topology_of(prefix + "1.glb")["boundary_loops"], 0);
    if (test::has_gltf_validator()) {
      EXPECT_EQ(test::validate_glb(prefix + "1.glb").errors, 0);
    }
    const CommandResult info = run_sunder({"info", prefix + "1.glb", "--json"});
    EXPECT_EQ(json::parse(info.out)["clips"].empty(), !is_animated);
  }
}

TEST_F(DetachCommand, a_saved_log_gives_the_same_model) {
  const CommandResult first =
      run_sunder({"tear", model(), "--ops", write("once.json", kTwice), "-o", path("a.glb"),
                  "--save-log", path("saved.json"), "--report", path("a.json")});
  ASSERT_EQ(first.exit_code, 0) << first.err;
  const CommandResult second = run_sunder({"tear", model(), "--ops", path("saved.json"), "-o",
                                           path("b.glb"), "--report", path("b.json")});
  ASSERT_EQ(second.exit_code, 0) << second.err;
  EXPECT_EQ(read_json("a.json")["result"]["digest"], read_json("b.json")["result"]["digest"]);
}

TEST_F(DetachCommand, pieces_without_a_detach_are_said_to_be_none) {
  const CommandResult result =
      run_sunder({"tear", model(), "--ops", write("cut.json", R"({"sunder_operations": 1,
        "operations": [{"op": "cut", "plane": {"point": [0, 1.2, 0], "normal": [0, 1, 0]}}]})"),
                  "-o", path("cut.glb"), "--pieces", path("no_piece")});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.err, HasSubstr("--pieces: no piece was written"));
  EXPECT_FALSE(exists("no_piece1.glb"));
}

TEST_F(DetachCommand, faults_are_reported) {
  const CommandResult bone = run_sunder(
      {"tear", model(), "--ops", write("bone.json", R"({"sunder_operations": 1, "operations": [
        {"op": "detach", "piece": {"near": [0, 0, 0], "bone": "tail"}}]})"),
       "-o", path("none.glb")});
  EXPECT_NE(bone.exit_code, 0);
  EXPECT_THAT(bone.err, HasSubstr("'tail'"));
  EXPECT_FALSE(exists("none.glb"));
  const CommandResult flag = run_sunder(
      {"tear", model(), "--ops", path("bone.json"), "-o", path("none.glb"), "--animated-pieces"});
  EXPECT_NE(flag.exit_code, 0);
}

}  // namespace
}  // namespace sunder::command_test
