// `sunder tear --wound-mask` from the outside.

#include <algorithm>

#include "tools/command_fixture.h"
#include "tools/picture_pixels.h"

namespace sunder::command_test {
namespace {

using testing::HasSubstr;

class WoundMaskCommand : public CactusSuite {
 protected:
  static CommandResult tear(const std::string& name, std::vector<std::string> more) {
    std::vector<std::string> arguments = {
        "tear", model(), "--ops", write("ops.json", kStroke), "-o", path(name + ".glb")};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run_sunder(arguments);
  }

  static constexpr const char* kStroke = R"({"sunder_operations": 1,
    "operations": [{"op": "drill", "axis": {"origin": [0, 0.9, 2], "direction": [0, 0, -1]},
                    "radius": 0.05, "depth": 4}]})";
};

TEST_F(WoundMaskCommand, paints_lips_red_and_holes_green) {
  const CommandResult result = tear("torn", {"--wound-mask", path("wound.png"), "--wound-mask-size",
                                             "256", "--wound-mask-reach", "0.05"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.err, HasSubstr("wrote " + path("wound.png")));
  const auto pixels = test::read_png(path("wound.png"));
  ASSERT_TRUE(pixels);
  EXPECT_EQ(pixels->width, 256);
  EXPECT_EQ(pixels->height, 256);
  const auto count_of = [&](auto counts) {
    const auto box = test::box_of(*pixels, counts);
    return box ? box->count : 0;
  };
  using Color = test::Pixels::Color;
  const int used = count_of([](const Color&c) { return c[2] == 255; }),
            near_lips = count_of([](const Color&c) { return c[0] > 0; }),
            removed = count_of([](const Color&c) { return c[1] == 255; });
  EXPECT_GT(removed, 0);
  EXPECT_GT(near_lips, removed);
  EXPECT_GT(used, 2 * near_lips);
  EXPECT_EQ(count_of([](const Color& c) { return c[1] == 255 && c[0] != 255; }), 0)
      << "what was removed is red too";
}

/// The greatest level of a grey picture, and how many pixels are not black.
struct Levels {
  int greatest = 0, count = 0;
};

Levels levels_of(const std::filesystem::path& file) {
  const auto pixels = test::read_png(file);
  Levels levels;
  EXPECT_TRUE(pixels) << file;
  for (const auto& color : pixels ? pixels->colors : std::vector<test::Pixels::Color>()) {
    EXPECT_TRUE(color[0] == color[1] && color[1] == color[2]);
    levels.greatest = std::max<int>(levels.greatest, color[0]);
    if (color[0] > 0) ++levels.count;
  }
  return levels;
}

TEST_F(WoundMaskCommand, channels_are_pictures_in_grey_beside_it) {
  // An older wound without a wall, and a newer one with a wall of 2 cm, at a bent elbow.
  const std::string log = write("two.json", R"({"sunder_operations": 1, "operations": [
    {"op": "drill", "axis": {"origin": [0, 0.9, 2], "direction": [0, 0, -1]}, "radius": 0.05, "depth": 4},
    {"op": "tear", "pose": {"clip": "Sway", "time": 0.8}, "wall_depth": 0.02,
     "stroke": [{"base": [-0.1, 1.15, 2], "tip": [-0.1, 1.15, 0]}, {"base": [-0.12, 1.3, 2], "tip": [-0.12, 1.3, 0]}]}]})");
  const CommandResult result = run_sunder(
      {"tear", model(), "--ops", log, "-o", path("torn.glb"), "--wound-mask", path("many.png"),
       "--wound-mask-size", "256", "--wound-mask-reach", "0.03", "--wound-mask-channels",
       "blood,age,depth,stretch", "--report", path("report.json")});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  const auto mask = test::read_png(path("many.png"));
  const auto age = test::read_png(path("many.age.png"));
  ASSERT_TRUE(mask && age);
  int newest = 0, older = 0;
  for (std::size_t i = 0; i < age->colors.size(); ++i) {
    const int level = age->colors[i][0];
    ASSERT_TRUE(level == 0 || level == 254 || level == 255) << level;
    const bool is_near = mask->colors[i][0] > 1 && mask->colors[i][1] == 0;
    ASSERT_LE(is_near, level > 0) << "a lip within reach has an age";
    (level == 255 ? newest : older) += level > 0 ? 1 : 0;
  }
  EXPECT_GT(newest, 50);
  EXPECT_GT(older, 50);
  const Levels depth = levels_of(path("many.depth.png"));
  EXPECT_EQ(depth.greatest, 255);
  EXPECT_LE(depth.count, newest) << "the bore has no wall";
  EXPECT_GT(levels_of(path("many.stretch.png")).count, 50);
  EXPECT_GT(levels_of(path("many.blood.png")).greatest, 100);
  const json wounds = read_json("report.json").at("wound_mask");
  EXPECT_EQ(wounds.at("file"), path("many.png"));
  ASSERT_EQ(wounds.at("channels").size(), 4U);
  const json of_age = wounds.at("channels")[0], of_depth = wounds.at("channels")[1];
  EXPECT_EQ(of_age.at("at_0"), 255);
  EXPECT_EQ(of_age.at("at_255"), 0);
  EXPECT_EQ(of_depth.at("file"), path("many.depth.png"));
  EXPECT_GT(of_depth.at("at_255").get<double>(), 0.01);
  EXPECT_LT(of_depth.at("at_255").get<double>(), 0.04) << "along the wall's edges";
  EXPECT_THAT(result.err, HasSubstr("bytes; the level 255 is"));
}

