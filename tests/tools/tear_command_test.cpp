// `sunder tear` from the outside: operations, reports, exit codes, and what it leaves on disk.

#include <algorithm>
#include <cstdlib>

#include "support/machine/gltf_validator.h"
#include "tools/command_fixture.h"
#include "tools/picture_pixels.h"

namespace sunder::command_test {
namespace {

class TearCommand : public CactusSuite {};

const char* const kMiss = R"({"sunder_operations": 1, "operations": [
  {"op": "tear", "stroke": [{"base": [9, 9, 2], "tip": [9, 9, 0]}, {"base": [9, 10, 2], "tip": [9, 10, 0]}]}]})";

TEST_F(TearCommand, tear_reports_its_results) {
  const CommandResult result =
      run_sunder({"tear", model(), "--ops", write("a.json", kOneTear), "-o", path("torn.glb"),
                  "--report", "-", "--count-topology"});
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

TEST_F(TearCommand, tear_plays_every_operation) {
  const CommandResult result = run_sunder({"tear", model(), "--ops", write("all.json", kAll), "-o",
                                           path("all.glb"), "--report", "-", "--count-topology"});
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

/// Checked by our own reader and, if it is installed, by the Khronos validator.
TEST_F(TearCommand, tear_writes_valid_files) {
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

TEST_F(TearCommand, the_report_goes_where_it_is_wanted) {
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

TEST_F(TearCommand, the_same_operations_give_the_same_bytes) {
  const std::string operations = write("a.json", kOneTear);
  ASSERT_EQ(run_sunder({"tear", model(), "--ops", operations, "-o", path("one.glb")}).exit_code, 0);
  ASSERT_EQ(run_sunder({"tear", model(), "--ops", operations, "-o", path("two.glb")}).exit_code, 0);
  EXPECT_EQ(bytes("one.glb"), bytes("two.glb"));
}

TEST_F(TearCommand, no_operation_gives_the_source) {
  const std::string none = write("none.json", R"({"sunder_operations": 1, "operations": []})");
  ASSERT_EQ(run_sunder({"tear", model(), "--ops", none, "-o", path("same.glb")}).exit_code, 0);
  EXPECT_EQ(bytes("same.glb"), bytes("cactus.glb"));
  for (const char* const weights : {"refit", "exact"}) {
    const CommandResult result =
        run_sunder({"tear", model(), "--ops", none, "-o", path("same.glb"), "--weights", weights,
                    "--report", "-", "--weight-errors"});
    ASSERT_EQ(result.exit_code, 0) << result.err;
    EXPECT_EQ(json::parse(result.out)["weight_errors"], json::object());
    EXPECT_EQ(bytes("same.glb"), bytes("cactus.glb"));
  }
}

TEST_F(TearCommand, a_miss_is_a_finding_and_still_written) {
  const CommandResult result = run_sunder({"tear", model(), "--ops", write("miss.json", kMiss),
                                           "-o", path("missed.glb"), "--report", "-"});
  EXPECT_EQ(result.exit_code, 1) << result.err;
  EXPECT_EQ(json::parse(result.out)["operations"][0]["status"], "missed");
  EXPECT_EQ(bytes("missed.glb"), bytes("cactus.glb"));
}

TEST_F(TearCommand, bad_operations_exit_with_2_name_their_place_and_leave_nothing) {
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

TEST_F(TearCommand, a_failing_operation_after_a_good_one_writes_nothing) {
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

TEST_F(TearCommand, an_output_that_cannot_be_written_exits_with_3) {
  const CommandResult result = run_sunder(
      {"tear", model(), "--ops", write("a.json", kOneTear), "-o", path("no such folder/torn.glb")});
  EXPECT_EQ(result.exit_code, 3);
  EXPECT_THAT(result.out, IsEmpty());
}

TEST_F(TearCommand, tear_draws_a_picture_of_the_result) {
  for (const char* const operations : {kOneTear, kAll}) {
    const CommandResult result =
        run_sunder({"tear", model(), "--ops", write("drawn.json", operations), "-o",
                    path("drawn.glb"), "--picture", path("drawn.png"), "-q"});
    EXPECT_EQ(result.exit_code, operations == kOneTear ? 0 : 1) << result.err;
    EXPECT_GT(std::filesystem::file_size(path("drawn.png")), 10'000u);
    std::filesystem::remove(path("drawn.png"));
  }
}

TEST_F(TearCommand, normals_against_the_winding_do_not_darken_the_picture) {
  Character turned = tools::make_cactus();
  for (Mesh& mesh : turned.meshes)
    for (Vec3f& normal : mesh.normals) normal = -normal;
  ASSERT_TRUE(save_glb(path("turned.glb"), turned));
  const auto drawn = [&](const std::string& of, const std::string& picture) {
    const CommandResult result =
        run_sunder({"tear", of, "--ops", write("turned.json", kOneTear), "-o",
                    path("turned_torn.glb"), "--picture", path(picture), "-q"});
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return test::read_png(path(picture));
  };
  const auto wanted = drawn(model(), "right.png"), found = drawn(path("turned.glb"), "turned.png");
  ASSERT_TRUE(wanted && found);
  ASSERT_EQ(found->colors.size(), wanted->colors.size());
  std::size_t other = 0;
  for (std::size_t i = 0; i < wanted->colors.size(); ++i)
    other += test::is_near(wanted->colors[i], found->colors[i], 40) ? 0u : 1u;
  EXPECT_LT(other, wanted->colors.size() / 200);
}

TEST_F(TearCommand, a_picture_that_cannot_be_drawn_is_a_finding) {
  const std::string none = write("none.json", R"({"sunder_operations": 1, "operations": []})");
  const CommandResult nothing = run_sunder({"tear", model(), "--ops", none, "-o",
                                            path("undrawn.glb"), "--picture", path("undrawn.png")});
  EXPECT_EQ(nothing.exit_code, 1);
  EXPECT_THAT(nothing.err, HasSubstr("undrawn.png"));
  EXPECT_FALSE(exists("undrawn.png"));
}

}  // namespace
}  // namespace sunder::command_test
