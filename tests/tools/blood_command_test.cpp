// `sunder tear --blood` from the outside.

#include <sunder/io/character_file.h>

#include <algorithm>
#include <optional>

#include "support/machine/gltf_validator.h"
#include "support/models/gltf_builder.h"
#include "tools/command_fixture.h"
#include "tools/picture_pixels.h"
#include "tools/textured_squares.h"

namespace sunder::command_test {
namespace {

using test::Pixels;

/// The JSON of a GLB and its binary chunk.
struct Glb {
  json document;
  std::vector<std::byte> binary;

  explicit Glb(const std::vector<std::byte>& file) {
    const auto length_at = [&](std::size_t at) {
      std::uint32_t length = 0;
      for (std::size_t i = 4; i-- > 0;)
        length = length << 8 | std::to_integer<std::uint32_t>(file.at(at + i));
      return std::size_t{length};
    };
    const std::size_t json_length = length_at(12);
    document = json::parse(reinterpret_cast<const char*>(file.data()) + 20,
                           reinterpret_cast<const char*>(file.data()) + 20 + json_length);
    if (file.size() > 28 + json_length)
      binary.assign(file.begin() + static_cast<std::ptrdiff_t>(28 + json_length), file.end());
  }

  /// The image of a material's base colour.
  [[nodiscard]] std::vector<std::byte> base_image(const json& material) const {
    const json& surface = material.at("pbrMetallicRoughness");
    const json& texture =
        document.at("textures").at(surface.at("baseColorTexture").at("index").get<std::size_t>());
    const json& image = document.at("images").at(texture.at("source").get<std::size_t>());
    const json& view = document.at("bufferViews").at(image.at("bufferView").get<std::size_t>());
    const auto begin = binary.begin() + view.value("byteOffset", 0);
    return {begin, begin + view.at("byteLength").get<int>()};
  }
  [[nodiscard]] const json& material_of(std::size_t mesh, std::size_t primitive = 0) const {
    const json& of = document.at("meshes").at(mesh).at("primitives").at(primitive);
    return document.at("materials").at(of.at("material").get<std::size_t>());
  }
};

class BloodCommand : public CactusSuite {
 protected:
  static CommandResult tear(const std::string& from, const std::string& log,
                            const std::string& name, std::vector<std::string> more) {
    std::vector<std::string> arguments = {"tear",     from,
                                          "--ops",    write(name + "_ops.json", log),
                                          "-o",       path(name + ".glb"),
                                          "--report", path(name + ".json")};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run_sunder(arguments);
  }
  static void save(const test::GltfBuilder& builder, const std::string& name) {
    const std::vector<std::byte> bytes = builder.glb();
    std::ofstream(path(name), std::ios::binary)
        .write(reinterpret_cast<const char*>(bytes.data()),
               static_cast<std::streamsize>(bytes.size()));
  }
  static Pixels image_of(const Glb& glb, const json& material) {
    const std::vector<std::byte> bytes = glb.base_image(material);
    std::ofstream(path("image.png"), std::ios::binary)
        .write(reinterpret_cast<const char*>(bytes.data()),
               static_cast<std::streamsize>(bytes.size()));
    const std::optional<Pixels> pixels = test::read_png(path("image.png"));
    EXPECT_TRUE(pixels);
    return pixels.value_or(Pixels());
  }
  static bool is_bloody(const Pixels::Color& color) {
    return 2 * color[0] > 3 * color[1] && 2 * color[0] > 3 * color[2];
  }
  /// A line across the square that begins at (x, 0, 0).
  static std::string across(double x) {
    const auto at = [&](double of, double z) {
      return "[" + std::to_string(x + of) + ", 0.5, " + std::to_string(z) + "]";
    };
    return R"({"sunder_operations": 1, "operations": [{"op": "tear", "stroke": [{"base": )" +
           at(0.2, 1) + ", \"tip\": " + at(0.2, -1) + "}, {\"base\": " + at(0.7, 1) +
           ", \"tip\": " + at(0.7, -1) + "}]}]}";
  }
};

TEST_F(BloodCommand, lays_blood_on_a_copy_of_the_torn_texture_alone) {
  test::GltfBuilder builder;
  const std::size_t green = add_texture(builder, Texel{20, 200, 20, 255});
  builder.json["samplers"].push_back({{"wrapS", 33071}, {"magFilter", 9728}});
  builder.json["textures"][green]["sampler"] = 0;
  OrderedJson material = textured(green);
  material["name"] = "Green";
  material["pbrMetallicRoughness"]["roughnessFactor"] = 0.25;
  add_square(builder, 0, 0, material);
  add_square(builder, 2, 0, material);
  builder.json["meshes"][1]["primitives"][0]["material"] = 0;  // Both share it.
  save(builder, "squares.glb");
  const CommandResult result = tear(path("squares.glb"), across(0), "torn", {"--blood=0.1"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  const Glb glb(bytes("torn.glb"));
  EXPECT_EQ(glb.material_of(1).at("name"), "Green");
  const json& bloody = glb.material_of(0);
  EXPECT_EQ(bloody.at("name"), "Green blood");
  EXPECT_EQ(bloody.at("pbrMetallicRoughness").at("roughnessFactor"), 0.25);
  const json& texture = glb.document.at("textures")
                            .at(bloody.at("pbrMetallicRoughness")
                                    .at("baseColorTexture")
                                    .at("index")
                                    .get<std::size_t>());
  EXPECT_EQ(glb.document.at("samplers").at(texture.at("sampler").get<std::size_t>()).at("wrapS"),
            33071);
  const Pixels before = image_of(glb, glb.material_of(1)), after = image_of(glb, bloody);
  ASSERT_GE(after.width, 64) << "fine enough for the border of the blood";
  EXPECT_TRUE(is_bloody(after.at(after.width * 45 / 100, after.height / 2)));
  for (int y = 0; y < after.height; ++y)
    for (int x = 0; x < after.width; ++x) {
      // A little more than the reach from the line between u = 0.2 and 0.7, v = 0.5.
      const double u = (x + 0.5) / after.width, v = (y + 0.5) / after.height;
      if (std::hypot(u - std::clamp(u, 0.2, 0.7), v - 0.5) < 0.11) continue;
      if (v > 0.5 && u > 0.1 && u < 0.8) continue;  // it runs down
      ASSERT_EQ(after.at(x, y), before.at(0, 0)) << x << ' ' << y;
    }
  const json blood = read_json("torn.json").at("blood");
  EXPECT_EQ(blood.at("reach"), 0.1);
  EXPECT_EQ(blood.at("textures").size(), 1U);
  EXPECT_EQ(blood.at("notes").size(), 0U);
}

TEST_F(BloodCommand, bakes_the_factor_into_the_image_and_keeps_alpha) {
  test::GltfBuilder builder;
  const std::size_t white = add_texture(builder, Texel{255, 255, 255, 128});
  OrderedJson material = textured(white);
  material["alphaMode"] = "BLEND";
  material["pbrMetallicRoughness"]["baseColorFactor"] = {0.0, 0.0, 1.0, 0.5};
  add_square(builder, 0, 0, material);
  save(builder, "blue.glb");
  EXPECT_EQ(tear(path("blue.glb"), across(0), "blue_torn", {"--blood=0.1"}).exit_code, 0);
  const Glb glb(bytes("blue_torn.glb"));
  const json& bloody = glb.material_of(0);
  EXPECT_EQ(bloody.at("alphaMode"), "BLEND");
  EXPECT_EQ(bloody.at("pbrMetallicRoughness").at("baseColorFactor"), json({1, 1, 1, 0.5}));
  const Pixels image = image_of(glb, bloody);
  EXPECT_EQ(image.at(0, 0), (Pixels::Color{0, 0, 255}));
  EXPECT_TRUE(is_bloody(image.at(image.width * 45 / 100, image.height / 2)));
}

TEST_F(BloodCommand, places_the_image_anew_where_it_repeats) {
  // The texture transform shows the image three times across the square.
  test::GltfBuilder builder;
  const Texel black = {0, 0, 0, 255}, white = {255, 255, 255, 255};
  OrderedJson material = textured(add_texture(builder, {black, white, black, white}));
  builder.json["samplers"].push_back({{"magFilter", 9728}});
  builder.json["textures"][0]["sampler"] = 0;
  material["pbrMetallicRoughness"]["baseColorTexture"]["extensions"]["KHR_texture_transform"] = {
      {"scale", {3, 1}}};
  builder.json["extensionsUsed"] = {"KHR_texture_transform"};
  add_square(builder, 0, 0, material);
  save(builder, "repeated.glb");
  const CommandResult result =
      tear(path("repeated.glb"), across(0), "repeated_torn", {"--blood=0.05"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  const Glb glb(bytes("repeated_torn.glb"));
  const json& bloody = glb.material_of(0);
  const json& at = bloody.at("pbrMetallicRoughness")
                       .at("baseColorTexture")
                       .at("extensions")
                       .at("KHR_texture_transform");
  EXPECT_EQ(at.at("scale"), json({1, 1}));
  EXPECT_EQ(at.at("offset"), json({0, 0}));
  const Pixels image = image_of(glb, bloody);
  int blood_left = 0, blood_right = 0, stripes = 0;
  for (int x = 0; x < image.width; ++x) {
    (x < image.width / 2 ? blood_left : blood_right) += is_bloody(image.at(x, image.height / 2));
    const auto is_light = [&](int column) { return image.at(column, 1)[1] > 128; };
    stripes += x > 0 && is_light(x) != is_light(x - 1) ? 1 : 0;
  }
  EXPECT_EQ(stripes, 5) << "dark and light three times";
  EXPECT_NEAR(blood_left, 0.3 * image.width, 0.1 * image.width);
  EXPECT_NEAR(blood_right, 0.2 * image.width, 0.1 * image.width);
}

TEST_F(BloodCommand, gives_colours_to_vertices_where_textures_have_no_room) {
  test::GltfBuilder builder;
  add_square(builder, 0, 0, textured(add_texture(builder, Texel{255, 255, 255, 255})));
  add_square(builder, 0, 5, OrderedJson::object());
  builder.json["meshes"][0]["primitives"][0]["attributes"].erase("TEXCOORD_0");
  save(builder, "plain.glb");
  const CommandResult result = tear(path("plain.glb"), across(0), "plain_torn", {"--blood=0.1"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.err, HasSubstr("no texture coordinates"));
  const auto loaded = load_character(path("plain_torn.glb"));
  ASSERT_TRUE(loaded);
  const Mesh& mesh = loaded->character->meshes[0];
  ASSERT_EQ(mesh.color_sets.size(), 1U);
  EXPECT_LT(mesh.color_sets[0].back().y(), 0.5f * mesh.color_sets[0].back().x());
  EXPECT_EQ(mesh.color_sets[0].front(), Vec4f(Vec4f::Ones())) << "far from the wound";
  EXPECT_EQ(read_json("plain_torn.json").at("blood").at("meshes_with_vertex_colours"), 1);
}

TEST_F(BloodCommand, is_red_also_in_the_colours_of_a_green_surface) {
  const Vec3f green(0.1f, 0.6f, 0.1f);
  test::GltfBuilder builder;
  add_square(builder, 0, 0,
             {{"pbrMetallicRoughness", {{"baseColorFactor", {green[0], green[1], green[2], 1}}}}});
  builder.json["meshes"][0]["primitives"][0]["attributes"].erase("TEXCOORD_0");
  save(builder, "green.glb");
  const CommandResult result = tear(path("green.glb"), across(0), "green_torn", {"--blood=0.1"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  const auto loaded = load_character(path("green_torn.glb"));
  ASSERT_TRUE(loaded);
  const Mesh& mesh = loaded->character->meshes[0];
  ASSERT_EQ(mesh.color_sets.size(), 1U);
  const Vec3f shown = mesh.color_sets[0].back().head<3>().cwiseProduct(green);
  // As red as the colours of vertices allow, up to 1; not the product of red and green, a brown.
  EXPECT_GT(shown.x(), 0.08f);
  EXPECT_GT(shown.x(), 3 * shown.y());
  EXPECT_LE(mesh.color_sets[0].back().maxCoeff(), 1.0f);
}

TEST_F(BloodCommand, opens_in_readers_and_is_the_same_twice) {
  SUNDER_SKIP_WITHOUT_GLTF_VALIDATOR();
  for (const char* const name : {"one", "two"})
    EXPECT_EQ(tear(model(), kOneTear, name, {"--open", "--blood"}).exit_code, 0);
  EXPECT_EQ(bytes("one.glb"), bytes("two.glb"));
  const auto report = test::validate_glb(path("one.glb"));
  EXPECT_EQ(report.errors, 0) << report.output;
}

TEST_F(BloodCommand, refuses_what_it_cannot_do) {
  EXPECT_EQ(tear(model(), kOneTear, "no", {"--blood=0"}).exit_code, 2);
  EXPECT_EQ(tear(model(), kOneTear, "no", {"--blood=red"}).exit_code, 2);
  EXPECT_FALSE(exists("no.glb"));
  const CommandResult usd = run_sunder(
      {"tear", model(), "--ops", write("ops.json", kOneTear), "-o", path("no.usda"), "--blood"});
  EXPECT_EQ(usd.exit_code, 2);
  EXPECT_THAT(usd.err, HasSubstr("GLB"));
}

TEST_F(BloodCommand, pieces_have_it_too) {
  test::GltfBuilder builder;
  add_square(builder, 0, 0, textured(add_texture(builder, Texel{255, 255, 255, 255})));
  save(builder, "whole.glb");
  const char* const log = R"({"sunder_operations": 1, "operations": [
    {"op": "cut", "plane": {"point": [0.5, 0, 0], "normal": [1, 0, 0]}},
    {"op": "detach", "piece": {"near": [0.9, 0.5, 0]}}]})";
  const CommandResult result =
      tear(path("whole.glb"), log, "halved", {"--blood=0.1", "--pieces", path("piece")});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  ASSERT_TRUE(exists("piece1.glb")) << result.err;
  const Glb piece(bytes("piece1.glb"));
  const Glb halved(bytes("halved.glb"));
  for (const Glb* const half : {&piece, &halved}) {
    const Pixels image = image_of(*half, half->material_of(0));
    for (const int percent : {49, 51})
      EXPECT_TRUE(is_bloody(image.at(image.width * percent / 100, image.height / 2)));
    for (const int percent : {20, 80})
      EXPECT_FALSE(is_bloody(image.at(image.width * percent / 100, image.height / 2)));
  }
}

}  // namespace
}  // namespace sunder::command_test
