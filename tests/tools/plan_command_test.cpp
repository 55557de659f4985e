// sunder plan: the trajectory that it writes makes the wound with sunder tear.

#include <cmath>
#include <filesystem>

#include "tools/command_fixture.h"

namespace sunder::command_test {
namespace {

namespace fs = std::filesystem;

constexpr const char* kCurve = R"({"sunder_curve": 1, "depth": 0.02, "angle": 80,
  "places": [{"point": [-0.08, 1.5, 0.3]}, {"point": [-0.03, 1.4, 0.3]}, {"point": [-0.06, 1.2, 0.3]}]})";

class PlanCommand : public CactusSuite {
 protected:
  void SetUp() override {
    if (!fs::exists(SUNDER_COUPLED_COMMAND)) GTEST_SKIP() << "built without Ceres (SUNDER_CERES)";
  }
  static std::string curve(const std::string& text = kCurve) { return write("curve.json", text); }
  static std::string arm() {
    return std::string(SUNDER_SOURCE_DIR) + "/docs/pictures/plan/arm.urdf";
  }

  static CommandResult plan(std::vector<std::string> more) {
    std::vector<std::string> arguments = {
        "plan",         model(), "--curve", path("curve.json"), "--pose", "Sway@0.4",
        "--clip-speed", "1",     "-o",      path("plan.csv")};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run_sunder(arguments);
  }
  static CommandResult plan_with_arm(const std::string& place, std::vector<std::string> more = {}) {
    more.insert(more.end(), {"--robot", arm(), "--blade", "tool", "--edge", "0,0,0.14,0,0,0.24",
                             "--robot-place", place});
    return plan(std::move(more));
  }
  static void expect_usage_error(const CommandResult& result, const char* text) {
    EXPECT_EQ(result.exit_code, 2) << result.out;
    EXPECT_THAT(result.err, HasSubstr(text));
  }
};

TEST_F(PlanCommand, an_arm_makes_the_wound_and_tear_makes_it_again) {
  (void)curve();
  const CommandResult planned =
      plan_with_arm("0.25,0.85,0.85", {"--tear", path("torn.glb"), "--report", path("plan.json")});
  ASSERT_EQ(planned.exit_code, 0) << planned.err;
  EXPECT_THAT(planned.out, HasSubstr("lips        at most"));
  const json report = read_json("plan.json");
  EXPECT_EQ(report["sunder_plan"], 1);
  EXPECT_TRUE(report["is_reachable"].get<bool>());
  EXPECT_LE(report["lips"]["hausdorff"].get<double>(), report["tolerance"].get<double>());
  ASSERT_EQ(report["values"].size(), 6u);
  for (const json& value : report["values"]) EXPECT_GE(value["to_limits"].get<double>(), 0);
  const CommandResult again =
      run_sunder({"tear", model(), "--robot", arm(), "--trajectory", path("plan.csv"), "--blade",
                  "tool", "--edge", "0,0,0.14,0,0,0.24", "--robot-place", "0.25,0.85,0.85",
                  "--pose", "Sway@0.4", "--clip-speed", "1", "-o", path("again.glb")});
  ASSERT_EQ(again.exit_code, 0) << again.err;
  EXPECT_EQ(bytes("again.glb"), bytes("torn.glb"));
  const auto first = bytes("plan.csv");
  ASSERT_EQ(plan_with_arm("0.25,0.85,0.85").exit_code, 0);
  EXPECT_EQ(bytes("plan.csv"), first);
}

TEST_F(PlanCommand, like_a_torn_model_makes_its_wound_again) {
  (void)curve();
  ASSERT_EQ(
      plan({"--hand", path("hand.urdf"), "--tear", path("torn.glb"), "--report", path("plan.json")})
          .exit_code,
      0);
  const CommandResult like =
      run_sunder({"plan", model(), "--like", path("torn.glb"), "--like-depth", "2cm", "--hand",
                  path("again.urdf"), "-o", path("again.csv"), "--report", path("again.json")});
  ASSERT_EQ(like.exit_code, 0) << like.err;
  const json first = read_json("plan.json"), again = read_json("again.json");
  EXPECT_EQ(again["curve"], path("torn.glb"));
  const double length = first["curve_length"].get<double>();
  EXPECT_NEAR(again["curve_length"].get<double>(), length, 0.1 * length);  // of another pose
  const CommandResult whole = run_sunder(
      {"plan", model(), "--like", model(), "--hand", path("again.urdf"), "-o", path("again.csv")});
  expect_usage_error(whole, "there are no lips of a tear");
  expect_usage_error(
      run_sunder({"plan", model(), "--hand", path("again.urdf"), "-o", path("again.csv")}),
      "--curve or --like");
}

