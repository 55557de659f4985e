// `sunder tear`: how new vertices are skinned and how influences are written.

#include <sunder/skinning/deform.h>
#include <sunder/skinning/pose.h>

#include <algorithm>
#include <map>

#include "skinning/internal/reference.h"
#include "support/models/rigs.h"
#include "support/models/shared_models.h"
#include "tools/command_fixture.h"

namespace sunder::command_test {
namespace {

class TearWeightsCommand : public CactusSuite {};

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

TEST_F(TearWeightsCommand, tear_reports_the_written_influences) {
  const std::string operations = write("a.json", kOneTear);
  const json all =
      json::parse(run_sunder({"tear", model(), "--ops", operations, "-o", path("all_kept.glb"),
                              "--report", "-", "--influences", "all"})
                      .out);
  EXPECT_EQ(
      all["influences_written"],
      json::parse(
          R"({"maximum": "all", "format": "float", "vertices_pruned": 0, "dropped_mass_max": 0.0, "pruning_error_max": 0.0})"));
  for (const char* const format : {"float", "u16", "u8"}) {
    const CommandResult result =
        run_sunder({"tear", model(), "--ops", operations, "-o", path("pruned.glb"), "--influences",
                    "4", "--weights-as", format, "--report", "-"});
    ASSERT_EQ(result.exit_code, 0) << result.err;
    const json report = json::parse(result.out);
    const json& written = report["influences_written"];
    EXPECT_EQ(report["influences_written_max"], 4);
    EXPECT_EQ(written["maximum"], "4");
    EXPECT_EQ(written["format"], format);
    EXPECT_GT(written["vertices_pruned"], 0);
    EXPECT_GT(written["dropped_mass_max"].get<double>(), 0.0);
    EXPECT_LT(written["dropped_mass_max"].get<double>(), 0.8);  // four of at most twenty

    const auto before = load_character(path("all_kept.glb")),
               after = load_character(path("pruned.glb"));
    ASSERT_TRUE(before && after);
    double moved = greatest_distance(*before->character, *after->character, RestPose());
    for (double time = 0; time <= before->character->clips.at(0).duration; time += 0.05)
      moved = std::max(
          moved, greatest_distance(*before->character, *after->character, ClipPose{"Sway", time}));
    const double of_an_integer = format == std::string("u8")    ? 1.0 / 255
                                 : format == std::string("u16") ? 1.0 / 65535
                                                                : 0.0;
    const double told = written["pruning_error_max"];
    EXPECT_LE(moved, 1.02 * told + 1e-5 + of_an_integer) << format;
    EXPECT_GE(moved, 0.9 * told) << format;
    EXPECT_GT(moved, 0.0);
  }
}

TEST_F(TearWeightsCommand, a_source_of_four_influences_is_written_with_four_and_what_it_costs) {
  const std::string source = path("eight_bones.glb");
  ASSERT_TRUE(save_glb(source, test::make_tube(8, 12, 8)));
  const std::string operations = write("cut.json", R"({"sunder_operations": 1, "operations": [
    {"op": "cut", "pose": {"clip": "Bend", "time": 0.6}, "plane": {"point": [0, 3.4, 0], "normal": [0, 1, 0.2]}}]})");
  const auto tear = [&](const char* name, const std::vector<std::string>& options) {
    std::vector<std::string> arguments = {"tear", source, "--ops", operations, "-o", path(name)};
    arguments.insert(arguments.end(), options.begin(), options.end());
    return run_sunder(arguments);
  };
  const json report = json::parse(tear("four.glb", {"--report", "-"}).out);
  const json& written = report["influences_written"];
  EXPECT_EQ(report["influences_written_max"], 4);
  EXPECT_EQ(written["maximum"], "source");
  EXPECT_GT(written["vertices_pruned"], 0);
  EXPECT_GT(written["pruning_error_max"], 0.0);
  EXPECT_THAT(tear("four.glb", {}).out, HasSubstr("written with at most 4 influences as float: "));

