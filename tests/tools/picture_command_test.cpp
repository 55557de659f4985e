// `sunder picture` from the outside: framing, sides, and what is drawn on the model.

#include "tools/command_fixture.h"
#include "tools/picture_pixels.h"

namespace sunder::command_test {
namespace {

using test::PixelBox;
using test::Pixels;
using testing::StartsWith;

constexpr Pixels::Color kBackground = {237, 240, 242};
// What the marks of docs/command/picture.md look like.
constexpr Pixels::Color kStroke = {243, 39, 39}, kBase = {39, 193, 63}, kTip = {255, 225, 0};
constexpr Pixels::Color kPlane = {39, 97, 237}, kBore = {173, 39, 204}, kBone = {162, 212, 255};

class PictureErrors : public CactusSuite {};

class PictureCommand : public CactusSuite {
 protected:
  struct Drawn {
    Pixels pixels;
    std::string err;
    int exit_code = -1;
  };
  static Drawn draw(std::vector<std::string> options, const std::string& size = "400x300") {
    const std::string png = path("drawn.png");
    std::filesystem::remove(png);
    options.insert(options.begin(), {"picture", model(), "-o", png, "--size", size});
    const CommandResult result = run_sunder(options);
    EXPECT_LE(result.exit_code, 1) << result.err;
    EXPECT_THAT(result.out, IsEmpty());
    std::optional<Pixels> pixels = test::read_png(png);
    EXPECT_TRUE(pixels.has_value());
    return {pixels ? std::move(*pixels) : Pixels(), result.err, result.exit_code};
  }
  static std::optional<PixelBox> box_of_model(const Pixels& pixels) {
    return box_of(pixels,
                  [](const Pixels::Color& color) { return !test::is_near(color, kBackground, 6); });
  }
  static std::optional<PixelBox> box_of_color(const Pixels& pixels, const Pixels::Color& wanted) {
    return box_of(pixels,
                  [&](const Pixels::Color& color) { return test::is_near(color, wanted, 12); });
  }
};

TEST_F(PictureCommand, the_model_fills_the_frame_from_every_side) {
  for (const char* const side : {"front", "left", "top", "1,0.5,-0.3"})
    for (const char* const size : {"400x300", "200x350"}) {
      const Drawn drawn = draw({"--from", side}, size);
      EXPECT_EQ(drawn.exit_code, 0);
      EXPECT_THAT(drawn.err, StartsWith("sunder: wrote "));
      const auto box = box_of_model(drawn.pixels);
      ASSERT_TRUE(box) << side;
      const double across = static_cast<double>(box->width()) / drawn.pixels.width;
      const double upright = static_cast<double>(box->height()) / drawn.pixels.height;
      EXPECT_GE(std::max(across, upright), 0.85) << side << " " << size;
      EXPECT_LE(std::max(across, upright), 0.95) << side << " " << size;
      // And it is in the middle.
      EXPECT_NEAR((box->left + box->right) / 2.0, drawn.pixels.width / 2.0, 4) << side;
      EXPECT_NEAR((box->top + box->bottom) / 2.0, drawn.pixels.height / 2.0, 4) << side;
    }
}

TEST_F(PictureCommand, sizes_are_obeyed) {
  const Drawn drawn = draw({}, "123x77");
  EXPECT_EQ(drawn.pixels.width, 123);
  EXPECT_EQ(drawn.pixels.height, 77);
  ASSERT_EQ(run_sunder({"picture", model(), "-o", path("default.png")}).exit_code, 0);
  const auto by_default = test::read_png(path("default.png"));
  ASSERT_TRUE(by_default);
  EXPECT_EQ(by_default->width, 1280);
  EXPECT_EQ(by_default->height, 960);
}

TEST_F(PictureCommand, sides_and_poses_differ) {
  const Pixels front = draw({}).pixels;
  EXPECT_EQ(front.colors, draw({"--from", "front", "--pose", "rest"}).pixels.colors);
  EXPECT_NE(front.colors, draw({"--from", "left"}).pixels.colors);
  EXPECT_NE(front.colors, draw({"--from", "back"}).pixels.colors);
  EXPECT_NE(front.colors, draw({"--pose", "Sway@0.8"}).pixels.colors);
}

/// Where a place of the cactus at rest is, from the front: its box is 0.9 m wide and 1.7 m high.
TEST_F(PictureCommand, a_stroke_is_drawn_where_it_is) {
  const std::string ops = write("stroke.json", R"({"sunder_operations": 1, "operations": [
    {"op": "tear", "stroke": [{"base": [-0.1, 1.15, 0.3], "tip": [-0.1, 1.15, 0]},
      {"base": [0.1, 1.15, 0.3], "tip": [0.1, 1.15, 0]}]}]})");
  const Pixels without = draw({}).pixels;
  const auto model_box = box_of_model(without);
  EXPECT_FALSE(box_of_color(without, kStroke));
  const json bounds = json::parse(run_sunder({"info", model(), "--json"}).out)["bounds"];
  const auto expected = [&](double x, double y) {
    const double scale =
        model_box->height() / (bounds["max"][1].get<double>() - bounds["min"][1].get<double>());
    return Vec2d(model_box->left + scale * (x - bounds["min"][0].get<double>()),
                 model_box->bottom - scale * (y - bounds["min"][1].get<double>()));
  };
  const Drawn drawn = draw({"--ops", ops});
  EXPECT_THAT(drawn.err, HasSubstr("drawn in the pose of operation 0"));
  EXPECT_EQ(drawn.exit_code, 0);
  const Vec2d left = expected(-0.1, 1.15), right = expected(0.1, 1.15);
  for (const Pixels::Color& color : {kBase, kTip}) {
    const auto ends = box_of_color(drawn.pixels, color);
    ASSERT_TRUE(ends);
    EXPECT_NEAR(ends->left, left.x() - 5, 7);
    EXPECT_NEAR(ends->right, right.x() + 5, 7);
    EXPECT_NEAR((ends->top + ends->bottom) / 2.0, left.y(), 7);
  }
  const auto line = box_of_color(drawn.pixels, kStroke);
  ASSERT_TRUE(line);
  EXPECT_GT(line->left, left.x() - 8);
  EXPECT_LT(line->right, right.x() + 8);
  EXPECT_NEAR((line->top + line->bottom) / 2.0, left.y(), 7);

