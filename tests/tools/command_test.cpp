// Tests the built command from the outside: exit codes, JSON, messages, and written files.

#include <sunder/io/character_file.h>
#include <sunder/skinning/deform.h>
#include <sunder/skinning/pose.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "skinning/internal/reference.h"
#include "support/gltf_validator.h"
#include "support/shared_models.h"
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

/// Every operation: a tear that opens, one with a gap, one while the cactus sways, a cut through
/// its trunk, a bore, undone ones, and misses.
const char* const kAll = R"({"sunder_operations": 1, "operations": [
  {"op": "tear", "pose": {"clip": "Sway", "time": 0.8},
   "stroke": [{"base": [-0.1, 1.15, 2], "tip": [-0.1, 1.15, 0]}, {"base": [-0.12, 1.25, 2], "tip": [-0.12, 1.25, 0]}]},
  {"op": "tear", "width": 0.02, "stroke": [{"base": [0, 0.55, 2], "tip": [0, 0.55, 0]}, {"base": [0.05, 0.65, 2], "tip": [0.05, 0.65, 0]},
   {"base": [-0.03, 0.7, 2], "tip": [-0.03, 0.7, 0]}]},
  {"op": "tear", "layers": "all", "stroke": [{"base": [-0.03, 1.4, 2], "tip": [-0.03, 1.4, -2]},
   {"base": [0.04, 1.42, 2], "tip": [0.04, 1.42, -2], "pose": {"clip": "Sway", "time": 0.2}}]},
  {"op": "cut", "plane": {"point": [0, 0.5, 0], "normal": [0, 1, 0.1]}, "pose": {"clip": 0, "time": 1.3}},
  {"op": "undo"},
  {"op": "redo"},
  {"op": "drill", "axis": {"origin": [0, 0.4, 2], "direction": [0, 0, -1]}, "radius": 0.03, "depth": 4},
  {"op": "undo", "count": 2},
  {"op": "drill", "axis": {"origin": [0, 0.4, 2], "direction": [0, 0, -1]}, "radius": 0.02, "depth": 4},
  {"op": "cut", "plane": {"point": [0, 9, 0], "normal": [0, 1, 0]}},
  {"op": "drill", "axis": {"origin": [9, 9, 9], "direction": [1, 0, 0]}, "radius": 0.02, "depth": 4}]})";

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
  static std::vector<std::byte> bytes(const std::string& name) {
    return test::read_bytes(path(name));
  }

  static test::TemporaryFolder* folder_;
};
test::TemporaryFolder* Command::folder_ = nullptr;

TEST_F(Command, help_has_an_example_for_each_verb) {
  for (const char* const verb : {"info", "tear", "transfer", "demo"}) {
    const CommandResult result = run_sunder({verb, "--help"});
    EXPECT_EQ(result.exit_code, 0);
    EXPECT_THAT(result.out, HasSubstr(std::string("Example: sunder ") + verb));
    EXPECT_THAT(result.err, IsEmpty());
  }
  EXPECT_EQ(run_sunder({"--help"}).exit_code, 0);
  EXPECT_THAT(run_sunder({"--version"}).out, HasSubstr("sunder 0."));
}

TEST_F(Command, a_wrong_command_line_exits_with_2) {
  for (const std::vector<std::string>& arguments : std::vector<std::vector<std::string>>{
           {}, {"sew"}, {"info"}, {"info", model(), "--xml"}, {"tear", model()}}) {
    const CommandResult result = run_sunder(arguments);
    EXPECT_EQ(result.exit_code, 2) << result.err;
    EXPECT_THAT(result.out, IsEmpty());
    EXPECT_THAT(result.err, testing::Not(IsEmpty()));
  }
  EXPECT_EQ(run_sunder({"tear", model(), "--ops", write("a.json", kOneTear), "-o", path("x.glb"),
                        "--influences", "5"})
                .exit_code,
            2);
  EXPECT_EQ(run_sunder({"tear", model(), "--ops", path("a.json"), "-o", path("x.glb"),
                        "--weights-as", "u32"})
                .exit_code,
            2);
  EXPECT_FALSE(exists("x.glb"));
}

TEST_F(Command, info_counts_the_parts_of_a_model) {
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
  for (const std::string& file :
       {path("no such.glb"), write("garbage.glb", "not a model"), write("text.txt", "hello")}) {
    const CommandResult result = run_sunder({"info", file});
    EXPECT_EQ(result.exit_code, 3) << file;
    EXPECT_THAT(result.err, HasSubstr(file));
    EXPECT_THAT(result.out, IsEmpty());
  }
}