  const json all_report =
      json::parse(tear("all.glb", {"--influences", "all", "--report", "-"}).out);
  EXPECT_GT(all_report["influences_written_max"], 4);
  EXPECT_EQ(all_report["influences_written"]["vertices_pruned"], 0);
  const auto all = load_character(path("all.glb")), four = load_character(path("four.glb"));
  ASSERT_TRUE(all && four);
  double moved = greatest_distance(*all->character, *four->character, RestPose());
  for (double time = 0; time <= 2; time += 0.125)
    moved = std::max(moved,
                     greatest_distance(*all->character, *four->character, ClipPose{"Bend", time}));
  EXPECT_GT(moved, 0.0);
  // Between the poses that were measured it may be a little more.
  EXPECT_LE(moved, 1.15 * written["pruning_error_max"].get<double>() + 1e-5);
}

TEST_F(TearWeightsCommand, tear_weighs_new_points_by_the_requested_policy) {
  const std::string operations = write("a.json", kOneTear);
  std::map<std::string, json> reports;
  for (const char* const policy : {"barycentric", "pose_exact", "refit", "exact"}) {
    const CommandResult result =
        run_sunder({"tear", model(), "--ops", operations, "-o", path("weighed.glb"), "--weights",
                    policy, "--report", "-", "--weight-errors"});
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
      EXPECT_EQ(errors[set]["points"], errors[set]["points_of"]);
      EXPECT_LE(errors[set]["poses"], 24);
      EXPECT_LE(errors[set]["poses"], errors[set]["poses_of"]);
      EXPECT_GE(errors[set]["maximum"], errors[set]["percentile95"]);
      for (const char* const unit : {"of_diagonal", "of_edge"})
        EXPECT_GE(errors[set][unit]["maximum"], errors[set][unit]["rms"]) << set << unit;
    }
    EXPECT_EQ(errors["operations"]["poses"], 1);
    if (report["operations"].size() == 1) {
      EXPECT_EQ(errors["operations"]["maximum"], report["operations"][0]["weights"]["error_max"]);
    }
    EXPECT_GE(errors["clips"]["poses"], 2);
    EXPECT_EQ(errors["clips_held_out"]["poses"], errors["clips"]["poses"]);
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
  EXPECT_EQ(reports["refit"]["weights"]["refit_over"], "clips,range_of_motion");
  EXPECT_TRUE(reports["exact"]["weights"]["refit_over"].is_null());

  EXPECT_FALSE(reports["refit"]["weight_errors"].contains("as_written"));
  const json& as_written = reports["exact"]["weight_errors"]["as_written"];
  EXPECT_EQ(as_written, reports["barycentric"]["weight_errors"]);
  EXPECT_THAT(reports["exact"]["weight_errors"]["note"].get<std::string>(),
              HasSubstr("barycentric"));
}

TEST_F(TearWeightsCommand, influences_are_kept_in_weights_too) {
  const std::string operations = write("c.json", R"({"sunder_operations": 1, "operations": [
    {"op": "cut", "pose": {"clip": "Sway", "time": 0.8}, "plane": {"point": [0, 0.8, 0], "normal": [0, 1, 0]}}]})");
  for (const char* const policy : {"barycentric", "pose_exact", "refit", "exact"}) {
    const CommandResult result =
        run_sunder({"tear", model(), "--ops", operations, "-o", path("four.glb"), "--weights",
                    policy, "--influences", "4", "--report", "-"});
    ASSERT_EQ(result.exit_code, 0) << result.err;
    const json report = json::parse(result.out);
    const bool is_exact = policy == std::string("exact");
    EXPECT_EQ(report["weights"]["influences"], is_exact ? 0 : 4);
    EXPECT_EQ(report["operations"][0]["weights"]["pruned"] > 0, !is_exact) << policy;
  }
}

