// `sunder tear --robot` from the outside: the arm of docs/pictures/robot tears the cactus.

#include <sunder/robot/trajectory.h>

#include "support/models/shared_models.h"
#include "tools/command_fixture.h"

namespace sunder::command_test {
namespace {

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
