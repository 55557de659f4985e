// Materials in pictures: a row of squares, each with a material of another kind.

#include "tools/command_fixture.h"
#include "tools/picture_pixels.h"
#include "tools/textured_squares.h"

namespace sunder::command_test {
namespace {

using test::GltfBuilder;
using test::Pixels;
using testing::StartsWith;

constexpr Texel kGreen = {0, 200, 0, 255}, kClear = {0, 0, 200, 0};

class PictureMaterials : public CommandSuite {};

OrderedJson plain(const std::array<double, 4>& color) {
  return {{"pbrMetallicRoughness", {{"baseColorFactor", color}, {"metallicFactor", 1.0}}}};
}

TEST_F(PictureMaterials, colors_textures_vertex_colors_and_alpha_are_drawn) {
  GltfBuilder builder;
  builder.json["scene"] = 0;
  builder.json["extensionsUsed"] = OrderedJson::array({"KHR_materials_unlit"});
  const std::size_t green = add_texture(builder, kGreen), clear = add_texture(builder, kClear);
  add_square(builder, 0, 0, plain({1, 0, 0, 1}));
  add_square(builder, 1, 0, textured(green));
  add_square(builder, 2, 0, plain({1, 1, 1, 1}), {0, 0, 1, 1});
  OrderedJson unlit = textured(green);
  unlit["extensions"]["KHR_materials_unlit"] = OrderedJson::object();
  add_square(builder, 3, 0, unlit);
  add_square(builder, 4, 0, plain({1, 0, 0, 1}));
  OrderedJson blended = plain({0, 0, 1, 0.5});
  blended["alphaMode"] = "BLEND";
  add_square(builder, 4, 0.1f, blended);
  add_square(builder, 5, 0, plain({1, 0, 0, 1}));
  OrderedJson masked = textured(clear);
  masked["alphaMode"] = "MASK";
  add_square(builder, 5, 0.1f, masked);
  const std::vector<std::byte> glb = builder.glb();
  write("squares.glb", {reinterpret_cast<const char*>(glb.data()), glb.size()});

  const CommandResult result =
      run_sunder({"picture", path("squares.glb"), "-o", path("squares.png"), "--size", "600x200"});
  ASSERT_LE(result.exit_code, 1) << result.err;
  EXPECT_THAT(result.err, StartsWith("sunder: wrote " + path("squares.png") + ", "));
  const auto pixels = test::read_png(path("squares.png"));
  ASSERT_TRUE(pixels);
  const auto square = [&](double i) {
    return pixels->at(static_cast<int>(30 + (i + 0.5) * 90), 100);
  };
  const auto expect = [&](int i, std::array<int, 3> least, std::array<int, 3> most) {
    const Pixels::Color color = square(i);
    for (std::size_t c = 0; c < 3; ++c) {
      EXPECT_GE(color[c], least[c]) << "square " << i << ", channel " << c;
      EXPECT_LE(color[c], most[c]) << "square " << i << ", channel " << c;
    }
  };
  expect(0, {200, 0, 0}, {255, 90, 90});
  expect(1, {0, 150, 0}, {90, 230, 90});
  expect(2, {0, 0, 200}, {90, 90, 255});
  expect(3, {0, 190, 0}, {45, 210, 45});  // Unlit: the colour of the texture.
  expect(4, {80, 0, 80}, {230, 90, 230});
  expect(5, {200, 0, 0}, {255, 90, 90});  // The clear square before it is cut away.
}

TEST_F(PictureMaterials, a_texture_transform_moves_and_turns_the_image) {
  GltfBuilder builder;
  builder.json["scene"] = 0;
  builder.json["extensionsUsed"] =
      OrderedJson::array({"KHR_texture_transform", "KHR_materials_unlit"});
  constexpr Texel kRed = {200, 0, 0, 255}, kBlue = {0, 0, 200, 255}, kGrey = {90, 90, 90, 255};
  const std::size_t texture = add_texture(builder, {kRed, kGreen, kBlue, kGrey});
  OrderedJson moved = textured(texture);
  moved["extensions"]["KHR_materials_unlit"] = OrderedJson::object();
  OrderedJson& reference = moved["pbrMetallicRoughness"]["baseColorTexture"];
  reference["extensions"]["KHR_texture_transform"] = {{"offset", {0.75, 0.25}}, {"scale", {0, 0}}};
  add_square(builder, 0, 0, moved);
  // A quarter turn: (u, v) -> (v, -u), which repeats.
  reference["extensions"]["KHR_texture_transform"] = {{"rotation", 1.5707963267948966}};
  add_square(builder, 1, 0, moved);
  const std::vector<std::byte> glb = builder.glb();
  write("moved.glb", {reinterpret_cast<const char*>(glb.data()), glb.size()});
  ASSERT_EQ(run_sunder({"picture", path("moved.glb"), "-o", path("moved.png"), "--size", "200x100"})
                .exit_code,
            0);
  const auto pixels = test::read_png(path("moved.png"));
  ASSERT_TRUE(pixels);
  EXPECT_TRUE(test::is_near(pixels->at(30, 50), {0, 200, 0}, 8)) << "all of the upper right texel";
  // The square's lower left corner has (0, 1) -> (1, 0): between texels; a quarter inside of it is
  // (0.25, 0.75) -> (0.75, -0.25): the lower right one.
  // A pixel beside the middle of a texel has a hundredth of its neighbour's light, which is 12 of
  // 255 where that is dark.
  EXPECT_TRUE(test::is_near(pixels->at(122, 72), {90, 90, 90}, 20));
  EXPECT_TRUE(test::is_near(pixels->at(167, 72), {0, 200, 0}, 20));
}

TEST_F(PictureMaterials, other_formats_keep_their_textures) {
  const std::vector<std::byte> png = test::make_png(2, 2, {kGreen, kGreen, kGreen, kGreen});
  write("green.png", {reinterpret_cast<const char*>(png.data()), png.size()});
  write("square.mtl", "newmtl Paint\nKd 1 1 1\nmap_Kd green.png\n");
  write("square.obj",
        "mtllib square.mtl\nusemtl Paint\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n"
        "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nf 1/1 2/2 3/3\nf 1/1 3/3 4/4\n");
  const CommandResult result =
      run_sunder({"picture", path("square.obj"), "-o", path("square.png"), "--size", "100x100"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const auto pixels = test::read_png(path("square.png"));
  ASSERT_TRUE(pixels);
  EXPECT_GT(pixels->at(50, 50)[1], 150);
  EXPECT_LT(pixels->at(50, 50)[0], 90);
}

TEST_F(PictureMaterials, a_missing_texture_is_said) {
  GltfBuilder builder;
  builder.json["scene"] = 0;
  builder.json["images"] = OrderedJson::array({{{"uri", "no such file.png"}}});
  builder.json["textures"] = OrderedJson::array({{{"source", 0}}});
  add_square(builder, 0, 0, textured(0));
  const std::vector<std::byte> glb = builder.glb();
  write("missing.glb", {reinterpret_cast<const char*>(glb.data()), glb.size()});
  const CommandResult result =
      run_sunder({"picture", path("missing.glb"), "-o", path("missing.png"), "--size", "100x100"});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(result.err, HasSubstr("1 materials are drawn without a texture"));
  EXPECT_TRUE(exists("missing.png"));
}

}  // namespace
}  // namespace sunder::command_test