TEST_F(Command, tear_reports_its_results) {
  const CommandResult result =
      run_sunder({"tear", model(), "--ops", write("a.json", kOneTear), "-o", path("torn.glb")});
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

/// The largest distance between vertices of two models in a pose.
double greatest_distance(const Character& a, const Character& b, const PoseSpec& spec) {
  const auto pose = make_pose(a, spec);
  EXPECT_TRUE(pose && a.meshes.size() == b.meshes.size());
  double greatest = 0;
  for (std::size_t m = 0; m < a.meshes.size(); ++m) {
    const Mesh &of_a = a.meshes[m], &of_b = b.meshes[m];
    EXPECT_EQ(of_a.positions, of_b.positions);
    std::vector<Affine3d> palette(a.skins[of_a.skin].bones.size());
    EXPECT_TRUE(compute_palette(a.skins[of_a.skin], *pose, palette));
    for (std::uint32_t v = 0; v < of_a.vertex_count(); ++v)
      greatest =
          std::max(greatest, (deform_position_reference(of_a, v, palette, pose->morph_weights) -
                              deform_position_reference(of_b, v, palette, pose->morph_weights))
                                 .norm());
  }
  return greatest;
}

TEST_F(Command, tear_plays_every_operation) {
  const CommandResult result =
      run_sunder({"tear", model(), "--ops", write("all.json", kAll), "-o", path("all.glb")});
  ASSERT_EQ(result.exit_code, 1) << result.err;  // for the misses
  const json report = json::parse(result.out);
  const json& operations = report["operations"];
  ASSERT_EQ(operations.size(), 11u);
  std::vector<std::string> names, statuses;
  for (const json& operation : operations) {
    names.push_back(operation["op"]);
    statuses.push_back(operation["status"]);
    EXPECT_EQ(operation["blocked"], 0);
  }
  EXPECT_THAT(names, testing::ElementsAre("tear", "tear", "tear", "cut", "undo", "redo", "drill",
                                          "undo", "drill", "cut", "drill"));
  EXPECT_THAT(statuses, testing::ElementsAre("torn", "torn", "torn", "cut", "undone", "redone",
                                             "drilled", "undone", "drilled", "missed", "missed"));
  for (std::size_t i = 1; i < operations.size(); ++i)
    for (const char* const count : {"components", "boundary_loops"})
      EXPECT_EQ(operations[i][count]["before"], operations[i - 1][count]["after"])
          << i << ' ' << count;

  EXPECT_EQ(operations[0]["area_removed_posed"], 0.0);
  EXPECT_GT(operations[1]["area_removed_posed"].get<double>(), 0.002);
  EXPECT_GT(operations[1]["triangles_retired"], 0);
  EXPECT_EQ(operations[2]["runs"], 2);
  const json& cut = operations[3];
  EXPECT_EQ(cut["components"]["after"], cut["components"]["before"].get<int>() + 1);
  ASSERT_EQ(cut["pieces"].size(), 2u);
  int triangles = 0;
  for (const json& piece : cut["pieces"]) {
    ASSERT_EQ(piece["meshes"].size(), 1u);
    EXPECT_EQ(piece["meshes"][0]["mesh"], "Cactus");
    EXPECT_EQ(piece["meshes"][0]["index"], 1);
    EXPECT_EQ(piece["meshes"][0]["triangle_count"], piece["triangle_count"]);
    EXPECT_GT(piece["bones"].size(), 1u);
    EXPECT_TRUE(piece["bones"][0].is_string());
    EXPECT_EQ(piece["centroid_posed"].size(), 3u);
    EXPECT_GT(piece["area_posed"].get<double>(), 0.05);
    triangles += piece["triangle_count"].get<int>();
  }
  EXPECT_GT(triangles, 11'000);
  const auto higher = std::max(cut["pieces"][0]["centroid_posed"][1].get<double>(),
                               cut["pieces"][1]["centroid_posed"][1].get<double>());
  EXPECT_GT(higher, 0.8);
  EXPECT_EQ(operations[4]["components"]["after"], cut["components"]["before"]);
  EXPECT_EQ(operations[5]["components"], cut["components"]);
  EXPECT_EQ(operations[8]["boundary_loops"]["after"],
            operations[8]["boundary_loops"]["before"].get<int>() + 2);
  EXPECT_THAT(report["result"]["digest"].get<std::string>(), testing::MatchesRegex("[0-9a-f]{16}"));
  EXPECT_EQ(report["result"]["non_manifold_edges"], 0);

  // The written model equals the model without the retired triangles.
  const CommandResult info = run_sunder({"info", path("all.glb"), "--json"});
  ASSERT_EQ(info.exit_code, 0) << info.err;
  for (const char* const count :
       {"triangles", "points", "components", "boundary_loops", "non_manifold_edges"})
    EXPECT_EQ(json::parse(info.out)["topology"][count], report["result"]["topology"][count])
        << count;
}

TEST_F(Command, tear_reports_the_written_influences) {
  const std::string operations = write("a.json", kOneTear);
  const json all = json::parse(
      run_sunder({"tear", model(), "--ops", operations, "-o", path("all_kept.glb")}).out);
  EXPECT_EQ(
      all["influences_written"],
      json::parse(
          R"({"maximum": 0, "format": "float", "vertices_pruned": 0, "dropped_mass_max": 0.0, "pruning_error_max": 0.0})"));
  for (const char* const format : {"float", "u16", "u8"}) {
    const CommandResult result =
        run_sunder({"tear", model(), "--ops", operations, "-o", path("pruned.glb"), "--influences",
                    "4", "--weights-as", format});
    ASSERT_EQ(result.exit_code, 0) << result.err;
    const json report = json::parse(result.out);
    const json& written = report["influences_written"];
    EXPECT_EQ(report["influences_written_max"], 4);
    EXPECT_EQ(written["maximum"], 4);
    EXPECT_EQ(written["format"], format);
    EXPECT_GT(written["vertices_pruned"], 0);
    EXPECT_GT(written["dropped_mass_max"].get<double>(), 0.0);
    EXPECT_LT(written["dropped_mass_max"].get<double>(), 0.8);  // four of at most twenty

    const auto before = load_character(path("all_kept.glb")),
               after = load_character(path("pruned.glb"));
    ASSERT_TRUE(before && after);
    double moved = 0;
    for (const PoseSpec& spec : {PoseSpec(RestPose()), PoseSpec(ClipPose{"Sway", 0.8})})
      moved = std::max(moved, greatest_distance(*before->character, *after->character, spec));
    const double of_an_integer = format == std::string("u8")    ? 1.0 / 255
                                 : format == std::string("u16") ? 1.0 / 65535
                                                                : 0.0;
    EXPECT_NEAR(moved, written["pruning_error_max"].get<double>(), 1e-5 + of_an_integer) << format;
    EXPECT_GT(moved, 0.0);
  }
}

TEST_F(Command, tear_weighs_new_points_by_the_requested_policy) {
  const std::string operations = write("a.json", kOneTear);
  std::map<std::string, json> reports;
  for (const char* const policy : {"barycentric", "pose_exact", "refit", "exact"}) {
    const CommandResult result = run_sunder(
        {"tear", model(), "--ops", operations, "-o", path("weighed.glb"), "--weights", policy});
    ASSERT_EQ(result.exit_code, 0) << result.err;
    const json report = reports[policy] = json::parse(result.out);
    EXPECT_EQ(report["weights"]["policy"], policy);
    EXPECT_EQ(report["weights"]["influences"], 0);
    EXPECT_EQ(report["operations"].size(), policy == std::string("refit") ? 2u : 1u);
    const json& errors = report["weight_errors"];
    for (const char* const set :
         {"operations", "clips", "clips_held_out", "range_of_motion", "range_of_motion_held_out"}) {
      ASSERT_TRUE(errors.contains(set)) << set;
      EXPECT_GT(errors[set]["points"], 5);
      EXPECT_LE(errors[set]["poses"], 200);
      EXPECT_GE(errors[set]["maximum"], errors[set]["percentile95"]);
      for (const char* const unit : {"of_diagonal", "of_edge"})
        EXPECT_GE(errors[set][unit]["maximum"], errors[set][unit]["rms"]) << set << unit;
    }
    EXPECT_EQ(errors["operations"]["poses"], 1);
    if (report["operations"].size() == 1) {
      EXPECT_EQ(errors["operations"]["maximum"], report["operations"][0]["weights"]["error_max"]);
    }
    EXPECT_EQ(errors["clips"]["poses"], 8);
    EXPECT_EQ(errors["clips_held_out"]["poses"], 8);
  }
  const auto error = [&](const char* policy, const char* set) {
    return reports[policy]["weight_errors"][set]["rms"].get<double>();
  };
  EXPECT_GT(error("barycentric", "operations"), 1e-5);
  EXPECT_LT(error("pose_exact", "operations"), 1e-6);
  EXPECT_LT(error("refit", "clips"), error("barycentric", "clips"));
  EXPECT_LT(error("refit", "clips_held_out"), error("barycentric", "clips_held_out"));
  EXPECT_LT(error("exact", "range_of_motion"), 1e-6);
  EXPECT_LT(reports["pose_exact"]["operations"][0]["weights"]["error_max"].get<double>(), 1e-6);

  const json& refit = reports["refit"]["operations"][1];
  EXPECT_EQ(refit["op"], "weights");
  EXPECT_EQ(refit["status"], "weighed");
  EXPECT_GT(refit["weights"]["refitted"], 0);
  EXPECT_GE(refit["weights"]["points"], refit["weights"]["refitted"]);
  EXPECT_EQ(reports["refit"]["weights"]["refit_over"], "both");
  EXPECT_TRUE(reports["exact"]["weights"]["refit_over"].is_null());

  EXPECT_FALSE(reports["refit"]["weight_errors"].contains("as_written"));
  const json& as_written = reports["exact"]["weight_errors"]["as_written"];
  EXPECT_EQ(as_written, reports["barycentric"]["weight_errors"]);
  EXPECT_THAT(reports["exact"]["weight_errors"]["note"].get<std::string>(),
              HasSubstr("barycentric"));
}

TEST_F(Command, influences_are_kept_in_weights_too) {
  const std::string operations = write("c.json", R"({"sunder_operations": 1, "operations": [
    {"op": "cut", "pose": {"clip": "Sway", "time": 0.8}, "plane": {"point": [0, 0.8, 0], "normal": [0, 1, 0]}}]})");
  for (const char* const policy : {"barycentric", "pose_exact", "refit", "exact"}) {
    const CommandResult result =
        run_sunder({"tear", model(), "--ops", operations, "-o", path("four.glb"), "--weights",
                    policy, "--influences", "4"});
    ASSERT_EQ(result.exit_code, 0) << result.err;
    const json report = json::parse(result.out);
    const bool is_exact = policy == std::string("exact");
    EXPECT_EQ(report["weights"]["influences"], is_exact ? 0 : 4);
    EXPECT_EQ(report["operations"][0]["weights"]["pruned"] > 0, !is_exact) << policy;
  }
}

