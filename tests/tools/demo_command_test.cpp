// `sunder demo` from the outside.

#include <tuple>

#include "tools/command_fixture.h"
#include "tools/picture_pixels.h"

namespace sunder::command_test {
namespace {

class DemoCommand : public CactusSuite {};

TEST_F(DemoCommand, demo_writes_everything_but_pictures_if_none_are_wanted) {
  const CommandResult result = run_sunder({"demo", "-o", path("demo"), "--no-pictures"});
  EXPECT_EQ(result.exit_code, 0);
  for (const char* const name : {"cactus.glb", "torn.glb", "report.json", "ops.json"})
    EXPECT_THAT(result.err, HasSubstr("wrote " + path("demo/" + std::string(name)) + ", "));
  EXPECT_THAT(result.err, testing::Not(HasSubstr(".png")));
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

/// The trunk is by far the larger surface; the demo tears it only if the pot is no better.
TEST_F(DemoCommand, demo_tears_skin_and_no_cloth) {
  for (const auto& [of_trunk, of_pot, wanted] :
       {std::tuple{"Coat", "Skin", "Skin"}, std::tuple{"Coat", "Other", "Other"},
        std::tuple{"Coat", "Hat", "Coat"}, std::tuple{"Other", "Hat", "Other"}}) {
    Character character = tools::make_cactus();
    character.meshes[0].name = of_trunk;
    character.meshes[1].name = of_pot;
    for (Mesh& mesh : character.meshes)
      for (Submesh& submesh : mesh.submeshes) submesh.name = mesh.name;
    ASSERT_TRUE(save_glb(path("dressed.glb"), character));
    const std::string folder = path("dressed");
    ASSERT_EQ(run_sunder({"demo", path("dressed.glb"), "-o", folder, "--no-pictures"}).exit_code,
              0);
    const auto torn = load_character(folder + "/torn.glb"),
               whole = load_character(path("dressed.glb"));
    ASSERT_TRUE(torn && whole);
    for (Index m = 0; m < 2; ++m) {
      const Mesh &after = torn->character->meshes[m], &before = whole->character->meshes[m];
      EXPECT_EQ(after.triangle_count() > before.triangle_count(), after.name == wanted)
          << after.name << " of " << of_trunk << " and " << of_pot;
    }
  }
}

TEST_F(DemoCommand, the_model_is_not_overwritten) {
  std::filesystem::create_directory(path("own"));
  std::filesystem::copy_file(model(), path("own/torn.glb"));
  const CommandResult result = run_sunder({"demo", path("own/torn.glb"), "-o", path("own")});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(result.err, HasSubstr("would overwrite MODEL"));
  EXPECT_EQ(bytes("own/torn.glb"), bytes("cactus.glb"));
}

TEST_F(DemoCommand, demo_draws_its_pictures_without_any_other_program) {
  const CommandResult result =
      run_sunder({"demo", model(), "-o", path("pictures")}, {{"PATH", "/nonexistent"}});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  for (const char* const name : {"motion", "before", "torn", "wound", "later_1", "later_2"})
    EXPECT_GT(std::filesystem::file_size(path("pictures/" + std::string(name) + ".png")), 10'000u)
        << name;
  const auto before = test::read_png(path("pictures/before.png")),
             torn = test::read_png(path("pictures/torn.png"));
  ASSERT_TRUE(before && torn);
  EXPECT_EQ(torn->width, 1280);
  EXPECT_EQ(torn->height, 960);
  // Flesh is dark red; nothing before the tear is.
  const auto is_flesh = [](const test::Pixels::Color& color) {
    return color[0] > 60 && color[0] < 200 && color[1] < color[0] / 3 && color[2] < color[0] / 3;
  };
  const auto flesh = test::box_of(*torn, is_flesh);
  const auto none = test::box_of(*before, is_flesh);
  ASSERT_TRUE(flesh);
  EXPECT_GT(flesh->count, 2000 + (none ? 2 * none->count : 0));
}

}  // namespace
}  // namespace sunder::command_test