TEST_F(WoundMaskCommand, channels_do_not_overwrite_the_source_and_are_named) {
  const CommandResult unknown =
      tear("no", {"--wound-mask", path("no.png"), "--wound-mask-channels", "age,colour"});
  EXPECT_EQ(unknown.exit_code, 2);
  EXPECT_THAT(unknown.err, HasSubstr("colour"));
  EXPECT_EQ(tear("no", {"--wound-mask-channels", "age"}).exit_code, 2) << "it needs --wound-mask";
  const CommandResult twice = tear("no", {"--wound-mask", path("no.png"), "--wound-mask-channels",
                                          "age", "--picture", path("no.age.png")});
  EXPECT_EQ(twice.exit_code, 2);
  EXPECT_THAT(twice.err, HasSubstr("--wound-mask-channels"));
}

/// Threads of sutures are dark and grey, as neither skin nor blood is; broken ones are not drawn.
TEST_F(WoundMaskCommand, pictures_show_threads_that_hold) {
  const std::string log = write("one.json", kOneTear);
  const auto grey_in = [&](const std::string& name, std::vector<std::string> more) {
    std::vector<std::string> arguments = {"tear", model(),          "--ops",     log,
                                          "-o",   path("torn.glb"), "--picture", path(name)};
    arguments.insert(arguments.end(), more.begin(), more.end());
    EXPECT_EQ(run_sunder(arguments).exit_code, 0);
    const auto pixels = test::read_png(path(name));
    if (!pixels) return -1;
    int count = 0;
    for (const test::Pixels::Color& color : pixels->colors)
      if (const auto [least, most] = std::ranges::minmax(color); most < 60 && most < least + 10)
        ++count;
    return count;
  };
  EXPECT_EQ(grey_in("open.png", {}), 0);
  EXPECT_GT(grey_in("sewn.png", {"--suture", "all,spacing=0.04"}), 500);
  EXPECT_EQ(grey_in("broken.png", {"--suture", "all,spacing=0.04,strength=1e-9"}), 0);
}

/// A wound that threads hold shut keeps its blood.
TEST_F(WoundMaskCommand, pictures_show_blood_at_sewn_wounds) {
  const std::string log = write("long.json", R"({"sunder_operations": 1, "operations": [
    {"op": "tear", "pose": {"clip": 0, "time": 0.8}, "stroke": [
      {"base": [0.03, 1.03, 0.48], "tip": [-0.1, 0.98, 0.06]},
      {"base": [-0.07, 1.35, 0.47], "tip": [-0.19, 1.3, 0.04]},
      {"base": [-0.16, 1.67, 0.46], "tip": [-0.29, 1.62, 0.03]}]}]})");
  ASSERT_EQ(run_sunder({"tear", model(), "--ops", log, "-o", path("torn.glb"), "--picture",
                        path("sewn.png"), "--suture", "all,spacing=0.03"})
                .exit_code,
            0);
  const auto pixels = test::read_png(path("sewn.png"));
  ASSERT_TRUE(pixels);
  const auto is_blood = [](const test::Pixels::Color& color) {
    return color[0] > 60 && color[0] < 200 && color[1] < color[0] / 2 && color[2] < color[0] / 2;
  };
  EXPECT_GT(std::ranges::count_if(pixels->colors, is_blood), 2000);
}

TEST_F(WoundMaskCommand, options_out_of_range_are_refused) {
  for (const char* const size : {"0", "16385"})
    EXPECT_EQ(tear("no", {"--wound-mask", path("no.png"), "--wound-mask-size", size}).exit_code, 2);
  EXPECT_EQ(tear("no", {"--wound-mask", path("no.png"), "--wound-mask-reach", "0"}).exit_code, 2);
  EXPECT_EQ(tear("no", {"--wound-mask-size", "64"}).exit_code, 2) << "it needs --wound-mask";
  EXPECT_FALSE(exists("no.png"));
}

}  // namespace
}  // namespace sunder::command_test