TEST_F(Command, a_refit_uses_the_requested_poses) {
  const std::string operations = write("a.json", kOneTear);
  for (const char* const over : {"clips", "range_of_motion", "both"}) {
    const CommandResult result =
        run_sunder({"tear", model(), "--ops", operations, "-o", path("refit.glb"), "--weights",
                    "refit", "--refit-over", over, "--save-log", path("refit.json")});
    ASSERT_EQ(result.exit_code, 0) << result.err;
    EXPECT_EQ(json::parse(result.out)["weights"]["refit_over"], over);
    std::ifstream stream(path("refit.json"));
    const json log = json::parse(stream);
    ASSERT_EQ(log["operations"].size(), 2u);
    const json& poses = log["operations"][1]["refit"]["poses"];
    EXPECT_EQ(poses["clip_samples"] == 8, over != std::string("range_of_motion"));
    EXPECT_EQ(poses["range_of_motion"] == true, over != std::string("clips"));
  }
  for (const std::vector<std::string>& arguments :
       std::vector<std::vector<std::string>>{{"--refit-over", "clips"},
                                             {"--weights", "exact", "--refit-over", "both"},
                                             {"--weights", "refit", "--refit-over", "none"},
                                             {"--weights", "linear"}}) {
    std::vector<std::string> all = {"tear",     model(), "--ops",
                                    operations, "-o",    path("unfitted.glb")};
    all.insert(all.end(), arguments.begin(), arguments.end());
    const CommandResult result = run_sunder(all);
    EXPECT_EQ(result.exit_code, 2) << arguments.back();
    EXPECT_THAT(result.err, HasSubstr(arguments[arguments.size() - 2]));
    EXPECT_FALSE(exists("unfitted.glb"));
  }
}

