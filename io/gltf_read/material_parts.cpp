#include "io/gltf_read/material_parts.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "io/gltf/buffers.h"
#include "io/gltf/image_header.h"
#include "io/gltf/refusal.h"
#include "io/gltf/uris.h"

namespace sunder::gltf {

const Json& member(const Json& object, const char* key) {
  static const Json absent;
  if (!object.is_object()) return absent;
  const auto found = object.find(key);
  return found == object.end() ? absent : *found;
}

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

std::uint32_t DocumentImages::of_texture(const Json& texture) {
  const Json& webp = member(member(texture, "extensions"), "EXT_texture_webp");
  return image(member(webp.is_object() ? webp : texture, "source"));
}

std::uint32_t DocumentImages::image(const Json& index) {
  const Json& image = entry(source_.json, "images", index);
  if (!image.is_object()) return kNone;
  const auto [known, is_new] = numbers_.try_emplace(place_of(image), kNone);
  if (!is_new) return known->second;
  std::optional<std::vector<std::byte>> bytes = bytes_of(image);
  // What is no image counts too: it was read, or copied.
  const bool fits = bytes && bytes->size() <= bytes_left_;
  if (fits) bytes_left_ -= bytes->size();
  const char* const type = fits ? image_type(*bytes) : nullptr;
  if (type == nullptr || std::string(type) == "image/ktx2") {
    ++left_out_;
    return kNone;
  }
  known->second = static_cast<std::uint32_t>(images_.size());
  images_.push_back({type, std::move(*bytes)});
  return known->second;
}

/// Where the bytes of an image are: many images may be one view of a buffer, or one file.
std::string DocumentImages::place_of(const Json& image) const {
  const Json& view = entry(source_.json, "bufferViews", member(image, "bufferView"));
  if (const Json& uri = member(image, "uri"); !view.is_object())
    return uri.is_string() ? "at " + uri.get<std::string>() : std::string();
  return member(view, "buffer").dump() + " " + member(view, "byteOffset").dump() + " " +
         member(view, "byteLength").dump();
}

std::optional<std::vector<std::byte>> DocumentImages::bytes_of(const Json& image) const {
  try {
    const Json& view = member(image, "bufferView");
    if (entry(source_.json, "bufferViews", view).is_object()) {
      const auto bytes = bytes_of_view(source_, view.get<std::uint32_t>());
      if (bytes.size() > bytes_left_) return {};
      return std::vector<std::byte>(bytes.begin(), bytes.end());
    }
    const Json& uri = member(image, "uri");
    if (!uri.is_string()) return {};
    const auto text = uri.get<std::string>();
    if (is_data_uri(text)) return decode_data_uri(text, "image");
    return source_.read_side_file(text, "image", bytes_left_);
  } catch (const Refusal&) {
    return {};
  }
}

}  // namespace sunder::gltf
