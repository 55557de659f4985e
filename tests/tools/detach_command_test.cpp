// `sunder tear --pieces`: detached pieces as files.

#include "support/machine/gltf_validator.h"
#include "support/models/rigs.h"
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

/// A tube with a smaller one inside that is turned inside out, such as a head and its mouth: the
/// cap joins them.
TEST_F(DetachCommand, what_the_cap_joins_comes_off_as_one_piece) {
  Character character = test::make_tube(24, 16, 3);
  character.clips.clear();
  Mesh& mesh = character.meshes[0];
  const Mesh outer = mesh;
  mesh.uv_sets.clear();
  mesh.normals.clear();
  mesh.tangents.clear();
  mesh.morph_targets.clear();
  for (std::uint32_t vertex = 0; vertex < outer.vertex_count(); ++vertex) {
    mesh.positions.push_back(outer.positions[vertex].cwiseProduct(Vec3f(0.5f, 0.9f, 0.5f)) +
                             Vec3f(0, 0.15f, 0));
    mesh.weights.append(outer.weights.of(vertex));
  }
  for (std::uint32_t t = 0; t < outer.triangle_count(); ++t) {
    const Triangle inner = outer.triangles[t];
    const std::uint32_t first = outer.vertex_count();
    mesh.triangles.push_back({first + inner[2], first + inner[1], first + inner[0]});
    mesh.triangle_submesh.push_back(outer.triangle_submesh[t]);
  }
  character.rest_morph_weights.clear();
  ASSERT_TRUE(save_glb(path("hollow.glb"), character));
  const CommandResult result = run_sunder({"tear", path("hollow.glb"), "--sever", "bone1@0.5",
                                           "--pieces", path("top"), "-o", path("rest.glb")});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_TRUE(exists("top1.glb"));
  EXPECT_FALSE(exists("top2.glb"));
  EXPECT_EQ(topology_of(path("rest.glb"))["components"], 1);
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
