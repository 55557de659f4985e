// The materials of a model in pictures: tools/picture/model_looks.h.

#include "tools/picture/model_looks.h"

#include <fstream>
#include <span>

#include <gmock/gmock.h>

#include "support/machine/temporary_folder.h"
#include "support/models/gltf_builder.h"
#include "tools/picture_pixels.h"

namespace sunder::tools {
namespace {

using test::GltfBuilder;
using testing::IsEmpty;
using testing::StartsWith;

/// Adds a PNG of 2 x 2 pixels of one colour as a view of a buffer. @return its index.
/// @param is_broken  its end is cut off.
std::size_t add_image(GltfBuilder& builder, std::uint8_t red, bool is_broken = false) {
  const std::array<std::uint8_t, 4> texel = {red, 0, 0, 255};
  const std::vector<std::byte> png = test::make_png(2, 2, {texel, texel, texel, texel});
  std::vector<std::uint8_t> bytes;
  const std::size_t kept = png.size() - (is_broken ? 14 : 0);
  for (const std::byte byte : std::span(png).first(kept))
    bytes.push_back(std::to_integer<std::uint8_t>(byte));
  return builder.add_view(bytes);
}

/// Adds an image of its own, a texture and a material for a view.
void add_material(GltfBuilder& builder, std::size_t view) {
  test::Json& json = builder.json;
  json["images"].push_back({{"bufferView", view}, {"mimeType", "image/png"}});
  json["textures"].push_back({{"source", json["images"].size() - 1}});
  json["materials"].push_back(
      {{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", json["textures"].size() - 1}}}}}});
}

/// A small file may name one large image often, and others that are large together.
TEST(ModelLooks, images_are_decoded_once_and_within_a_limit_for_all) {
  GltfBuilder builder = test::skinned_strip();
  const std::size_t often = add_image(builder, 1);
  for (int i = 0; i < 50; ++i) add_material(builder, often);
  for (std::uint8_t red = 2; red < 6; ++red) add_material(builder, add_image(builder, red));
  const test::TemporaryFolder folder;
  const auto file = folder.path() / "many.gltf";
  std::ofstream(file, std::ios::binary) << builder.text();
  const auto loaded = load_character(file);
  ASSERT_TRUE(loaded) << loaded.error().text();
  const auto missing = [&](std::uint64_t most_pixels) {
    const auto looks = ModelLooks::create(loaded->source.get(), most_pixels);
    return looks ? looks->missing_textures() : std::string(looks.error().text());
  };
  EXPECT_THAT(missing(5 * 4), IsEmpty());
  EXPECT_THAT(missing(5 * 4 - 1), StartsWith("1 materials are drawn without a texture"));
  EXPECT_THAT(missing(2 * 4), StartsWith("3 materials"));
  EXPECT_THAT(missing(0), StartsWith("54 materials"));
}

/// Many broken images would take the time of as many whole ones.
TEST(ModelLooks, images_that_turn_out_broken_count_for_the_limit) {
  GltfBuilder builder = test::skinned_strip();
  for (std::uint8_t red = 1; red < 4; ++red) add_material(builder, add_image(builder, red, true));
  add_material(builder, add_image(builder, 4));
  const test::TemporaryFolder folder;
  const auto file = folder.path() / "broken.gltf";
  std::ofstream(file, std::ios::binary) << builder.text();
  const auto loaded = load_character(file);
  ASSERT_TRUE(loaded) << loaded.error().text();
  const auto missing = [&](std::uint64_t most_pixels) {
    const auto looks = ModelLooks::create(loaded->source.get(), most_pixels);
    return looks ? looks->missing_textures() : std::string(looks.error().text());
  };
  EXPECT_THAT(missing(4 * 4), StartsWith("3 materials"));
  EXPECT_THAT(missing(4 * 4 - 1), StartsWith("4 materials"));
}

}  // namespace
}  // namespace sunder::tools