TEST_F(PlanCommand, a_hand_is_written_as_a_robot) {
  (void)curve();
  const CommandResult planned = plan({"--hand", path("hand.urdf"), "--hand-blade", "12cm", "--tear",
                                      path("torn.glb"), "--report", path("plan.json")});
  ASSERT_EQ(planned.exit_code, 0) << planned.err;
  const CommandResult info = run_sunder({"info", path("hand.urdf")});
  EXPECT_THAT(info.out, HasSubstr("8 links, 7 joints, 6 values"));
  // The lips that the file's hand tears are as far from the curve as those that were planned.
  const CommandResult torn =
      run_sunder({"tear", model(), "--robot", path("hand.urdf"), "--trajectory", path("plan.csv"),
                  "--blade", "blade", "--edge", "0,0,0.12,0,0,0", "--pose", "Sway@0.4",
                  "--clip-speed", "1", "-o", path("again.glb"), "--report", path("tear.json")});
  ASSERT_EQ(torn.exit_code, 0) << torn.err;
  EXPECT_EQ(bytes("again.glb"), bytes("torn.glb"));
  const json tear = read_json("tear.json");
  EXPECT_NEAR(tear["operations"][0]["length_posed"].get<double>(),
              read_json("plan.json")["curve_length"].get<double>(), 0.02);
}

TEST_F(PlanCommand, what_cannot_be_made_is_a_finding_and_writes_only_the_report) {
  (void)curve();
  const CommandResult far =
      plan_with_arm("0.25,0.85,2.5", {"--report", path("far.json"), "--tear", path("far.glb")});
  EXPECT_EQ(far.exit_code, 1) << far.err;
  EXPECT_THAT(far.err, HasSubstr("out of reach"));
  EXPECT_THAT(far.out, HasSubstr("no part of the curve"));
  EXPECT_FALSE(exists("far.glb"));
  EXPECT_EQ(read_json("far.json")["obstacles"][0]["kind"], "reach");
  EXPECT_THAT(far.err, HasSubstr("--robot-place"));  // from where it works
  const auto place = read_json("far.json")["base"]["robot_place"].get<std::vector<double>>();
  ASSERT_EQ(place.size(), 3u);
  const std::string near =
      std::to_string(place[0]) + "," + std::to_string(place[1]) + "," + std::to_string(place[2]);
  EXPECT_EQ(plan_with_arm(near).exit_code, 0);
}

TEST_F(PlanCommand, a_gape_has_a_tension) {
  (void)curve(R"({"sunder_curve": 1, "depth": 0.02, "gape": 0.012,
    "places": [{"point": [-0.08, 1.5, 0.3]}, {"point": [-0.06, 1.2, 0.3]}]})");
  const CommandResult planned = plan({"--hand", path("hand.urdf"), "--report", path("plan.json")});
  ASSERT_EQ(planned.exit_code, 0) << planned.err;
  EXPECT_THAT(planned.out, HasSubstr("gape "));
  const json gape = read_json("plan.json")["gape"];
  EXPECT_NEAR(gape["widest"].get<double>(), 0.012, 0.15 * 0.012);
  EXPECT_GT(gape["tension"].get<double>(), 0);
  (void)curve(R"({"sunder_curve": 1, "gape": "wide", "places": []})");
  expect_usage_error(plan({"--hand", path("hand.urdf")}), "'/gape'");
}

