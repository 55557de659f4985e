// The built command, from the outside: exit codes, JSON, words, and what it leaves on disk.

#include <sunder/io/load_character.h>
#include <sunder/io/save_glb.h>

#include <filesystem>
#include <fstream>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "support/gltf_validator.h"
#include "support/temporary_folder.h"
#include "tools/demo_rig.h"
#include "tools/run_command.h"

namespace sunder {
namespace {

using nlohmann::json;
using test::CommandResult;
using test::run_sunder;
using testing::HasSubstr;
using testing::IsEmpty;

/// From the front across the trunk, mid-clip.
const char* const kOneTear = R"({"sunder_operations": 1, "operations": [
  {"op": "tear", "pose": {"clip": "Sway", "time": 0.8},
   "stroke": [{"base": [-0.1, 1.15, 2], "tip": [-0.1, 1.15, 0]}, {"base": [-0.12, 1.25, 2], "tip": [-0.12, 1.25, 0]},
              {"base": [-0.1, 1.4, 2], "tip": [-0.1, 1.4, 0]}]}]})";
const char* const kMiss = R"({"sunder_operations": 1, "operations": [
  {"op": "tear", "stroke": [{"base": [9, 9, 2], "tip": [9, 9, 0]}, {"base": [9, 10, 2], "tip": [9, 10, 0]}]}]})";

class Command : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = new test::TemporaryFolder;
    ASSERT_TRUE(save_glb(model(), tools::make_cactus()));
  }
  static void TearDownTestSuite() {
    delete folder_;
    folder_ = nullptr;
  }

  static std::string path(const std::string& name) { return (folder_->path() / name).string(); }
  static std::string model() { return path("cactus.glb"); }
  static std::string write(const std::string& name, const std::string& text) {
    std::ofstream(path(name)) << text;
    return path(name);
  }
  static bool exists(const std::string& name) { return std::filesystem::exists(path(name)); }
  static std::vector<std::byte> bytes(const std::string& name) { return test::read_bytes(path(name)); }

  static test::TemporaryFolder* folder_;
};
test::TemporaryFolder* Command::folder_ = nullptr;

TEST_F(Command, help_has_an_example_for_each_verb) {
  for (const char* const verb : {"info", "tear", "demo"}) {
    const CommandResult result = run_sunder({verb, "--help"});
    EXPECT_EQ(result.exit_code, 0);
    EXPECT_THAT(result.out, HasSubstr(std::string("Example: sunder ") + verb));
    EXPECT_THAT(result.err, IsEmpty());
  }
  EXPECT_EQ(run_sunder({"--help"}).exit_code, 0);
  EXPECT_THAT(run_sunder({"--version"}).out, HasSubstr("sunder 0."));
}

TEST_F(Command, a_wrong_command_line_exits_with_2) {
  for (const std::vector<std::string>& arguments :
       std::vector<std::vector<std::string>>{{}, {"sew"}, {"info"}, {"info", model(), "--xml"}, {"tear", model()}}) {
    const CommandResult result = run_sunder(arguments);
    EXPECT_EQ(result.exit_code, 2) << result.err;
    EXPECT_THAT(result.out, IsEmpty());
    EXPECT_THAT(result.err, testing::Not(IsEmpty()));
  }
  EXPECT_EQ(run_sunder({"tear", model(), "--ops", write("a.json", kOneTear), "-o", path("x.glb"), "--influences", "5"}).exit_code,
            2);
  EXPECT_FALSE(exists("x.glb"));
}

