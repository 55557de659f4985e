// `sunder tear --robot` from the outside: the arm of docs/pictures/robot tears the cactus.

#include <sunder/robot/trajectory.h>

#include "support/models/shared_models.h"
#include "tools/command_fixture.h"

namespace sunder::command_test {
namespace {

using testing::AllOf;

class RobotTear : public CactusSuite {
 protected:
  static std::string of_docs(const std::string& name) {
    return std::string(SUNDER_SOURCE_DIR) + "/docs/pictures/robot/" + name;
  }
  /// The arm of the documentation, with further arguments.
  static CommandResult tear(const std::vector<std::string>& more,
                            const std::string& trajectory = of_docs("arm.csv"),
                            const std::string& link = "scalpel") {
    std::vector<std::string> arguments = {
        "tear",    model(), "--robot", of_docs("arm.urdf"), "--trajectory", trajectory,
        "--blade", link,    "--edge",  "0,0,0,0.16,0,0"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run_sunder(arguments);
  }
  inline static const std::vector<std::string> kPlace = {"--robot-place", "0,0,0.95,0,90,0"};
  static std::vector<std::string> placed(std::vector<std::string> more) {
    more.insert(more.begin(), kPlace.begin(), kPlace.end());
    return more;
  }
};

TEST_F(RobotTear, the_arm_tears_the_cactus_while_it_sways) {
  const CommandResult result =
      tear(placed({"--pose", "Sway@0.2", "--clip-speed", "1", "-o", path("torn.glb"), "--report",
                   path("r.json"), "--save-log", path("log.json")}));
  ASSERT_EQ(result.exit_code, 0) << result.err << result.out;
  EXPECT_THAT(result.err, HasSubstr("--robot: blade 'scalpel'"));
  const json report = read_json("r.json");
  EXPECT_EQ(report["robot"]["link"], "scalpel");
  EXPECT_EQ(report["robot"]["exceeded_limits"], json::array());
  ASSERT_EQ(report["operations"].size(), 1u);
  EXPECT_EQ(report["operations"][0]["status"], "torn");
  EXPECT_GT(report["operations"][0]["length_posed"], 0.3);
  EXPECT_EQ(report["operations"][0]["runs"], 1);
  // The log tears the same without a robot.
  const CommandResult again =
      run_sunder({"tear", model(), "--ops", path("log.json"), "-o", path("again.glb")});
  ASSERT_EQ(again.exit_code, 0) << again.err;
  EXPECT_EQ(bytes("again.glb"), bytes("torn.glb"));
}

TEST_F(RobotTear, a_finer_sampling_tears_the_same_length) {
  const auto length = [&](const char* spacing) {
    const CommandResult result = tear(placed({"--spacing", spacing, "--dry-run", "--report", "-"}));
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return json::parse(result.out)["operations"][0]["length_posed"].get<double>();
  };
  EXPECT_NEAR(length("0.004"), length("0.001"), 2e-3 * length("0.001"));
}

TEST_F(RobotTear, an_arm_that_stands_elsewhere_misses) {
  const CommandResult result = tear({"--robot-place", "3,0,0.95,0,90,0", "-o", path("m.glb")});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(result.err, HasSubstr("tear missed"));
}

/// The miss says by which way the blade passed; moved by it and a little more, it tears.
TEST_F(RobotTear, a_miss_says_which_way_to_move_the_robot) {
  for (const Vec3d& place : {Vec3d(0, 0, 1.6), Vec3d(1.5, 0, 0.95), Vec3d(0, 3, 0.95)}) {
    const auto tear_at = [&](const Vec3d& at) {
      std::string text;
      for (int k = 0; k < 3; ++k) text += std::to_string(at[k]) + ",";
      return tear({"--robot-place", text + "0,90,0", "--pose", "Sway@0.2", "--clip-speed", "1",
                   "--dry-run", "--report", "-"});
    };
    const CommandResult missed = tear_at(place);
    EXPECT_EQ(missed.exit_code, 1) << missed.err;
    EXPECT_THAT(missed.err, HasSubstr(" to --robot-place"));
    EXPECT_THAT(missed.err, HasSubstr(" s of the motion"));
    const json miss = json::parse(missed.out)["operations"][0]["miss"];
    Vec3d way;
    for (int k = 0; k < 3; ++k) way[k] = miss["way"][static_cast<std::size_t>(k)];
    EXPECT_NEAR(way.norm(), miss["distance"].get<double>(), 1e-6);
    const CommandResult moved = tear_at(place + way + 0.04 * way.normalized());
    EXPECT_EQ(json::parse(moved.out)["operations"][0]["status"], "torn") << moved.err;
  }
}

TEST_F(RobotTear, lengths_of_the_blade_and_the_place_have_units) {
  const auto length = [&](std::vector<std::string> more) {
    more.insert(more.end(), {"--dry-run", "--report", "-"});
    const CommandResult result = tear(more);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return json::parse(result.out)["operations"][0]["length_posed"].get<double>();
  };
  const double expected = length({"--robot-place", "0,0,0.95,0,90,0", "--spacing", "0.002"});
  EXPECT_EQ(expected, length({"--robot-place", "0,0,95cm,0,90deg,0", "--spacing", "2mm"}));
}

TEST_F(RobotTear, numbers_out_of_range_are_refused_with_the_range) {
  const auto err = [&](const char* option, const char* value) {
    const CommandResult result = tear(placed({option, value, "-o", path("no.glb")}));
    EXPECT_EQ(result.exit_code, 2) << option << value;
    return result.err;
  };
  for (const char* const value : {"nan", "inf", "-1", "0", "1e300", "1e-300"})
    EXPECT_THAT(err("--spacing", value),
                AllOf(HasSubstr("--spacing: spacing is "), HasSubstr("from 1e-09 to 1e+09 m")));
  for (const char* const value : {"nan", "inf", "-1", "1e300"})
    EXPECT_THAT(err("--clip-speed", value), HasSubstr("it must be from 0 to 1e+06"));
  EXPECT_THAT(err("--spacing", "3kg"), HasSubstr("'3kg' is no number; expected one from 1e-09"));
  for (const char* const value : {"nan,0,0", "inf,0,0", "1e300,0,0", "0,0"})
    EXPECT_THAT(tear({"--robot-place", value, "-o", path("no.glb")}).err,
                HasSubstr("expected x,y,z[,roll,pitch,yaw]"));
  EXPECT_FALSE(exists("no.glb"));
}

/// The picture has what the robot adds to that of the model alone, and where the blade goes.
TEST_F(RobotTear, a_picture_shows_the_robot_and_the_way_of_its_blade) {
  const auto picture = [&](const std::string& name, const std::vector<std::string>& more) {
    std::vector<std::string> arguments = {"picture",  model(),  "-o",
                                          path(name), "--size", "160x120"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const CommandResult result = run_sunder(arguments);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return bytes(name);
  };
  const std::vector<std::string> robot = {"--robot", of_docs("arm.urdf"), "--robot-place",
                                          "0,0,0.95,0,90,0"};
  const auto alone = picture("alone.png", {});
  const auto at_rest = picture("rest.png", robot);
  EXPECT_NE(at_rest, alone);
  auto moved = robot;
  moved.insert(moved.end(), {"--trajectory", of_docs("arm.csv")});
  const auto at_end = picture("end.png", moved);
  EXPECT_NE(at_end, at_rest);
  moved.insert(moved.end(), {"--blade", "scalpel", "--edge", "0,0,0,0.16,0,0", "--pose", "rest"});
  EXPECT_NE(picture("way.png", moved), at_end);
  const CommandResult no_motion = run_sunder({"picture", model(), "-o", path("no.png"), "--robot",
                                              of_docs("arm.urdf"), "--blade", "scalpel"});
  EXPECT_EQ(no_motion.exit_code, 2);
  EXPECT_THAT(no_motion.err, HasSubstr("--trajectory (with --robot)"));
}

TEST_F(RobotTear, exceeded_limits_are_warnings) {
  const std::string wild = write("wild.csv", "time,shoulder,elbow\n0,1.2,-1.3\n1,0.9,-3\n");
  const CommandResult result = tear(placed({"--dry-run", "--report", "-"}), wild);
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(result.err, HasSubstr("joint 'elbow' leaves its limits, -2.6 to 2.6: -3 at 1 s"));
  EXPECT_EQ(json::parse(result.out)["robot"]["exceeded_limits"][0]["joint"], "elbow");
  const CommandResult kept = tear(placed({"--dry-run", "--keep-limits"}), wild);
  EXPECT_THAT(kept.err, HasSubstr("it is kept within them"));
}

TEST_F(RobotTear, faults_name_their_place_and_nothing_is_written) {
  const auto err = [&](const std::string& csv) {
    const CommandResult result = tear(placed({"-o", path("no.glb")}), write("bad.csv", csv));
    EXPECT_EQ(result.exit_code, 2) << csv;
    return result.err;
  };
  EXPECT_THAT(err("time,shoulder\n0,x\n"), HasSubstr("line 2, column 2 ('shoulder'): 'x'"));
  EXPECT_THAT(err("time,shulder\n0,1\n1,2\n"), HasSubstr("did you mean 'shoulder'"));
  EXPECT_THAT(err("time,shoulder\n0,1\n0,2\n"), HasSubstr("line 3"));
  EXPECT_THAT(err("time,shoulder\n0,1\n1,1\n"), HasSubstr("the blade moves by less than"));
  const CommandResult link = tear(placed({"-o", path("no.glb")}), of_docs("arm.csv"), "scapel");
  EXPECT_EQ(link.exit_code, 2);
  EXPECT_THAT(link.err, HasSubstr("did you mean 'scalpel'"));
  EXPECT_EQ(tear({"-o", path("no.glb")}, path("none.csv")).exit_code, 3);
  EXPECT_EQ(tear({"-o", path("no.glb"), "--edge", "1,2,3"}).exit_code, 2);
  EXPECT_EQ(tear({"-o", path("no.glb"), "--clip-speed", "1"}).exit_code, 2);
  EXPECT_EQ(
      run_sunder({"tear", model(), "--robot", of_docs("arm.urdf"), "-o", path("no.glb")}).exit_code,
      2);
  EXPECT_EQ(run_sunder({"tear", model(), "--trajectory", of_docs("arm.csv"), "-o", path("no.glb")})
                .exit_code,
            2);
  EXPECT_FALSE(exists("no.glb"));
}

TEST_F(RobotTear, a_surgical_robot_tears_it_too) {
  SUNDER_SKIP_WITHOUT_SHARED_MODELS();
  const auto urdf = test::shared_models() / "urdf";
  const CommandResult result = run_sunder({"tear",
                                           model(),
                                           "--robot",
                                           (urdf / "dvrk_psm/dvrk_psm.urdf").string(),
                                           "--package-root",
                                           urdf.string(),
                                           "--trajectory",
                                           of_docs("dvrk_psm.csv"),
                                           "--blade",
                                           "PSM1_tool_tip_link",
                                           "--edge",
                                           "0,0,-0.12,0,0,0",
                                           "--robot-place",
                                           "0,1.2,0.28,90,0,180",
                                           "--pose",
                                           "Sway@0.4",
                                           "--clip-speed",
                                           "0.3",
                                           "-o",
                                           path("psm.glb"),
                                           "--report",
                                           path("psm.json")});
  ASSERT_LE(result.exit_code, 1) << result.err << result.out;
  EXPECT_EQ(read_json("psm.json")["operations"][0]["status"], "torn") << result.err;
  EXPECT_EQ(read_json("psm.json")["robot"]["exceeded_limits"], json::array());
}

}  // namespace
}  // namespace sunder::command_test