TEST_F(Command, a_model_without_clips_is_refitted_over_its_range_of_motion) {
  Character still = tools::make_cactus();
  still.clips.clear();
  ASSERT_TRUE(save_glb(path("still.glb"), still));
  const std::string operations = write("still.json", R"({"sunder_operations": 1, "operations": [
    {"op": "drill", "axis": {"origin": [0, 0.4, 2], "direction": [0, 0, -1]}, "radius": 0.02, "depth": 4}]})");
  const CommandResult result = run_sunder({"tear", path("still.glb"), "--ops", operations, "-o",
                                           path("bored.glb"), "--weights", "refit"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const json report = json::parse(result.out);
  EXPECT_EQ(report["weights"]["refit_over"], "both");
  EXPECT_FALSE(report["weight_errors"].contains("clips"));
  EXPECT_TRUE(report["weight_errors"].contains("range_of_motion"));

  const CommandResult no_clips =
      run_sunder({"tear", path("still.glb"), "--ops", operations, "-o", path("unbored.glb"),
                  "--weights", "refit", "--refit-over", "clips"});
  EXPECT_EQ(no_clips.exit_code, 2);
  EXPECT_THAT(no_clips.err, HasSubstr("--refit-over"));
  EXPECT_FALSE(exists("unbored.glb"));
}

TEST_F(Command, a_model_that_does_not_bend_needs_no_refit) {
  Character stiff = tools::make_cactus();
  stiff.clips.clear();
  for (Mesh& mesh : stiff.meshes) {
    mesh.weights.influences.assign(mesh.vertex_count(), {0, 1.0f});
    for (std::uint32_t v = 0; v <= mesh.vertex_count(); ++v) mesh.weights.first[v] = v;
  }
  ASSERT_TRUE(save_glb(path("stiff.glb"), stiff));
  const std::string operations = write("stiff.json", R"({"sunder_operations": 1, "operations": [
    {"op": "drill", "axis": {"origin": [0, 0.4, 2], "direction": [0, 0, -1]}, "radius": 0.02, "depth": 4}]})");
  const CommandResult result = run_sunder({"tear", path("stiff.glb"), "--ops", operations, "-o",
                                           path("bored.glb"), "--weights", "refit"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const json report = json::parse(result.out);
  EXPECT_TRUE(report["weights"]["refit_over"].is_null());
  EXPECT_EQ(report["operations"].size(), 1u);
  EXPECT_EQ(report["weight_errors"].size(), 1u);
  EXPECT_LT(report["weight_errors"]["operations"]["maximum"].get<double>(), 1e-6);
}

/// One tear and bores with weights of their own in the log, the last of which waits for a fit; then
/// weights for the first.
const char* const kWeighed = R"({"sunder_operations": 1, "operations": [
  {"op": "tear", "pose": {"clip": "Sway", "time": 0.8}, "weights": {"policy": "refit"},
   "stroke": [{"base": [-0.1, 1.15, 2], "tip": [-0.1, 1.15, 0]}, {"base": [-0.12, 1.25, 2], "tip": [-0.12, 1.25, 0]}]},
  {"op": "drill", "axis": {"origin": [0, 0.4, 2], "direction": [0, 0, -1]}, "radius": 0.02, "depth": 4, "weights": {"policy": "exact"}},
  {"op": "drill", "axis": {"origin": [0, 0.7, 2], "direction": [0, 0, -1]}, "radius": 0.02, "depth": 4,
   "weights": {"policy": "pose_exact", "influences": 4}},
  {"op": "weights", "count": 1, "weights": {"policy": "pose_exact"}, "pose": {"clip": "Sway", "time": 0.4}},
  {"op": "drill", "axis": {"origin": [0, 0.9, 2], "direction": [0, 0, -1]}, "radius": 0.02, "depth": 4}]})";

