#include "io/internal/base_colours.h"

#include <algorithm>
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
    if (const Json& factor = member(surface, "baseColorFactor");
        factor.is_array() && factor.size() == 4)
      for (int i = 0; i < 4; ++i)
        colour.factor[i] = share_or(factor[static_cast<std::size_t>(i)], 1.0f);
    const Json& mode = member(material, "alphaMode");
    if (mode == "MASK") colour.cutoff = share_or(member(material, "alphaCutoff"), 0.5f);
    if (mode == "BLEND") colour.cutoff = 0.5f;
    const Json& reference = member(surface, "baseColorTexture");
    const Json& texture = entry(source_.json, "textures", member(reference, "index"));
    if (!texture.is_object()) return colour;
    const Json& webp = member(member(texture, "extensions"), "EXT_texture_webp");
    colour.image = image(member(webp.is_object() ? webp : texture, "source"));
    if (const Json& set = member(reference, "texCoord"); set.is_number_unsigned())
      if (const auto number = set.get<std::uint64_t>(); number < kNone)
        colour.uv_set = static_cast<std::uint32_t>(number);
    const Json& sampler = entry(source_.json, "samplers", member(texture, "sampler"));
    colour.wrap_u = wrap_of(sampler, "wrapS");
    colour.wrap_v = wrap_of(sampler, "wrapT");
    return colour;
  }

  /// The number of an image in the result; kNone if it is left out.
  std::uint32_t image(const Json& index) {
    const Json& image = entry(source_.json, "images", index);
    if (!image.is_object()) return kNone;
    const auto [known, is_new] = numbers_.try_emplace(index.get<std::uint64_t>(), kNone);
    if (!is_new) return known->second;
    std::optional<std::vector<std::byte>> bytes = bytes_of(image);
    const char* const type = bytes ? gltf::image_type(*bytes) : nullptr;
    if (type == nullptr || std::string(type) == "image/ktx2" || bytes->size() > bytes_left_) {
      ++found_.left_out;
      return kNone;
    }
    bytes_left_ -= bytes->size();
    known->second = static_cast<std::uint32_t>(found_.images.size());
    found_.images.push_back({type, std::move(*bytes)});
    return known->second;
  }

  std::optional<std::vector<std::byte>> bytes_of(const Json& image) const {
    try {
      const Json& view = member(image, "bufferView");
      if (entry(source_.json, "bufferViews", view).is_object()) {
        const auto bytes = gltf::bytes_of_view(source_, view.get<std::uint32_t>());
        return std::vector<std::byte>(bytes.begin(), bytes.end());
      }
      const Json& uri = member(image, "uri");
      if (!uri.is_string()) return {};
      const auto text = uri.get<std::string>();
      if (gltf::is_data_uri(text)) return gltf::decode_data_uri(text, "image");
      return gltf::read_uri(text, source_.folder, "image", source_.roots, bytes_left_);
    } catch (const gltf::Refusal&) {
      return {};
    }
  }

  const SourceDocument& source_;
  std::uint64_t bytes_left_;
  BaseColours found_;
  std::map<std::uint64_t, std::uint32_t> numbers_;  ///< By index in /images.
};

}  // namespace

Result<BaseColours> read_base_colours(const SourceDocument& source, std::uint64_t maximum_bytes) {
  return gltf::without_exceptions<BaseColours>(
      [&] { return Reader(source, maximum_bytes).read(); });
}

}  // namespace sunder
