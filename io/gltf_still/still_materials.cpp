#include "io/gltf_still/still_materials.h"

#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "io/gltf/refusal.h"
#include "io/gltf/uris.h"

namespace sunder::gltf {
namespace {

const Json* find(const Json& object, const char* key) {
  if (!object.is_object()) return nullptr;
  const auto found = object.find(key);
  return found == object.end() ? nullptr : &*found;
}

/// An entry of a list by an index that a file gave; null if there is none.
const Json* entry_or_null(const Json& document, const char* list, const Json* index) {
  const Json* const entries = find(document, list);
  if (entries == nullptr || index == nullptr || !index->is_number_unsigned()) return nullptr;
  const auto i = index->get<std::size_t>();
  return entries->is_array() && i < entries->size() ? &(*entries)[i] : nullptr;
}

bool can_be_drawn(const Json& document, const Json& texture_reference) {
  const Json* const texture = entry_or_null(document, "textures", find(texture_reference, "index"));
  if (texture == nullptr) return false;
  const Json* const image = entry_or_null(document, "images", find(*texture, "source"));
  if (image == nullptr || find(*image, "bufferView") == nullptr) return false;
  const Json* const type = find(*image, "mimeType");
  return type != nullptr && (*type == "image/png" || *type == "image/jpeg");
}

/// A member that may be of the wrong type, or absent.
Json value_or(const Json& object, const char* key, Json otherwise) {
  const Json* const value = find(object, key);
  return value != nullptr && value->type() == otherwise.type() ? *value : std::move(otherwise);
}

class Material {
 public:
  Material(const Json& document, const Json& source) : document_(document), source_(source) {
    const Json none = Json::object();
    const Json* const pbr = find(source, "pbrMetallicRoughness");
    const Json& base = pbr == nullptr ? none : *pbr;
    base_color_ = value_or(base, "baseColorFactor", Json::array({1.0, 1.0, 1.0, 1.0}));
    base_texture_ = texture(base, "baseColorTexture");
    emission_ = value_or(source, "emissiveFactor", Json::array({0.0, 0.0, 0.0}));
    emission_texture_ = texture(source, "emissiveTexture");
  }

  [[nodiscard]] bool has_lost_a_texture() const { return has_lost_a_texture_; }

  [[nodiscard]] Json simplified(bool may_emit) const {
    const Json* const extensions = find(source_, "extensions");
    const bool is_unlit =
        extensions != nullptr && find(*extensions, "KHR_materials_unlit") != nullptr;
    Json pbr = {
        {"baseColorFactor", base_color_}, {"metallicFactor", 0.0}, {"roughnessFactor", 1.0}};
    Json emission = emission_;
    std::optional<Json> emission_texture = emission_texture_;
    const bool emits = is_unlit && may_emit && base_texture_ && base_color_.size() == 4;
    if (emits) {
      emission = Json::array({base_color_[0], base_color_[1], base_color_[2]});
      emission_texture = base_texture_;
      pbr["baseColorFactor"] = {0.0, 0.0, 0.0, base_color_[3]};
    }
    if (base_texture_) pbr["baseColorTexture"] = *base_texture_;
    Json material = {{"pbrMetallicRoughness", std::move(pbr)},
                     {"emissiveFactor", std::move(emission)}};
    if (is_unlit && may_emit && !base_texture_)
      material["extensions"]["KHR_materials_unlit"] = Json::object();
    if (emission_texture) material["emissiveTexture"] = *emission_texture;
    for (const char* const key : {"name", "alphaMode", "alphaCutoff", "doubleSided"})
      if (const Json* const value = find(source_, key)) material[key] = *value;
    return material;
  }

 private:
  std::optional<Json> texture(const Json& object, const char* key) {
    const Json* const reference = find(object, key);
    if (reference == nullptr) return std::nullopt;
    if (can_be_drawn(document_, *reference)) return *reference;
    has_lost_a_texture_ = true;
    return std::nullopt;
  }

  const Json& document_;
  const Json& source_;
  Json base_color_, emission_;
  std::optional<Json> base_texture_, emission_texture_;
  bool has_lost_a_texture_ = false;
};

}  // namespace

std::uint32_t simplify_materials(Json& document, const std::set<std::uint32_t>& colored) {
  Json simplified = Json::array();
  std::uint32_t lost = 0, index = 0;
  for (const Json& source : list_of(document, "materials")) {
    const Material material(document, source);
    simplified.push_back(material.simplified(!colored.contains(index++)));
    if (material.has_lost_a_texture()) ++lost;
  }
  document["materials"] = std::move(simplified);
  return lost;
}

void embed_data_uris(GlbDraft& draft) {
  if (!draft.json.contains("images") || !draft.json["images"].is_array()) return;
  for (std::size_t i = 0; i < draft.json["images"].size(); ++i) {
    const std::string uri = value_or(draft.json["images"][i], "uri", Json("")).get<std::string>();
    if (!is_data_uri(uri)) continue;
    std::vector<std::byte> bytes;
    try {
      bytes = decode_data_uri(uri, "image");
    } catch (const Refusal&) {
      continue;  // The texture is removed with those that have no image.
    }
    const bool is_png = !bytes.empty() && bytes.front() == std::byte{0x89};
    const std::uint32_t view = draft.add_view(bytes, GlbDraft::ViewTarget::none);
    draft.json["images"][i] = {{"bufferView", view},
                               {"mimeType", is_png ? "image/png" : "image/jpeg"}};
  }
}

}  // namespace sunder::gltf
