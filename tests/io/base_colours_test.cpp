// Contract of read_base_colours(): io/internal/base_colours.h.

#include "io/internal/base_colours.h"

#include <fstream>
#include <limits>
#include <string>
#include <string_view>

#include <gtest/gtest.h>

#include "support/machine/temporary_folder.h"
#include "support/models/gltf_builder.h"

namespace sunder::test {
namespace {

constexpr std::uint64_t kNoLimit = std::numeric_limits<std::uint64_t>::max();
/// The beginning of a file is all that is looked at.
constexpr std::string_view kPng("\x89PNG\r\n\x1A\n and more", 17);
constexpr std::string_view kJpeg("\xFF\xD8\xFF and more", 12);

std::vector<std::uint8_t> bytes_of(std::string_view text) { return {text.begin(), text.end()}; }

/// The strip with two images, one of which two textures use.
GltfBuilder coloured_strip() {
  GltfBuilder builder = skinned_strip();
  const std::size_t png = builder.add_view(bytes_of(kPng));
  builder.json["images"] = {{{"bufferView", png}, {"mimeType", "image/png"}},
                            {{"uri", "beside.jpg"}},
                            {{"uri", "../outside.jpg"}},
                            {{"uri", "data:text/plain;base64,AAAA"}}};
  builder.json["samplers"] = {{{"wrapS", 33071}, {"wrapT", 33648}, {"magFilter", 9728}}};
  builder.json["textures"] = {{{"source", 0}, {"sampler", 0}},
                              {{"source", 1}},
                              {{"source", 0}},
                              {{"source", 2}},
                              {{"source", 3}}};
  const auto material = [](std::size_t texture) {
    return Json{{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", texture}}}}}};
  };
  Json first = material(0);
  first["pbrMetallicRoughness"]["baseColorFactor"] = {0.5, 0.25, 1.0, 0.75};
  first["pbrMetallicRoughness"]["baseColorTexture"]["texCoord"] = 1;
  first["alphaMode"] = "MASK";
  first["alphaCutoff"] = 0.25;
  builder.json["materials"] = {first,       material(1), material(2),
                               material(3), material(4), Json::object()};
  return builder;
}

class BaseColoursTest : public testing::Test {
 protected:
  BaseColoursTest() {
    std::ofstream(folder_.path() / "beside.jpg", std::ios::binary) << kJpeg;
    builder_ = coloured_strip();
  }

  [[nodiscard]] BaseColours read(std::uint64_t limit = kNoLimit) const {
    const auto file = folder_.path() / "strip.gltf";
    std::ofstream(file, std::ios::binary) << builder_.text();
    const auto loaded = load_character(file);
    EXPECT_TRUE(loaded) << loaded.error().text();
    auto colours = read_base_colours(*loaded->source, limit);
    EXPECT_TRUE(colours) << colours.error().text();
    return *colours;
  }

  TemporaryFolder folder_;
  GltfBuilder builder_;
};

TEST_F(BaseColoursTest, are_those_of_the_file) {
  const BaseColours colours = read();
  ASSERT_EQ(colours.materials.size(), 6u);
  const BaseColour& first = colours.materials[0];
  EXPECT_EQ(first.factor, Vec4f(0.5f, 0.25f, 1.0f, 0.75f));
  EXPECT_EQ(first.uv_set, 1u);
  EXPECT_EQ(first.wrap_u, BaseColour::Wrap::clamp);
  EXPECT_EQ(first.wrap_v, BaseColour::Wrap::mirror);
  EXPECT_TRUE(first.is_pixelated);
  EXPECT_FALSE(colours.materials[1].is_pixelated);
  EXPECT_EQ(first.cutoff, 0.25f);
  EXPECT_EQ(colours.materials[5].factor, Vec4f(Vec4f::Ones()));
  EXPECT_EQ(colours.materials[5].image, kNone);
  EXPECT_EQ(colours.materials[1].wrap_u, BaseColour::Wrap::repeat);
}

TEST_F(BaseColoursTest, are_metal_where_the_file_says_so_and_no_texture_varies_it) {
  Json& materials = builder_.json["materials"];
  materials[0]["name"] = "Steel";
  materials[0]["pbrMetallicRoughness"]["metallicFactor"] = 0.75;
  materials[1]["pbrMetallicRoughness"]["metallicFactor"] = 0.75;
  materials[1]["pbrMetallicRoughness"]["metallicRoughnessTexture"] = {{"index", 0}};
  const BaseColours colours = read();
  EXPECT_EQ(colours.materials[0].name, "Steel");
  EXPECT_EQ(colours.materials[0].metallic, 0.75f);
  EXPECT_EQ(colours.materials[1].metallic, 0.0f);
  EXPECT_EQ(colours.materials[2].metallic, 0.0f) << "left out";
  EXPECT_EQ(colours.materials[2].name, "");
}

TEST_F(BaseColoursTest, have_each_image_once_and_none_from_outside_the_folder) {
  const BaseColours colours = read();
  ASSERT_EQ(colours.images.size(), 2u);
  EXPECT_EQ(colours.materials[0].image, 0u);
  EXPECT_EQ(colours.materials[2].image, 0u);
  EXPECT_EQ(colours.materials[1].image, 1u);
  EXPECT_EQ(colours.materials[3].image, kNone) << "outside of the folder";
  EXPECT_EQ(colours.materials[4].image, kNone) << "no image";
  EXPECT_EQ(colours.left_out, 2u);
  EXPECT_EQ(colours.images[0].type, "image/png");
  EXPECT_EQ(colours.images[1].type, "image/jpeg");
  const auto& bytes = colours.images[1].bytes;
  EXPECT_EQ(std::string_view(reinterpret_cast<const char*>(bytes.data()), bytes.size()), kJpeg);
}

/// A file of few bytes may name one image thousands of times.
TEST_F(BaseColoursTest, have_one_image_for_all_entries_that_are_the_same_bytes) {
  Json& json = builder_.json;
  json["images"] = Json::array();
  json["textures"] = Json::array();
  json["materials"] = Json::array();
  const std::size_t view = builder_.add_view(bytes_of(kPng));
  json["bufferViews"].push_back(json["bufferViews"][view]);
  for (std::size_t i = 0; i < 300; ++i) {
    if (i % 3 == 0)
      json["images"].push_back({{"uri", "beside.jpg"}});
    else
      json["images"].push_back({{"bufferView", i % 3 == 1 ? view : json["bufferViews"].size() - 1},
                                {"mimeType", "image/png"}});
    json["textures"].push_back({{"source", i}});
    json["materials"].push_back({{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", i}}}}}});
  }
  const BaseColours colours = read(kPng.size() + kJpeg.size());
  ASSERT_EQ(colours.materials.size(), 300u);
  EXPECT_EQ(colours.images.size(), 2u);
  EXPECT_EQ(colours.left_out, 0u);
  for (const BaseColour& colour : colours.materials) EXPECT_LT(colour.image, 2u);
}

TEST_F(BaseColoursTest, have_alpha_emission_and_the_place_in_the_image) {
  Json& materials = builder_.json["materials"];
  materials[0]["alphaMode"] = "BLEND";
  Json& texture = materials[0]["pbrMetallicRoughness"]["baseColorTexture"];
  texture["extensions"]["KHR_texture_transform"] = {{"offset", {0.25, 0.5}},
                                                    {"rotation", 1.5707963267948966},
                                                    {"scale", {2, 4}},
                                                    {"texCoord", 3}};
  materials[1]["emissiveFactor"] = {1, 0.5, 0};
  materials[1]["emissiveTexture"] = {{"index", 0}};
  materials[1]["extensions"] = {{"KHR_materials_unlit", Json::object()},
                                {"KHR_materials_emissive_strength", {{"emissiveStrength", 2}}}};
  materials[5] = {{"emissiveFactor", {1, 1, 1}}, {"emissiveTexture", {{"index", 4}}}};
  const BaseColours colours = read();
  const BaseColour& first = colours.materials[0];
  EXPECT_TRUE(first.is_blended);
  EXPECT_EQ(first.uv_set, 3u);
  // Scaled to (2, 4), turned to (4, -2), moved.
  EXPECT_LT((first.image_from_uv * Vec3f(1, 1, 1) - Vec2f(4.25f, -1.5f)).norm(), 1e-5f);
  const BaseColour& second = colours.materials[1];
  EXPECT_TRUE(second.is_unlit);
  EXPECT_FALSE(second.is_blended);
  EXPECT_EQ(second.emission, Vec3f(2, 1, 0));
  EXPECT_EQ(second.emission_image, first.image);
  EXPECT_FALSE(second.lacks_image);
  EXPECT_EQ(colours.materials[5].emission, Vec3f(Vec3f::Zero())) << "its texture is no image";
  EXPECT_TRUE(colours.materials[5].lacks_image);
}

TEST_F(BaseColoursTest, leave_out_images_beyond_the_limit) {
  EXPECT_EQ(read(kPng.size()).images.size(), 1u);
  EXPECT_EQ(read(0).images.size(), 0u);
  EXPECT_EQ(read(0).left_out, 4u);
}

TEST_F(BaseColoursTest, take_defaults_for_what_is_malformed) {
  Json& materials = builder_.json["materials"];
  materials[0]["pbrMetallicRoughness"]["baseColorFactor"] = {"red", 2, -1};
  materials[0]["pbrMetallicRoughness"]["baseColorTexture"]["index"] = 99;
  materials[1]["pbrMetallicRoughness"]["baseColorFactor"] = {7, -1, "x", 0.5};
  materials[1]["pbrMetallicRoughness"]["baseColorTexture"]["texCoord"] = -1;
  materials[2] = 5;
  materials[3]["pbrMetallicRoughness"] = "none";
  materials[4]["alphaMode"] = 7;
  builder_.json["textures"][1]["sampler"] = "first";
  const BaseColours colours = read();
  ASSERT_EQ(colours.materials.size(), 6u);
  EXPECT_EQ(colours.materials[0].factor, Vec4f(Vec4f::Ones()));
  EXPECT_EQ(colours.materials[0].image, kNone);
  EXPECT_EQ(colours.materials[1].factor, Vec4f(1.0f, 0.0f, 1.0f, 0.5f));
  EXPECT_EQ(colours.materials[1].uv_set, 0u);
  EXPECT_EQ(colours.materials[2].image, kNone);
}

}  // namespace
}  // namespace sunder::test
