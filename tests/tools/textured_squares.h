#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "support/models/gltf_builder.h"
#include "tools/picture_pixels.h"

// A row of squares that face the viewer, each with a material of its own.

namespace sunder::command_test {

using OrderedJson = nlohmann::ordered_json;
using Texel = std::array<std::uint8_t, 4>;

/// Adds a unit square with its lower left corner at (x, 0, z).
inline void add_square(test::GltfBuilder& builder, float x, float z, const OrderedJson& material,
                       const std::vector<float>& color = {}) {
  OrderedJson attributes;
  attributes["POSITION"] = builder.add<float>({x, 0, z, x + 1, 0, z, x + 1, 1, z, x, 1, z}, "VEC3");
  attributes["NORMAL"] = builder.add<float>({0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1}, "VEC3");
  attributes["TEXCOORD_0"] = builder.add<float>({0, 1, 1, 1, 1, 0, 0, 0}, "VEC2");
  if (!color.empty()) {
    std::vector<float> colors;
    for (int i = 0; i < 4; ++i) colors.insert(colors.end(), color.begin(), color.end());
    attributes["COLOR_0"] = builder.add<float>(colors, "VEC4");
  }
  const std::size_t indices = builder.add<std::uint16_t>({0, 1, 2, 0, 2, 3}, "SCALAR");
  builder.json["materials"].push_back(material);
  builder.json["meshes"].push_back(
      {{"primitives", OrderedJson::array({{{"attributes", attributes},
                                           {"indices", indices},
                                           {"material", builder.json["materials"].size() - 1}}})}});
  builder.json["nodes"].push_back({{"mesh", builder.json["meshes"].size() - 1}});
  builder.json["scenes"][0]["nodes"].push_back(builder.json["nodes"].size() - 1);
}

/// A texture of 2 x 2 texels. @return its index.
inline std::size_t add_texture(test::GltfBuilder& builder, const std::array<Texel, 4>& texels) {
  const std::vector<std::byte> png = test::make_png(2, 2, {texels.begin(), texels.end()});
  std::vector<std::uint8_t> bytes;
  for (const std::byte byte : png) bytes.push_back(std::to_integer<std::uint8_t>(byte));
  builder.json["images"].push_back(
      {{"bufferView", builder.add_view(bytes)}, {"mimeType", "image/png"}});
  builder.json["textures"].push_back({{"source", builder.json["images"].size() - 1}});
  return builder.json["textures"].size() - 1;
}

/// All of one colour.
inline std::size_t add_texture(test::GltfBuilder& builder, const Texel& texel) {
  return add_texture(builder, {texel, texel, texel, texel});
}

/// A material with a texture.
inline OrderedJson textured(std::size_t texture) {
  return {{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", texture}}}}}};
}

}  // namespace sunder::command_test