TEST_F(Command, weights_of_the_log_win) {
  const CommandResult result =
      run_sunder({"tear", model(), "--ops", write("weighed.json", kWeighed), "-o", path("won.glb"),
                  "--weights", "refit", "--influences", "8", "--save-log", path("won.json")});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  std::ifstream stream(path("won.json"));
  const json operations = json::parse(stream)["operations"];
  ASSERT_EQ(operations.size(), 6u);
  EXPECT_EQ(operations[0]["weights"], json::parse(R"({"policy": "refit", "influences": 0})"));
  EXPECT_EQ(operations[1]["weights"], json::parse(R"({"policy": "exact", "influences": 0})"));
  EXPECT_EQ(operations[2]["weights"], json::parse(R"({"policy": "pose_exact", "influences": 4})"));
  EXPECT_EQ(operations[4]["weights"], json::parse(R"({"policy": "refit", "influences": 8})"));
  EXPECT_EQ(operations[5]["op"], "weights");
  EXPECT_EQ(operations[5]["first"], 4);
  EXPECT_EQ(operations[5]["count"], 1);
  EXPECT_EQ(operations[5]["weights"], operations[4]["weights"]);
}

/// Applies a log, then the log that it saved, and expects the same model.
void expect_replay(const std::string& model, const std::string& operations, const std::string& stem,
                   const std::string& weights = "barycentric") {
  const CommandResult played = run_sunder({"tear", model, "--ops", operations, "-o", stem + "1.glb",
                                           "--save-log", stem + "1.json", "--weights", weights});
  ASSERT_LE(played.exit_code, 1) << played.err;
  const CommandResult replayed = run_sunder({"tear", model, "--ops", stem + "1.json", "-o",
                                             stem + "2.glb", "--save-log", stem + "2.json"});
  ASSERT_EQ(replayed.exit_code, 0) << replayed.err;
  EXPECT_EQ(json::parse(played.out)["result"], json::parse(replayed.out)["result"]);
  EXPECT_EQ(json::parse(played.out)["weight_errors"], json::parse(replayed.out)["weight_errors"]);
  EXPECT_EQ(test::read_bytes(stem + "1.glb"), test::read_bytes(stem + "2.glb"));
  EXPECT_EQ(test::read_bytes(stem + "1.json"), test::read_bytes(stem + "2.json"));
}

