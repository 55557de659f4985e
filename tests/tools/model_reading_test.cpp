// The options that say how verbs read their models, and the texts of failed readings.

#include "tools/command_fixture.h"

namespace sunder::command_test {
namespace {

using testing::Not;

constexpr const char* kTriangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";

class ModelReading : public CactusSuite {
 protected:
  static std::string triangle() { return write("triangle.obj", kTriangle); }
  static std::string robot_of_package() {
    std::filesystem::create_directories(path("roots/pack"));
    write("roots/pack/t.obj", kTriangle);
    return write("packed.urdf",
                 "<robot name=\"r\"><link name=\"a\"><visual><geometry><mesh "
                 "filename=\"package://pack/t.obj\"/></geometry></visual></link></robot>");
  }
  static std::string cut() {
    return write("cut.json", R"({"sunder_operations": 1, "operations": [
      {"op": "cut", "plane": {"point": [0, 0.3, 0], "normal": [0, 1, 0]}}]})");
  }
};

TEST_F(ModelReading, every_verb_has_a_time_limit_and_names_its_option) {
  const std::string slow = triangle(), out = path("out.glb");
  for (std::vector<std::string> arguments :
       std::vector<std::vector<std::string>>{{"info", slow},
                                             {"tear", slow, "--ops", cut(), "-o", out},
                                             {"validate", slow, model()},
                                             {"validate", model(), slow},
                                             {"transfer", slow, model(), "-o", out},
                                             {"transfer", model(), slow, "-o", out},
                                             {"picture", slow, "-o", path("out.png")},
                                             {"view", slow, "-o", path("out.html")},
                                             {"bind", slow, "--skeleton", model(), "-o", out},
                                             {"bind", model(), "--skeleton", slow, "-o", out}}) {
    arguments.insert(arguments.end(), {"--import-seconds", "1e-6"});
    const CommandResult result = run_sunder(arguments);
    EXPECT_EQ(result.exit_code, 4) << arguments[0] << ": " << result.err;
    EXPECT_THAT(result.err, HasSubstr("(--import-seconds)")) << arguments[0];
    EXPECT_THAT(result.err, Not(HasSubstr("LoadOptions"))) << arguments[0];
  }
  EXPECT_FALSE(exists("out.glb"));
  EXPECT_EQ(run_sunder({"info", slow, "--import-seconds", "0"}).exit_code, 2);
  EXPECT_EQ(run_sunder({"info", slow, "--import-seconds", "60"}).exit_code, 0);
}

TEST_F(ModelReading, the_limit_of_memory_is_an_option) {
  const CommandResult refused = run_sunder({"info", model(), "--memory", "0.001"});
  EXPECT_EQ(refused.exit_code, 4) << refused.err;
  EXPECT_THAT(refused.err, HasSubstr("(--memory)"));
  EXPECT_EQ(run_sunder({"info", model(), "--memory", "100"}).exit_code, 0);
  EXPECT_EQ(run_sunder({"info", model(), "--memory", "0"}).exit_code, 2);
}

TEST_F(ModelReading, the_time_limit_holds_for_the_meshes_of_a_robot) {
  const CommandResult result = run_sunder(
      {"info", robot_of_package(), "--package-root", path("roots"), "--import-seconds", "1e-6"});
  EXPECT_NE(result.exit_code, 0);
  EXPECT_THAT(result.out + result.err, HasSubstr("--import-seconds"));
  EXPECT_THAT(result.out + result.err, Not(HasSubstr("LoadOptions")));
}

TEST_F(ModelReading, a_torn_robot_has_package_roots) {
  const CommandResult result = run_sunder(
      {"tear", robot_of_package(), "--package-root", path("roots"), "--ops", cut(), "--dry-run"});
  EXPECT_LE(result.exit_code, 1) << result.err;
}

TEST_F(ModelReading, an_error_has_the_name_of_the_file_once) {
  for (const std::string& file :
       {write("bad.ply", "no header"), write("bad.stl", ""), write("bad.unknown", "x"),
        write("bad: colon.iqm", "x"), write("a" + std::string(149, 'n') + ".iqm", "x")}) {
    const std::string name = std::filesystem::path(file).filename().string();
    const CommandResult result = run_sunder({"info", file});
    EXPECT_EQ(result.exit_code, 3) << result.err;
    const std::string start = name.substr(0, 80);
    const std::size_t first = result.err.find(start);
    ASSERT_NE(first, std::string::npos) << result.err;
    EXPECT_EQ(result.err.find(start, first + 1), std::string::npos) << result.err;
  }
}

}  // namespace
}  // namespace sunder::command_test
