#include "io/internal/base_colours.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <utility>

#include "io/gltf/buffers.h"
#include "io/gltf/image_header.h"
#include "io/gltf/refusal.h"
#include "io/gltf/source_document.h"
#include "io/gltf/uris.h"

namespace sunder {
namespace {

using gltf::Json;

/// A member of an object, or null. Materials are not checked when a file is loaded.
const Json& member(const Json& object, const char* key) {
  static const Json absent;
  if (!object.is_object()) return absent;
  const auto found = object.find(key);
  return found == object.end() ? absent : *found;
}

/// An entry of a list of the document, or null.
const Json& entry(const Json& document, const char* list, const Json& index) {
  static const Json absent;
  const Json& entries = member(document, list);
  if (!entries.is_array() || !index.is_number_unsigned() ||
      index.get<std::uint64_t>() >= entries.size())
    return absent;
  return entries[index.get<std::size_t>()];
}

float share_or(const Json& value, float otherwise) {
  return value.is_number() ? std::clamp(value.get<float>(), 0.0f, 1.0f) : otherwise;
}

BaseColour::Wrap wrap_of(const Json& sampler, const char* key) {
  const Json& wrap = member(sampler, key);
  if (wrap == 33071) return BaseColour::Wrap::clamp;
  return wrap == 33648 ? BaseColour::Wrap::mirror : BaseColour::Wrap::repeat;
}

float number_or(const Json& object, const char* key, std::size_t i, float otherwise) {
  const Json& list = member(object, key);
  if (!list.is_array() || i >= list.size() || !list[i].is_number()) return otherwise;
  const auto value = list[i].get<float>();
  return std::isfinite(value) ? value : otherwise;
}

/// Scaled, then turned, then moved, as KHR_texture_transform says.
Eigen::Matrix<float, 2, 3> transform_of(const Json& transform) {
  const Json& angle = member(transform, "rotation");
  const float rotation = angle.is_number() ? angle.get<float>() : 0.0f;
  const float cosine = std::isfinite(rotation) ? std::cos(rotation) : 1.0f,
              sine = std::isfinite(rotation) ? std::sin(rotation) : 0.0f;
  const float x = number_or(transform, "scale", 0, 1), y = number_or(transform, "scale", 1, 1);
  Eigen::Matrix<float, 2, 3> result;
  result << cosine * x, sine * y, number_or(transform, "offset", 0, 0), -sine * x, cosine * y,
      number_or(transform, "offset", 1, 0);
  return result;
}

Vec3f emission_of(const Json& material) {
  const Json& strength =
      member(member(member(material, "extensions"), "KHR_materials_emissive_strength"),
             "emissiveStrength");
  Vec3f emission;
  for (std::size_t i = 0; i < 3; ++i)
    emission[static_cast<int>(i)] =
        std::clamp(number_or(material, "emissiveFactor", i, 0), 0.0f, 1.0f);
  if (strength.is_number()) emission *= std::clamp(strength.get<float>(), 0.0f, 1e3f);
  return emission;
}

class Reader {
 public:
  Reader(const SourceDocument& source, std::uint64_t maximum_bytes)
      : source_(source), bytes_left_(maximum_bytes) {}

  BaseColours read() {
    const Json& materials = member(source_.json, "materials");
    if (materials.is_array())
      for (const Json& material : materials) found_.materials.push_back(read(material));
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
    colour.emission = emission_of(material);
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
    const Json& webp = member(member(texture, "extensions"), "EXT_texture_webp");
    const std::uint32_t found = image(member(webp.is_object() ? webp : texture, "source"));
    if (found == kNone) colour.lacks_image = true;
    if (!takes_place || !texture.is_object()) return found;
    const Json& transform = member(member(reference, "extensions"), "KHR_texture_transform");
    for (const Json* const object : {&reference, &transform})
      if (const Json& set = member(*object, "texCoord"); set.is_number_unsigned())
        if (const auto number = set.get<std::uint64_t>(); number < kNone)
          colour.uv_set = static_cast<std::uint32_t>(number);
    colour.image_from_uv = transform_of(transform);
    const Json& sampler = entry(source_.json, "samplers", member(texture, "sampler"));
    colour.wrap_u = wrap_of(sampler, "wrapS");
    colour.wrap_v = wrap_of(sampler, "wrapT");
    colour.is_pixelated = member(sampler, "magFilter") == 9728;
    return found;
  }

  /// The number of an image in the result; kNone if it is left out.
  std::uint32_t image(const Json& index) {
    const Json& image = entry(source_.json, "images", index);
    if (!image.is_object()) return kNone;
    const auto [known, is_new] = numbers_.try_emplace(place_of(image), kNone);
    if (!is_new) return known->second;
    std::optional<std::vector<std::byte>> bytes = bytes_of(image);
    // What is no image counts too: it was read, or copied.
    const bool fits = bytes && bytes->size() <= bytes_left_;
    if (fits) bytes_left_ -= bytes->size();
    const char* const type = fits ? gltf::image_type(*bytes) : nullptr;
    if (type == nullptr || std::string(type) == "image/ktx2") {
      ++found_.left_out;
      return kNone;
    }
    known->second = static_cast<std::uint32_t>(found_.images.size());
    found_.images.push_back({type, std::move(*bytes)});
    return known->second;
  }

  /// Where the bytes of an image are: many images may be one view of a buffer, or one file.
  [[nodiscard]] std::string place_of(const Json& image) const {
    const Json& view = entry(source_.json, "bufferViews", member(image, "bufferView"));
    if (const Json& uri = member(image, "uri"); !view.is_object())
      return uri.is_string() ? "at " + uri.get<std::string>() : std::string();
    return member(view, "buffer").dump() + " " + member(view, "byteOffset").dump() + " " +
           member(view, "byteLength").dump();
  }

  std::optional<std::vector<std::byte>> bytes_of(const Json& image) const {
    try {
      const Json& view = member(image, "bufferView");
      if (entry(source_.json, "bufferViews", view).is_object()) {
        const auto bytes = gltf::bytes_of_view(source_, view.get<std::uint32_t>());
        if (bytes.size() > bytes_left_) return {};
        return std::vector<std::byte>(bytes.begin(), bytes.end());
      }
      const Json& uri = member(image, "uri");
      if (!uri.is_string()) return {};
      const auto text = uri.get<std::string>();
      if (gltf::is_data_uri(text)) return gltf::decode_data_uri(text, "image");
      return source_.read_side_file(text, "image", bytes_left_);
    } catch (const gltf::Refusal&) {
      return {};
    }
  }

  const SourceDocument& source_;
  std::uint64_t bytes_left_;
  BaseColours found_;
  std::map<std::string, std::uint32_t> numbers_;  ///< By place_of().
};

}  // namespace

Result<BaseColours> read_base_colours(const SourceDocument& source, std::uint64_t maximum_bytes) {
  return gltf::without_exceptions<BaseColours>(
      [&] { return Reader(source, maximum_bytes).read(); });
}

}  // namespace sunder
