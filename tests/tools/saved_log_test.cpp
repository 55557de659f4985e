// The log that `sunder tear --save-log` writes gives the same model again.

#include "support/models/shared_models.h"
#include "tools/command_fixture.h"

namespace sunder::command_test {
namespace {

class SavedLog : public CactusSuite {};

/// Applies a log, then the log that it saved, and expects the same model.
void expect_replay(const std::string& model, const std::string& operations, const std::string& stem,
                   const std::string& weights = "barycentric") {
  const CommandResult played =
      run_sunder({"tear", model, "--ops", operations, "-o", stem + "1.glb", "--save-log",
                  stem + "1.json", "--weights", weights, "--report", "-", "--weight-errors"});
  ASSERT_LE(played.exit_code, 1) << played.err;
  const CommandResult replayed =
      run_sunder({"tear", model, "--ops", stem + "1.json", "-o", stem + "2.glb", "--save-log",
                  stem + "2.json", "--report", "-", "--weight-errors"});
  ASSERT_EQ(replayed.exit_code, 0) << replayed.err;
  EXPECT_EQ(json::parse(played.out)["result"], json::parse(replayed.out)["result"]);
  EXPECT_EQ(json::parse(played.out)["weight_errors"], json::parse(replayed.out)["weight_errors"]);
  EXPECT_EQ(test::read_bytes(stem + "1.glb"), test::read_bytes(stem + "2.glb"));
  EXPECT_EQ(test::read_bytes(stem + "1.json"), test::read_bytes(stem + "2.json"));
}

TEST_F(SavedLog, a_saved_log_gives_the_same_model) {
  expect_replay(model(), write("all.json", kAll), path("replay"));
  std::ifstream stream(path("replay1.json"));
  const json log = json::parse(stream);
  EXPECT_EQ(log["operations"].size(), 4u);  // The history has no undone and missed operations.
  for (const json& operation : log["operations"])
    EXPECT_TRUE(operation["pose"].contains("matrices"));
}

TEST_F(SavedLog, a_saved_log_gives_the_same_model_from_a_file_with_clips) {
  const std::string tube = (test::own_data() / "rigged" / "two_clips.glb").string();
  const std::string operations = write("tube.json", R"({"sunder_operations": 1, "operations": [
    {"op": "cut", "pose": {"clip": 0, "time": 0.3}, "plane": {"point": [0, 2.2, 0], "normal": [0, 1, 0]}},
    {"op": "drill", "pose": {"clip": 1, "time": 0.2}, "axis": {"origin": [0, 0.5, 5], "direction": [0, 0, -1]}, "radius": 0.1, "depth": 10},
    {"op": "tear", "layers": "all", "width": 0.02, "stroke": [{"base": [-0.3, 1.2, 5], "tip": [-0.3, 1.2, -5]},
     {"base": [0.3, 1.3, 5], "tip": [0.3, 1.3, -5], "pose": {"clip": 1, "time": 0.6}}]},
    {"op": "undo", "count": 2}, {"op": "redo"}]})");
  expect_replay(tube, operations, path("tube"));
}

TEST_F(SavedLog, a_saved_log_gives_the_same_model_from_an_artists_file) {
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

TEST_F(SavedLog, a_saved_log_gives_the_same_weights) {
  expect_replay(model(), write("weighed.json", kWeighed), path("replayed"));
  for (const char* const weights : {"pose_exact", "refit", "exact"})
    expect_replay(model(), write("all.json", kAll), path("replayed"), weights);
}

TEST_F(SavedLog, a_log_that_cannot_be_saved_leaves_nothing) {
  const CommandResult result = run_sunder(
      {"tear", model(), "--ops", write("a.json", kOneTear), "-o", path("unlogged.glb"),
       "--save-log", path("no such folder/log.json"), "--report", path("unlogged.json")});
  EXPECT_EQ(result.exit_code, 3);
  EXPECT_THAT(result.err, HasSubstr("no such folder/log.json"));
  EXPECT_FALSE(exists("unlogged.glb"));
  EXPECT_FALSE(exists("unlogged.json"));
}

}  // namespace
}  // namespace sunder::command_test