TEST_F(Command, a_saved_log_gives_the_same_model) {
  expect_replay(model(), write("all.json", kAll), path("replay"));
  std::ifstream stream(path("replay1.json"));
  const json log = json::parse(stream);
  EXPECT_EQ(log["operations"].size(), 4u);  // The history has no undone and missed operations.
  for (const json& operation : log["operations"])
    EXPECT_TRUE(operation["pose"].contains("matrices"));
}

TEST_F(Command, a_saved_log_gives_the_same_weights) {
  expect_replay(model(), write("weighed.json", kWeighed), path("replayed"));
  for (const char* const weights : {"pose_exact", "refit", "exact"})
    expect_replay(model(), write("all.json", kAll), path("replayed"), weights);
}

TEST_F(Command, a_saved_log_gives_the_same_model_from_a_file_with_clips) {
  const std::string tube = (test::own_data() / "rigged" / "two_clips.glb").string();
  const std::string operations = write("tube.json", R"({"sunder_operations": 1, "operations": [
    {"op": "cut", "pose": {"clip": 0, "time": 0.3}, "plane": {"point": [0, 2.2, 0], "normal": [0, 1, 0]}},
    {"op": "drill", "pose": {"clip": 1, "time": 0.2}, "axis": {"origin": [0, 0.5, 5], "direction": [0, 0, -1]}, "radius": 0.1, "depth": 10},
    {"op": "tear", "layers": "all", "width": 0.02, "stroke": [{"base": [-0.3, 1.2, 5], "tip": [-0.3, 1.2, -5]},
     {"base": [0.3, 1.3, 5], "tip": [0.3, 1.3, -5], "pose": {"clip": 1, "time": 0.6}}]},
    {"op": "undo", "count": 2}, {"op": "redo"}]})");
  expect_replay(tube, operations, path("tube"));
}

TEST_F(Command, a_saved_log_gives_the_same_model_from_an_artists_file) {
  SUNDER_SKIP_WITHOUT_SHARED_MODELS();
  const std::string fox = (test::shared_models() / "rigged" / "fox.glb").string();
  const std::string operations = write("fox.json", R"({"sunder_operations": 1, "operations": [
    {"op": "cut", "pose": {"clip": 0, "time": 0.3}, "plane": {"point": [0, 0, 10], "normal": [0, 0, 1]}},
    {"op": "drill", "pose": {"clip": 1, "time": 0.2}, "axis": {"origin": [900, 50, 20], "direction": [-1, 0, 0]}, "radius": 5, "depth": 2000},
    {"op": "tear", "layers": "all", "width": 2, "stroke": [{"base": [900, 40, -10], "tip": [-900, 40, -10]},
     {"base": [900, 45, 5], "tip": [-900, 45, 5], "pose": {"clip": 1, "time": 0.3}}]},
    {"op": "undo", "count": 2}, {"op": "redo"}]})");
  expect_replay(fox, operations, path("fox"));
}

TEST_F(Command, a_log_that_cannot_be_saved_leaves_nothing) {
  const CommandResult result = run_sunder(
      {"tear", model(), "--ops", write("a.json", kOneTear), "-o", path("unlogged.glb"),
       "--save-log", path("no such folder/log.json"), "--report", path("unlogged.json")});
  EXPECT_EQ(result.exit_code, 3);
  EXPECT_THAT(result.err, HasSubstr("no such folder/log.json"));
  EXPECT_FALSE(exists("unlogged.glb"));
  EXPECT_FALSE(exists("unlogged.json"));
}