TEST_F(Command, info_counts_what_is_there) {
  const CommandResult result = run_sunder({"info", model(), "--json"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const json info = json::parse(result.out);
  EXPECT_EQ(info["sunder_info"], 1);
  EXPECT_EQ(info["meshes"].size(), 2u);
  EXPECT_EQ(info["clips"][0]["name"], "Sway");
  EXPECT_DOUBLE_EQ(info["clips"][0]["duration"].get<double>(), 2.0);
  EXPECT_EQ(info["topology"]["components"], 2);
  EXPECT_EQ(info["topology"]["boundary_loops"], 0);
  EXPECT_EQ(info["topology"]["non_manifold_edges"], 0);
  EXPECT_NEAR(info["bounds"]["min"][1].get<double>(), 0.0, 1e-6);
  EXPECT_NEAR(info["weight_sum_max"].get<double>(), 1.0, 1e-6);
  for (const json& mesh : info["meshes"]) EXPECT_GE(mesh["vertices"], mesh["points"]);
}

TEST_F(Command, info_speaks_to_people_too) {
  const CommandResult result = run_sunder({"info", model()});
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_THAT(result.out, HasSubstr("'Cactus'"));
  EXPECT_THAT(result.out, HasSubstr("clip 0"));
  EXPECT_THAT(result.err, IsEmpty());
}

TEST_F(Command, an_unreadable_model_exits_with_3) {
  for (const std::string& file : {path("no such.glb"), write("garbage.glb", "not a model"), write("text.txt", "hello")}) {
    const CommandResult result = run_sunder({"info", file});
    EXPECT_EQ(result.exit_code, 3) << file;
    EXPECT_THAT(result.err, HasSubstr(file));
    EXPECT_THAT(result.out, IsEmpty());
  }
}

TEST_F(Command, tear_reports_what_it_did) {
  const CommandResult result = run_sunder({"tear", model(), "--ops", write("a.json", kOneTear), "-o", path("torn.glb")});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const json report = json::parse(result.out);
  const json& operation = report["operations"].at(0);
  EXPECT_EQ(operation["status"], "torn");
  EXPECT_GT(operation["faces_crossed"], 5);
  EXPECT_GT(operation["points_added"], 0);
  EXPECT_GE(operation["vertices_added"], operation["points_added"]);
  EXPECT_GT(operation["triangles_added"], 0);
  EXPECT_EQ(operation["triangles_retired"], 0);
  EXPECT_GT(operation["length_posed"].get<double>(), 0.2);
  EXPECT_GE(operation["seconds"].get<double>(), 0.0);
  EXPECT_EQ(operation["components"]["before"], operation["components"]["after"]);
  EXPECT_EQ(operation["boundary_loops"]["after"], 1);
  EXPECT_LT(report["result"]["weight_sum_error_max"].get<double>(), 2e-6);
  EXPECT_GT(report["result"]["weight_min"].get<double>(), 0.0);
  EXPECT_EQ(report["result"]["degenerate_triangles"], 0);
  EXPECT_EQ(report["result"]["non_manifold_edges"], 0);
  EXPECT_EQ(report["result"]["non_finite_values"], 0);

  const CommandResult info = run_sunder({"info", path("torn.glb"), "--json"});
  ASSERT_EQ(info.exit_code, 0) << info.err;
  EXPECT_EQ(json::parse(info.out)["topology"]["boundary_loops"], 1);
}

TEST_F(Command, what_tear_writes_passes_the_khronos_validator) {
  SUNDER_SKIP_WITHOUT_GLTF_VALIDATOR();
  for (const char* const influences : {"4", "8"}) {
    ASSERT_EQ(run_sunder({"tear", model(), "--ops", write("a.json", kOneTear), "-o", path("valid.glb"), "--influences", influences})
                  .exit_code,
              0);
    const test::ValidatorReport report = test::validate_glb(path("valid.glb"));
    EXPECT_EQ(report.errors, 0) << report.output;
  }
}

TEST_F(Command, the_report_goes_where_it_is_wanted) {
  const CommandResult result =
      run_sunder({"tear", model(), "--ops", write("a.json", kOneTear), "-o", path("torn2.glb"), "--report", path("r.json")});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.out, IsEmpty());
  std::ifstream stream(path("r.json"));
  EXPECT_EQ(json::parse(stream)["operations"].size(), 1u);

  const CommandResult failing =
      run_sunder({"tear", model(), "--ops", path("a.json"), "-o", path("torn3.glb"), "--report", path("no such folder/r.json")});
  EXPECT_EQ(failing.exit_code, 3);
  EXPECT_FALSE(exists("torn3.glb"));
}

TEST_F(Command, the_same_operations_give_the_same_bytes) {
  const std::string operations = write("a.json", kOneTear);
  ASSERT_EQ(run_sunder({"tear", model(), "--ops", operations, "-o", path("one.glb")}).exit_code, 0);
  ASSERT_EQ(run_sunder({"tear", model(), "--ops", operations, "-o", path("two.glb")}).exit_code, 0);
  EXPECT_EQ(bytes("one.glb"), bytes("two.glb"));
}

TEST_F(Command, no_operation_gives_the_source) {
  const std::string none = write("none.json", R"({"sunder_operations": 1, "operations": []})");
  ASSERT_EQ(run_sunder({"tear", model(), "--ops", none, "-o", path("same.glb")}).exit_code, 0);
  EXPECT_EQ(bytes("same.glb"), bytes("cactus.glb"));
}

TEST_F(Command, a_miss_is_a_finding_and_still_written) {
  const CommandResult result = run_sunder({"tear", model(), "--ops", write("miss.json", kMiss), "-o", path("missed.glb")});
  EXPECT_EQ(result.exit_code, 1) << result.err;
  EXPECT_EQ(json::parse(result.out)["operations"][0]["status"], "missed");
  EXPECT_EQ(bytes("missed.glb"), bytes("cactus.glb"));
}

TEST_F(Command, bad_operations_exit_with_2_name_their_place_and_leave_nothing) {
  struct Case {
    const char* operations;
    const char* words;
  };
  const Case cases[] = {
      {"{", ""},
      {R"({"sunder_operations": 7, "operations": []})", "sunder_operations"},
      {R"({"sunder_operations": 1, "operations": [{"op": "sew"}]})", "/operations/0"},
      {R"({"sunder_operations": 1, "operations": [{"op": "tear", "pose": {"clip": "Fly", "time": 0},
         "stroke": [{"base": [0,1,1], "tip": [0,1,0]}, {"base": [0.1,1,1], "tip": [0.1,1,0]}]}]})",
       "Fly"},
      {R"({"sunder_operations": 1, "operations": [{"op": "tear", "pose": {"bones": {"Tail": {}}},
         "stroke": [{"base": [0,1,1], "tip": [0,1,0]}, {"base": [0.1,1,1], "tip": [0.1,1,0]}]}]})",
       "Tail"},
      {R"({"sunder_operations": 1, "operations": [{"op": "tear",
         "stroke": [{"base": [0,1,1], "tip": [0,1,0]}, {"base": [0,1,-1], "tip": [0,1,0]}]}]})",
       "/operations/0"},
  };
  for (const Case& bad : cases) {
    const CommandResult result = run_sunder({"tear", model(), "--ops", write("bad.json", bad.operations), "-o", path("bad.glb")});
    EXPECT_EQ(result.exit_code, 2) << bad.operations << result.err;
    EXPECT_THAT(result.err, HasSubstr(bad.words));
    EXPECT_THAT(result.err, HasSubstr("bad.json"));
    EXPECT_THAT(result.out, IsEmpty());
    EXPECT_FALSE(exists("bad.glb"));
  }
  EXPECT_EQ(run_sunder({"tear", model(), "--ops", path("no such.json"), "-o", path("bad.glb")}).exit_code, 3);
}

