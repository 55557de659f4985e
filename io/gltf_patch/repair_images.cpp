#include "io/gltf_patch/repair_images.h"

#include <algorithm>
#include <array>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "io/gltf/image_header.h"
#include "io/gltf/refusal.h"
#include "io/gltf/uris.h"

namespace sunder::gltf {
namespace {

constexpr const char* kWebpExtension = "EXT_texture_webp";
constexpr std::string_view kWhitePixel =
    "data:image/"
    "png;base64,"
    "iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAAAAAA6fptVAAAACklEQVR4nGP4DwABAQEAG7buVgAAAABJRU5E"
    "rkJggg==";

class ImageRepair {
 public:
  explicit ImageRepair(GlbDraft& draft) : draft_(draft) {}

  void run() {
    if (!draft_.json.contains("images")) return;
    const std::size_t count = draft_.json["images"].size();
    for (std::size_t i = 0; i < count; ++i) repair(i);
    if (!draft_.json.contains("textures")) return;
    for (Json& texture : draft_.json["textures"]) repair_texture(texture);
  }

 private:
  Json& image_at(std::size_t index) { return draft_.json["images"][index]; }

  void repair(std::size_t index) {
    Json& image = image_at(index);
    if (image.contains("bufferView")) {
      image.erase("uri");
      check_data(index, bytes_of(image["bufferView"].get<std::size_t>()));
    } else if (!image.contains("uri")) {
      embed(index, decode_data_uri(std::string(kWhitePixel), "image"));
    } else if (is_data_uri(image["uri"].get_ref<const std::string&>())) {
      check_uri(index);
    }
  }

  /// Data with another type than its URI says is embedded as what it is.
  void check_uri(std::size_t index) {
    const std::string uri = image_at(index)["uri"].get<std::string>();
    std::vector<std::byte> bytes;
    try {
      bytes = decode_data_uri(uri, "image");
    } catch (const Refusal&) {
      return embed(index, decode_data_uri(std::string(kWhitePixel), "image"));
    }
    const char* const type = image_type(bytes);
    if (type == nullptr || !is_image_header_sound(bytes))
      return embed(index, decode_data_uri(std::string(kWhitePixel), "image"));
    const std::string declared = uri.substr(5, uri.find_first_of(";,") - 5);
    if (declared != type) return embed(index, std::move(bytes));
    if (image_at(index).contains("mimeType") && image_at(index)["mimeType"] != type)
      image_at(index)["mimeType"] = type;
    note_type(index, type);
  }

  void check_data(std::size_t index, std::span<const std::byte> bytes) {
    const char* const type = image_type(bytes);
    if (type == nullptr || !is_image_header_sound(bytes))
      return embed(index, decode_data_uri(std::string(kWhitePixel), "image"));
    Json& image = image_at(index);
    if (!image.contains("mimeType") || image["mimeType"] != type) image["mimeType"] = type;
    note_type(index, type);
  }

  void embed(std::size_t index, std::vector<std::byte> bytes) {
    const std::uint32_t view = draft_.add_view(bytes, GlbDraft::ViewTarget::none);
    Json& image = image_at(index);
    image.erase("uri");
    const char* const type = image_type(bytes);
    image["mimeType"] = type;
    image["bufferView"] = view;
    note_type(index, type);
  }

  void note_type(std::size_t index, std::string_view type) {
    if (type == "image/webp") webp_.push_back(index);
  }

  std::span<const std::byte> bytes_of(std::size_t index) {
    const Json& view = draft_.json["bufferViews"][index];
    const auto offset = view.contains("byteOffset") ? view["byteOffset"].get<std::size_t>() : 0,
               length = view["byteLength"].get<std::size_t>();
    const auto all = draft_.bytes();
    if (offset > all.size() || length > all.size() - offset) return {};
    return all.subspan(offset, length);
  }

  /// Only an extension may refer to a WebP image.
  void repair_texture(Json& texture) {
    const auto found = texture.find("source");
    if (found == texture.end()) return;
    const auto source = found->get<std::size_t>();
    if (std::find(webp_.begin(), webp_.end(), source) == webp_.end()) return;
    texture.erase("source");
    Json& extension = texture["extensions"][kWebpExtension];
    if (!extension.is_object() || !extension.contains("source")) extension = {{"source", source}};
    Json& used = list_of(draft_.json, "extensionsUsed");
    if (std::find(used.begin(), used.end(), kWebpExtension) == used.end())
      used.push_back(kWebpExtension);
  }

  GlbDraft& draft_;
  std::vector<std::size_t> webp_;
};

}  // namespace

void repair_images(GlbDraft& draft) { ImageRepair(draft).run(); }

}  // namespace sunder::gltf