TEST_F(PlanCommand, a_motion_that_was_performed_is_marked) {
  (void)curve();
  ASSERT_EQ(plan_with_arm("0.25,0.85,0.85").exit_code, 0);
  const auto score = [](const std::string& performed, std::vector<std::string> more) {
    std::vector<std::string> arguments = {"plan",    model(),   "--curve",  path("curve.json"),
                                          "--score", performed, "--report", path("score.json")};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run_sunder(arguments);
  };
  const std::vector<std::string> robot = {"--robot",       arm(),
                                          "--blade",       "tool",
                                          "--edge",        "0,0,0.14,0,0,0.24",
                                          "--robot-place", "0.25,0.85,0.85",
                                          "--pose",        "Sway@0.4",
                                          "--clip-speed",  "1"};
  const CommandResult good = score(path("plan.csv"), robot);
  ASSERT_EQ(good.exit_code, 0) << good.err;
  EXPECT_THAT(good.out, HasSubstr("mark "));
  const json report = read_json("score.json");
  EXPECT_EQ(report["sunder_score"], 1);
  EXPECT_GT(report["marks"]["whole"].get<double>(), 93);
  EXPECT_EQ(report["units"]["length"], "m");
  EXPECT_LE(report["place_error"]["most"].get<double>(), report["tolerance"].get<double>());
  EXPECT_GT(report["pace"]["speed"].get<double>(), 0);

  // A log: four blades beside the curve, at ten a second.
  (void)write("log.json", R"({"sunder_operations": 1, "operations": [{"op": "tear", "stroke": [
    {"base": [-0.07, 1.5, 0.4], "tip": [-0.07, 1.5, 0.1]},
    {"base": [-0.04, 1.4, 0.4], "tip": [-0.04, 1.4, 0.1]},
    {"base": [-0.04, 1.3, 0.4], "tip": [-0.04, 1.3, 0.1]},
    {"base": [-0.06, 1.2, 0.4], "tip": [-0.06, 1.2, 0.1]}]}]})");
  const CommandResult logged = score(path("log.json"), {});
  ASSERT_EQ(logged.exit_code, 0) << logged.err;
  EXPECT_TRUE(read_json("score.json")["marks"]["speed"].is_null());
  EXPECT_LT(read_json("score.json")["marks"]["whole"].get<double>(), 90);
  ASSERT_EQ(score(path("log.json"), {"--score-rate", "10"}).exit_code, 0);
  EXPECT_NEAR(read_json("score.json")["pace"]["seconds"].get<double>(), 0.3, 1e-9);
  expect_usage_error(score(path("plan.csv"), {}), "needs --robot");
  (void)write("log.json", R"({"sunder_operations": 1, "operations": []})");
  expect_usage_error(score(path("log.json"), {}), "the log has 0 tears");
  expect_usage_error(score(path("log.json"), {"-o", path("x.csv")}), "--output excludes --score");
  expect_usage_error(
      run_sunder({"plan", model(), "--curve", path("curve.json"), "--hand", path("hand.urdf")}),
      "--output is required");
}

TEST_F(PlanCommand, faults_name_what_is_wrong) {
  const std::string hand = path("refused.urdf");
  (void)curve("{\"sunder_curve\": 2}");
  expect_usage_error(plan({"--hand", hand}), "'/sunder_curve': expected the version, 1");
  (void)curve(R"({"sunder_curve": 1, "places": [{"point": [0, 1, 0]}], "deep": 1})");
  expect_usage_error(plan({"--hand", hand}), "'/deep' is not known");
  (void)curve(R"({"sunder_curve": 1, "places": [{"point": [0, 1]}]})");
  expect_usage_error(plan({"--hand", hand}), "'/places/0/point': expected three numbers");
  (void)curve(
      R"({"sunder_curve": 1, "places": [{"mesh": "Cactos", "triangle": 1, "barycentric": [1, 0, 0]}]})");
  expect_usage_error(plan({"--hand", hand}), "no mesh 'Cactos'");
  (void)curve(R"({"sunder_curve": 1, "places": [{"point": [0, 1.2, 1]}]})");
  expect_usage_error(plan({"--hand", hand}), "the curve has 1 places");
  (void)curve(R"({"sunder_curve": 1, "depth": [0.01], "angle": "steep", "places": []})");
  expect_usage_error(plan({"--hand", hand}), "'/angle'");
  // From the trunk to the tip of an arm in front of it.
  (void)curve(
      R"({"sunder_curve": 1, "places": [{"point": [0, 1.05, 0.3]}, {"point": [0, 0.95, 0.45]}]})");
  expect_usage_error(plan({"--hand", hand}), "places 0 and 1");
  (void)curve();
  expect_usage_error(plan({}), "--robot or --hand");
  expect_usage_error(plan({"--robot", arm()}), "--blade");
  expect_usage_error(plan({"--robot", arm(), "--blade", "tol"}), "'tool'");
  expect_usage_error(plan({"--hand", path("curve.json")}), "--hand");
  EXPECT_FALSE(exists("refused.urdf"));
}

}  // namespace
}  // namespace sunder::command_test