/// Checked by our own reader and, if it is installed, by the Khronos validator.
TEST_F(Command, tear_writes_valid_files) {
  for (const char* const influences : {"4", "8"})
    for (const char* const format : {"float", "u16", "u8"}) {
      ASSERT_EQ(run_sunder({"tear", model(), "--ops", write("a.json", kOneTear), "-o",
                            path("valid.glb"), "--influences", influences, "--weights-as", format})
                    .exit_code,
                0);
      EXPECT_TRUE(load_character(path("valid.glb")));
      if (!test::has_gltf_validator()) continue;
      const test::ValidatorReport report = test::validate_glb(path("valid.glb"));
      EXPECT_EQ(report.errors, 0) << report.output;
    }
}

TEST_F(Command, the_report_goes_where_it_is_wanted) {
  const CommandResult result = run_sunder({"tear", model(), "--ops", write("a.json", kOneTear),
                                           "-o", path("torn2.glb"), "--report", path("r.json")});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.out, IsEmpty());
  std::ifstream stream(path("r.json"));
  EXPECT_EQ(json::parse(stream)["operations"].size(), 1u);

  const CommandResult failing =
      run_sunder({"tear", model(), "--ops", path("a.json"), "-o", path("torn3.glb"), "--report",
                  path("no such folder/r.json")});
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
  for (const char* const weights : {"refit", "exact"}) {
    const CommandResult result =
        run_sunder({"tear", model(), "--ops", none, "-o", path("same.glb"), "--weights", weights});
    ASSERT_EQ(result.exit_code, 0) << result.err;
    EXPECT_EQ(json::parse(result.out)["weight_errors"], json::object());
    EXPECT_EQ(bytes("same.glb"), bytes("cactus.glb"));
  }
}

TEST_F(Command, a_miss_is_a_finding_and_still_written) {
  const CommandResult result =
      run_sunder({"tear", model(), "--ops", write("miss.json", kMiss), "-o", path("missed.glb")});
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
      {R"({"sunder_operations": 1, "operations": [{"op": "undo"}]})", "/operations/0"},
      {R"({"sunder_operations": 1, "operations": [{"op": "weights", "weights": {}}]})",
       "/operations/0"},
      {R"({"sunder_operations": 1, "operations": [{"op": "weights", "weights": {"policy": "sewn"}}]})",
       "/operations/0/weights/policy"},
      {R"({"sunder_operations": 1, "operations": [{"op": "redo", "count": 0}]})", "count"},
      {R"({"sunder_operations": 1, "operations": [{"op": "cut", "plane": {"point": [0, 1, 0], "normal": [0, 1, 0]},
         "bounds": [[0, 1, 0], [1, 1, 0], [0.1, 1, 0.1], [0, 1, 1]]}]})",
       "/operations/0"},
      {R"({"sunder_operations": 1, "operations": [{"op": "drill", "axis": {"origin": [0, 1, 1], "direction": [0, 0, -1]},
         "radius": 0.1, "depth": 1, "chord_tolerance": 0.2}]})",
       "/operations/0"},
      {R"({"sunder_operations": 1, "operations": [{"op": "drill", "pose": {"matrices": [[1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0]]},
         "axis": {"origin": [0, 1, 1], "direction": [0, 0, -1]}, "radius": 0.1, "depth": 1}]})",
       "/operations/0"},
  };
  for (const Case& bad : cases) {
    const CommandResult result = run_sunder(
        {"tear", model(), "--ops", write("bad.json", bad.operations), "-o", path("bad.glb")});
    EXPECT_EQ(result.exit_code, 2) << bad.operations << result.err;
    EXPECT_THAT(result.err, HasSubstr(bad.words));
    EXPECT_THAT(result.err, HasSubstr("bad.json"));
    EXPECT_THAT(result.out, IsEmpty());
    EXPECT_FALSE(exists("bad.glb"));
  }
  EXPECT_EQ(
      run_sunder({"tear", model(), "--ops", path("no such.json"), "-o", path("bad.glb")}).exit_code,
      3);
}

TEST_F(Command, a_failing_operation_after_a_good_one_writes_nothing) {
  json operations = json::parse(kOneTear);
  operations["operations"].push_back(operations["operations"][0]);
  operations["operations"][1]["pose"]["clip"] = 99;
  std::ofstream(path("kept.glb")) << "was here before";
  const CommandResult result = run_sunder(
      {"tear", model(), "--ops", write("second.json", operations.dump()), "-o", path("kept.glb")});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(result.err, HasSubstr("/operations/1"));
  EXPECT_EQ(bytes("kept.glb").size(), 15u);
}