  // It is visible through the model, too.
  EXPECT_TRUE(box_of_color(draw({"--ops", ops, "--from", "back"}).pixels, kStroke));
}

TEST_F(PictureCommand, planes_and_bores_are_drawn) {
  const std::string ops = write("all.json", R"({"sunder_operations": 1, "operations": [
    {"op": "cut", "plane": {"point": [0, 0.5, 0], "normal": [0, 1, 0]}},
    {"op": "cut", "plane": {"point": [0, 1.2, 0], "normal": [0, 1, 0]},
     "bounds": [[-0.3, 1.2, -0.2], [0.3, 1.2, -0.2], [0, 1.2, 0.3]]},
    {"op": "drill", "axis": {"origin": [0, 0.9, 0.4], "direction": [0, 0, -1]}, "radius": 0.08, "depth": 0.5}]})");
  const Drawn drawn = draw({"--ops", ops, "--from", "1,1,1"});
  EXPECT_EQ(drawn.exit_code, 0);
  EXPECT_TRUE(box_of_color(drawn.pixels, kPlane));
  EXPECT_TRUE(box_of_color(drawn.pixels, kBore));
  EXPECT_FALSE(box_of_color(drawn.pixels, kStroke));
}

TEST_F(PictureCommand, undone_operations_are_not_drawn_and_absent_ones_are_named) {
  const std::string ops = write("undone.json", R"({"sunder_operations": 1, "operations": [
    {"op": "drill", "axis": {"origin": [0, 0.9, 0.4], "direction": [0, 0, -1]}, "radius": 0.08, "depth": 0.5},
    {"op": "undo"},
    {"op": "drill", "axis": {"origin": [9, 9, 9], "direction": [0, 0, -1]}, "radius": 0.08, "depth": 0.5},
    {"op": "cut", "plane": {"point": [0, 9, 0], "normal": [0, 1, 0]}, "pose": {"clip": "Sway", "time": 0.5}}]})");
  const Drawn drawn = draw({"--ops", ops, "--pose", "rest"});
  EXPECT_EQ(drawn.exit_code, 1);
  EXPECT_FALSE(box_of_color(drawn.pixels, kBore));
  EXPECT_THAT(drawn.err, HasSubstr("operation 2 is outside the picture"));
  EXPECT_THAT(drawn.err, HasSubstr("operation 3 is not drawn: its plane does not meet the model"));
  EXPECT_THAT(drawn.err, HasSubstr("operation 3 is made in another pose"));
  EXPECT_THAT(drawn.err, testing::Not(HasSubstr("operation 0")));
}

TEST_F(PictureCommand, bones_axes_and_grid_are_drawn_and_a_limb_fills_the_frame) {
  const Drawn bones = draw({"--bones"});
  EXPECT_TRUE(box_of_color(bones.pixels, kBone));
  const Drawn grid = draw({"--grid", "--axes"});
  EXPECT_THAT(grid.err, HasSubstr("grid: one line per 0.1 m"));
  // The axes' letters are in the lower left corner, where there is nothing otherwise.
  const auto is_red = [](const Pixels::Color& c) { return c[0] > 180 && c[1] < 80 && c[2] < 80; };
  const auto axes = box_of(draw({"--axes"}).pixels, is_red);
  ASSERT_TRUE(axes);
  EXPECT_LT(axes->right, 200);
  EXPECT_GT(axes->top, 150);
  // The arm is a part of the model that is drawn larger: the trunk runs out of the frame.
  const auto whole = box_of_model(draw({}).pixels),
             arm = box_of_model(draw({"--bone", "Left2"}).pixels);
  ASSERT_TRUE(whole && arm);
  EXPECT_GT(arm->count, whole->count);
  EXPECT_EQ(arm->right, 399);
}