TEST_F(TearWeightsCommand, a_refit_uses_the_requested_poses) {
  const std::string operations = write("a.json", kOneTear);
  for (const char* const over :
       {"clips", "range_of_motion", "clips=2,clips:Sway=3,range_of_motion=0.5"}) {
    const CommandResult result = run_sunder(
        {"tear", model(), "--ops", operations, "-o", path("refit.glb"), "--weights", "refit",
         "--refit-over", over, "--save-log", path("refit.json"), "--report", "-"});
    ASSERT_EQ(result.exit_code, 0) << result.err;
    EXPECT_EQ(json::parse(result.out)["weights"]["refit_over"], over);
    std::ifstream stream(path("refit.json"));
    const json log = json::parse(stream);
    ASSERT_EQ(log["operations"].size(), 2u);
    const json& poses = log["operations"][1]["refit"]["poses"];
    EXPECT_EQ(poses["clip_samples"] == 32, over != std::string("range_of_motion"));
    EXPECT_EQ(poses["range_of_motion"] == true, over != std::string("clips"));
    const json& importance = log["operations"][1]["refit"]["importance"];
    const bool has_factors = std::string(over).find('=') != std::string::npos;
    EXPECT_EQ(importance["clips"], has_factors ? 2 : 1);
    EXPECT_EQ(importance["range_of_motion"], has_factors ? 0.5 : 1);
    EXPECT_EQ(importance["of_clip"].size(), has_factors ? 1u : 0u);
  }
  for (const std::vector<std::string>& arguments :
       std::vector<std::vector<std::string>>{{"--refit-over", "clips"},
                                             {"--weights", "exact", "--refit-over", "clips"},
                                             {"--weights", "refit", "--refit-over", "both"},
                                             {"--weights", "refit", "--refit-over", "clips=-1"},
                                             {"--weights", "refit", "--refit-over", ""},
                                             {"--weights", "exact", "--refit-bound", "2"},
                                             {"--weights", "refit", "--refit-bound", "0.5"},
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

TEST_F(TearWeightsCommand, a_model_without_clips_is_refitted_over_its_range_of_motion) {
  Character still = tools::make_cactus();
  still.clips.clear();
  ASSERT_TRUE(save_glb(path("still.glb"), still));
  const std::string operations = write("still.json", R"({"sunder_operations": 1, "operations": [
    {"op": "drill", "axis": {"origin": [0, 0.4, 2], "direction": [0, 0, -1]}, "radius": 0.02, "depth": 4}]})");
  const CommandResult result =
      run_sunder({"tear", path("still.glb"), "--ops", operations, "-o", path("bored.glb"),
                  "--weights", "refit", "--report", "-", "--weight-errors"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const json report = json::parse(result.out);
  EXPECT_EQ(report["weights"]["refit_over"], "clips,range_of_motion");
  EXPECT_FALSE(report["weight_errors"].contains("clips"));
  EXPECT_TRUE(report["weight_errors"].contains("range_of_motion"));

  const CommandResult no_clips =
      run_sunder({"tear", path("still.glb"), "--ops", operations, "-o", path("unbored.glb"),
                  "--weights", "refit", "--refit-over", "clips"});
  EXPECT_EQ(no_clips.exit_code, 2);
  EXPECT_THAT(no_clips.err, HasSubstr("--refit-over"));
  EXPECT_FALSE(exists("unbored.glb"));
}

TEST_F(TearWeightsCommand, a_model_that_does_not_bend_needs_no_refit) {
  Character stiff = tools::make_cactus();
  stiff.clips.clear();
  for (Mesh& mesh : stiff.meshes) {
    mesh.weights.influences.assign(mesh.vertex_count(), {0, 1.0f});
    for (std::uint32_t v = 0; v <= mesh.vertex_count(); ++v) mesh.weights.first[v] = v;
  }
  ASSERT_TRUE(save_glb(path("stiff.glb"), stiff));
  const std::string operations = write("stiff.json", R"({"sunder_operations": 1, "operations": [
    {"op": "drill", "axis": {"origin": [0, 0.4, 2], "direction": [0, 0, -1]}, "radius": 0.02, "depth": 4}]})");
  const CommandResult result =
      run_sunder({"tear", path("stiff.glb"), "--ops", operations, "-o", path("bored.glb"),
                  "--weights", "refit", "--report", "-", "--weight-errors"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const json report = json::parse(result.out);
  EXPECT_TRUE(report["weights"]["refit_over"].is_null());
  EXPECT_EQ(report["operations"].size(), 1u);
  EXPECT_EQ(report["weight_errors"].size(), 1u);
  EXPECT_LT(report["weight_errors"]["operations"]["maximum"].get<double>(), 1e-6);
}

TEST_F(TearWeightsCommand, weights_of_the_log_win) {
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

}  // namespace
}  // namespace sunder::command_test