TEST_F(Command, an_output_that_cannot_be_written_exits_with_3) {
  const CommandResult result = run_sunder(
      {"tear", model(), "--ops", write("a.json", kOneTear), "-o", path("no such folder/torn.glb")});
  EXPECT_EQ(result.exit_code, 3);
  EXPECT_THAT(result.out, IsEmpty());
}

TEST_F(Command, demo_without_a_renderer_writes_everything_except_pictures) {
  const CommandResult result = run_sunder({"demo", "-o", path("demo")}, {{"PATH", "/nonexistent"}});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(result.err, HasSubstr("f3d"));
  EXPECT_TRUE(exists("demo/torn.glb"));
  EXPECT_TRUE(exists("demo/report.json"));
  EXPECT_FALSE(exists("demo/torn.png"));

  std::ifstream stream(path("demo/report.json"));
  const json errors = json::parse(stream)["weight_errors"];
  ASSERT_EQ(errors.size(), 4u);
  EXPECT_GT(errors["barycentric"]["operations"]["maximum"].get<double>(), 1e-5);
  EXPECT_LT(errors["pose_exact"]["operations"]["maximum"].get<double>(), 1e-6);
  EXPECT_LT(errors["refit"]["clips"]["rms"], errors["barycentric"]["clips"]["rms"]);
  EXPECT_LT(errors["exact"]["range_of_motion"]["maximum"].get<double>(), 1e-6);

  // The demo's own log repeats its tear.
  ASSERT_EQ(run_sunder({"tear", path("demo/cactus.glb"), "--ops", path("demo/ops.json"), "-o",
                        path("again.glb"), "--report", path("again.json")})
                .exit_code,
            0);
  std::ifstream first(path("demo/report.json")), second(path("again.json"));
  json of_demo = json::parse(first)["result"], of_file = json::parse(second)["result"];
  of_demo.erase("digest");  // the file has the meshes in another order
  of_file.erase("digest");
  EXPECT_EQ(of_demo, of_file);
}

TEST_F(Command, demo_draws_four_pictures) {
  if (std::system("command -v f3d xvfb-run >/dev/null 2>&1") != 0)
    GTEST_SKIP() << "needs f3d and xvfb-run";
  const CommandResult result = run_sunder({"demo", model(), "-o", path("pictures")});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  for (const char* const name : {"before", "torn", "later_1", "later_2"})
    EXPECT_GT(std::filesystem::file_size(path("pictures/" + std::string(name) + ".png")), 10'000u)
        << name;
}

TEST_F(Command, tear_draws_a_picture_of_the_result) {
  if (std::system("command -v f3d xvfb-run >/dev/null 2>&1") != 0)
    GTEST_SKIP() << "needs f3d and xvfb-run";
  for (const char* const operations : {kOneTear, kAll}) {
    const CommandResult result =
        run_sunder({"tear", model(), "--ops", write("drawn.json", operations), "-o",
                    path("drawn.glb"), "--picture", path("drawn.png")});
    EXPECT_LE(result.exit_code, 1) << result.err;
    EXPECT_THAT(result.err, IsEmpty());
    EXPECT_GT(std::filesystem::file_size(path("drawn.png")), 10'000u);
    std::filesystem::remove(path("drawn.png"));
  }
}

TEST_F(Command, a_picture_that_cannot_be_drawn_is_a_finding) {
  const CommandResult no_renderer =
      run_sunder({"tear", model(), "--ops", write("a.json", kOneTear), "-o", path("undrawn.glb"),
                  "--picture", path("undrawn.png")},
                 {{"PATH", "/nonexistent"}});
  EXPECT_EQ(no_renderer.exit_code, 1);
  EXPECT_THAT(no_renderer.err, HasSubstr("f3d"));
  EXPECT_TRUE(exists("undrawn.glb"));
  EXPECT_EQ(json::parse(no_renderer.out)["operations"].size(), 1u);

  const std::string none = write("none.json", R"({"sunder_operations": 1, "operations": []})");
  const CommandResult nothing = run_sunder({"tear", model(), "--ops", none, "-o",
                                            path("undrawn.glb"), "--picture", path("undrawn.png")});
  EXPECT_EQ(nothing.exit_code, 1);
  EXPECT_THAT(nothing.err, HasSubstr("undrawn.png"));
  EXPECT_FALSE(exists("undrawn.png"));
}

}  // namespace
}  // namespace sunder