TEST_F(Command, a_failing_operation_after_a_good_one_writes_nothing) {
  json operations = json::parse(kOneTear);
  operations["operations"].push_back(operations["operations"][0]);
  operations["operations"][1]["pose"]["clip"] = 99;
  std::ofstream(path("kept.glb")) << "was here before";
  const CommandResult result =
      run_sunder({"tear", model(), "--ops", write("second.json", operations.dump()), "-o", path("kept.glb")});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(result.err, HasSubstr("/operations/1"));
  EXPECT_EQ(bytes("kept.glb").size(), 15u);
}

TEST_F(Command, an_output_that_cannot_be_written_exits_with_3) {
  const CommandResult result =
      run_sunder({"tear", model(), "--ops", write("a.json", kOneTear), "-o", path("no such folder/torn.glb")});
  EXPECT_EQ(result.exit_code, 3);
  EXPECT_THAT(result.out, IsEmpty());
}

TEST_F(Command, demo_without_a_renderer_leaves_all_but_the_pictures) {
  const CommandResult result = run_sunder({"demo", "-o", path("demo")}, {{"PATH", "/nonexistent"}});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(result.err, HasSubstr("f3d"));
  EXPECT_TRUE(exists("demo/torn.glb"));
  EXPECT_TRUE(exists("demo/report.json"));
  EXPECT_FALSE(exists("demo/torn.png"));

  // The demo's own log makes its tear again.
  ASSERT_EQ(run_sunder({"tear", path("demo/cactus.glb"), "--ops", path("demo/ops.json"), "-o", path("again.glb"), "--report",
                        path("again.json")})
                .exit_code,
            0);
  std::ifstream first(path("demo/report.json")), second(path("again.json"));
  EXPECT_EQ(json::parse(first)["result"], json::parse(second)["result"]);
}

TEST_F(Command, demo_draws_four_pictures) {
  if (std::system("command -v f3d xvfb-run >/dev/null 2>&1") != 0) GTEST_SKIP() << "needs f3d and xvfb-run";
  const CommandResult result = run_sunder({"demo", model(), "-o", path("pictures")});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  for (const char* const name : {"before", "torn", "later_1", "later_2"})
    EXPECT_GT(std::filesystem::file_size(path("pictures/" + std::string(name) + ".png")), 10'000u) << name;
}

}  // namespace
}  // namespace sunder
