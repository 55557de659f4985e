// `sunder demo` from the outside.

#include <cstdlib>

#include "tools/command_fixture.h"

namespace sunder::command_test {
namespace {

class DemoCommand : public CactusSuite {};

TEST_F(DemoCommand, demo_without_a_renderer_writes_everything_except_pictures) {
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

TEST_F(DemoCommand, the_model_is_not_overwritten) {
  std::filesystem::create_directory(path("own"));
  std::filesystem::copy_file(model(), path("own/torn.glb"));
  const CommandResult result = run_sunder({"demo", path("own/torn.glb"), "-o", path("own")});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(result.err, HasSubstr("would overwrite MODEL"));
  EXPECT_EQ(bytes("own/torn.glb"), bytes("cactus.glb"));
}

TEST_F(DemoCommand, demo_draws_four_pictures) {
  if (std::system("command -v f3d xvfb-run >/dev/null 2>&1") != 0)
    GTEST_SKIP() << "needs f3d and xvfb-run";
  const CommandResult result = run_sunder({"demo", model(), "-o", path("pictures")});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  for (const char* const name : {"before", "torn", "later_1", "later_2"})
    EXPECT_GT(std::filesystem::file_size(path("pictures/" + std::string(name) + ".png")), 10'000u)
        << name;
}

}  // namespace
}  // namespace sunder::command_test
