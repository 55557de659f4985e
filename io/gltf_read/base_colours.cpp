#include "io/internal/base_colours.h"

#include <utility>

#include "io/gltf/refusal.h"
#include "io/gltf/source_document.h"
#include "io/gltf_read/material_parts.h"

namespace sunder {
namespace {

using gltf::entry;
using gltf::Json;
using gltf::member;
using gltf::share_or;

class Reader {
 public:
  Reader(const SourceDocument& source, std::uint64_t maximum_bytes)
      : source_(source), images_(source, maximum_bytes) {}

  BaseColours read() {
    const Json& materials = member(source_.json, "materials");
    if (materials.is_array())
      for (const Json& material : materials) found_.materials.push_back(read(material));
    found_.images = std::move(images_.all());
    found_.left_out = images_.left_out();
    return std::move(found_);
  }

 private:
  BaseColour read(const Json& material) {
    BaseColour colour;
    const Json& surface = member(material, "pbrMetallicRoughness");
    if (const Json& name = member(material, "name"); name.is_string())
      colour.name = name.get<std::string>();
    if (!member(surface, "metallicRoughnessTexture").is_object())
      colour.metallic = share_or(member(surface, "metallicFactor"), 0.0f);
    if (const Json& factor = member(surface, "baseColorFactor");
        factor.is_array() && factor.size() == 4)
      for (int i = 0; i < 4; ++i)
        colour.factor[i] = share_or(factor[static_cast<std::size_t>(i)], 1.0f);
    const Json& mode = member(material, "alphaMode");
    if (mode == "MASK") colour.cutoff = share_or(member(material, "alphaCutoff"), 0.5f);
    colour.is_blended = mode == "BLEND";
    if (colour.is_blended) colour.cutoff = 0.5f;
    const Json& extensions = member(material, "extensions");
    colour.is_unlit = member(extensions, "KHR_materials_unlit").is_object();
    colour.emission = gltf::emission_of(material);
    colour.image = read_texture(member(surface, "baseColorTexture"), true, colour);
    if (const Json& emission = member(material, "emissiveTexture");
        emission.is_object() && colour.emission.maxCoeff() > 0) {
      colour.emission_image = read_texture(emission, colour.image == kNone, colour);
      if (colour.emission_image == kNone) colour.emission.setZero();
    }
    return colour;
  }

  /// The image of a texture that a material refers to; kNone if there is none.
  /// @param takes_place  whether its coordinates become those of the material.
  std::uint32_t read_texture(const Json& reference, bool takes_place, BaseColour& colour) {
    if (!reference.is_object()) return kNone;
    const Json& texture = entry(source_.json, "textures", member(reference, "index"));
    const std::uint32_t found = images_.of_texture(texture);
    if (found == kNone) colour.lacks_image = true;
    if (!takes_place || !texture.is_object()) return found;
    const Json& transform = member(member(reference, "extensions"), "KHR_texture_transform");
    for (const Json* const object : {&reference, &transform})
      if (const Json& set = member(*object, "texCoord"); set.is_number_unsigned())
        if (const auto number = set.get<std::uint64_t>(); number < kNone)
          colour.uv_set = static_cast<std::uint32_t>(number);
    colour.image_from_uv = gltf::transform_of(transform);
    const Json& sampler = entry(source_.json, "samplers", member(texture, "sampler"));
    colour.wrap_u = gltf::wrap_of(sampler, "wrapS");
    colour.wrap_v = gltf::wrap_of(sampler, "wrapT");
    colour.is_pixelated = member(sampler, "magFilter") == 9728;
    return found;
  }

  const SourceDocument& source_;
  gltf::DocumentImages images_;
  BaseColours found_;
};

}  // namespace

Result<BaseColours> read_base_colours(const SourceDocument& source, std::uint64_t maximum_bytes) {
  return gltf::without_exceptions<BaseColours>(
      [&] { return Reader(source, maximum_bytes).read(); });
}

}  // namespace sunder