TEST_F(PictureErrors, wrong_options_are_explained) {
  struct Case {
    std::vector<std::string> options;
    const char* words;
  };
  const std::vector<Case> cases = {
      {{"--from", "above"}, "front, back, left, right, top, bottom"},
      {{"--from", "0,0,0"}, "--from"},
      {{"--from", "1,2"}, "--from"},
      {{"--size", "400"}, "WIDTHxHEIGHT"},
      {{"--size", "400x4"}, "16 to 8192"},
      {{"--size", "400x300x2"}, "WIDTHxHEIGHT"},
      {{"--pose", "Walk@1"}, "'Sway'"},
      {{"--ops", write("bad.json", "{}")}, "bad.json"},
      {{"--ops", write("undo.json", R"({"sunder_operations": 1, "operations": [{"op": "undo"}]})")},
       "/operations/0"},
      {{"--ops", write("clip.json", R"({"sunder_operations": 1, "operations": [
         {"op": "cut", "pose": {"clip": "Walk", "time": 0}, "plane": {"point": [0, 1, 0], "normal": [0, 1, 0]}}]})")},
       "Walk"}};
  for (const Case& wrong : cases) {
    std::vector<std::string> arguments = {"picture", model(), "-o", path("wrong.png")};
    arguments.insert(arguments.end(), wrong.options.begin(), wrong.options.end());
    const CommandResult result = run_sunder(arguments);
    EXPECT_EQ(result.exit_code, 2) << wrong.options[0] << " " << wrong.options[1] << result.err;
    EXPECT_THAT(result.err, HasSubstr(wrong.words));
    EXPECT_FALSE(exists("wrong.png"));
  }
}

/// `picture`, `view` and `validate` read aimed operations as `tear` does.
TEST_F(PictureErrors, names_of_aimed_operations_come_with_the_nearest_ones) {
  const auto message = [](const char* bone, const char* clip) {
    const json operation = {
        {"op", "sever"}, {"bone", bone}, {"pose", {{"clip", clip}, {"time", 0}}}};
    const json log = {{"sunder_operations", 1}, {"operations", {operation}}};
    const CommandResult result = run_sunder(
        {"picture", model(), "-o", path("aimed.png"), "--ops", write("names.json", log.dump())});
    EXPECT_EQ(result.exit_code, 2);
    return result.err;
  };
  EXPECT_THAT(message("Trunk3", "Swai"), HasSubstr("did you mean 'Sway'?"));
  EXPECT_THAT(message("Qqqq", "Sway"), HasSubstr("`sunder info MODEL --bones` lists the bones"));
}

TEST_F(PictureErrors, an_input_is_not_overwritten) {
  const std::vector<std::byte> before = bytes("cactus.glb");
  const CommandResult result = run_sunder({"picture", model(), "-o", model()});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(result.err, HasSubstr("--output"));
  EXPECT_EQ(bytes("cactus.glb"), before);
}

TEST_F(PictureCommand, no_other_program_is_needed_or_run) {
  const CommandResult result =
      run_sunder({"picture", model(), "-o", path("alone.png"), "--size", "80x60"},
                 {{"PATH", "/nonexistent"}, {"DISPLAY", ""}});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  const auto pixels = test::read_png(path("alone.png"));
  ASSERT_TRUE(pixels);
  EXPECT_TRUE(box_of_model(*pixels));
}

/// The file is named with its size.
TEST_F(PictureCommand, what_is_written_is_said) {
  const CommandResult result =
      run_sunder({"picture", model(), "-o", path("said.png"), "--size", "80x60"});
  EXPECT_THAT(result.err, StartsWith("sunder: wrote " + path("said.png") + ", "));
  EXPECT_THAT(result.err, testing::AnyOf(HasSubstr(" kB\n"), HasSubstr(" bytes\n")));
}

TEST_F(PictureCommand, wrong_names_and_folders_are_explained) {
  const CommandResult bone =
      run_sunder({"picture", model(), "-o", path("no.png"), "--bone", "left2"});
  EXPECT_EQ(bone.exit_code, 2);
  EXPECT_THAT(bone.err, HasSubstr("did you mean 'Left2'"));
  const CommandResult folder =
      run_sunder({"picture", model(), "-o", path("no such folder/no.png")});
  EXPECT_EQ(folder.exit_code, 3);
  EXPECT_FALSE(exists("no.png"));
}

}  // namespace
}  // namespace sunder::command_test
