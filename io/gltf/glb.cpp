#include "io/gltf/glb.h"

#include <algorithm>
#include <cstring>
#include <limits>
#include <map>
#include <string_view>

#include "io/gltf/image_header.h"
#include "io/gltf/refusal.h"
#include "io/gltf/uris.h"

namespace sunder::gltf {

Json& list_of(Json& object, const char* name) {
  Json& list = object[name];
  if (list.is_null()) list = Json::array();
  return list;
}

namespace {

constexpr std::size_t kAlignment = 4;

void append_u32(std::vector<std::byte>& bytes, std::size_t value) {
  for (int shift = 0; shift < 32; shift += 8)
    bytes.push_back(static_cast<std::byte>(value >> shift & 0xFFu));
}

}  // namespace

GlbDraft::GlbDraft(const SourceDocument& source) : json(source.json), source_(source) {
  merge_buffers();
}

std::uint64_t GlbDraft::append(std::span<const std::byte> bytes) {
  binary_.resize((binary_.size() + kAlignment - 1) / kAlignment * kAlignment);
  const std::uint64_t offset = binary_.size();
  binary_.insert(binary_.end(), bytes.begin(), bytes.end());
  return offset;
}

void GlbDraft::merge_buffers() {
  std::vector<std::uint64_t> offset_of_buffer;
  for (const auto& buffer : source_.buffers) offset_of_buffer.push_back(append(buffer));
  if (source_.buffers.empty()) return;
  Json& buffers = json["buffers"];
  Json merged =
      // A single buffer keeps its name and extras.
      buffers.size() == 1 ? buffers[0] : Json::object();
  merged.erase("uri");
  buffers = Json::array({std::move(merged)});
  if (offset_of_buffer.size() == 1 || !json.contains("bufferViews")) return;

  for (Json& view : json["bufferViews"]) {
    if (!view.contains("buffer") || !view["buffer"].is_number_unsigned() ||
        view["buffer"] >= offset_of_buffer.size())
      continue;
    const std::uint64_t offset =
        view.contains("byteOffset") ? view["byteOffset"].get<std::uint64_t>() : 0;
    view["byteOffset"] = offset + offset_of_buffer[view["buffer"].get<std::size_t>()];
    view["buffer"] = 0;
  }
}

std::uint32_t GlbDraft::add_view(std::span<const std::byte> bytes, ViewTarget target,
                                 std::uint32_t stride) {
  Json view = {{"buffer", 0}, {"byteOffset", append(bytes)}, {"byteLength", bytes.size()}};
  if (stride != 0) view["byteStride"] = stride;
  if (target != ViewTarget::none) view["target"] = static_cast<std::uint32_t>(target);
  Json& views = list_of(json, "bufferViews");
  views.push_back(std::move(view));
  return static_cast<std::uint32_t>(views.size() - 1);
}

std::span<const std::byte> GlbDraft::bytes_of_view(const Json& index) const {
  const auto views = json.find("bufferViews");
  if (views == json.end() || !views->is_array() || !index.is_number_unsigned() ||
      index.get<std::uint64_t>() >= views->size())
    return {};
  const Json& view = (*views)[index.get<std::size_t>()];
  const auto number = [&](const char* key) -> std::uint64_t {
    const auto found = view.find(key);
    return found != view.end() && found->is_number_unsigned() ? found->get<std::uint64_t>() : 0;
  };
  const std::uint64_t offset = number("byteOffset"), length = number("byteLength");
  if (number("buffer") != 0 || offset > binary_.size() || length > binary_.size() - offset)
    return {};
  return std::span(binary_).subspan(offset, length);
}

void GlbDraft::embed_images() {
  std::uint64_t bytes_left = source_.maximum_bytes;
  std::map<std::string, EmbeddedImage> known;
  if (!json.contains("images") || !json["images"].is_array()) return;
  for (Json& image : json["images"]) {
    if (!image.is_object() || !image.contains("uri") || !image["uri"].is_string()) continue;
    const std::string uri = image["uri"].get<std::string>();
    if (is_data_uri(uri)) continue;
    const auto [found, is_new] = known.try_emplace(uri);
    if (is_new) found->second = embed_image(uri, bytes_left);
    if (found->second.type == nullptr) continue;  // The reference stays as in the source.
    image.erase("uri");
    image["mimeType"] = found->second.type;
    image["bufferView"] = found->second.view;
  }
}

/// Whatever is read counts, also what is no image: an entry of some bytes can name a large file.
GlbDraft::EmbeddedImage GlbDraft::embed_image(const std::string& uri, std::uint64_t& bytes_left) {
  if (bytes_left == 0) return {};
  std::vector<std::byte> bytes;
  try {
    bytes = source_.read_side_file(uri, "image", bytes_left);
  } catch (const Refusal& refusal) {
    if (refusal.status.code() == StatusCode::limit_exceeded) bytes_left = 0;
    return {};
  }
  bytes_left -= bytes.size();
  const char* const type = image_type(bytes);
  if (type == nullptr || !is_image_header_sound(bytes)) return {};
  return {type, add_view(bytes, ViewTarget::none)};
}

void GlbDraft::remove_bytes(std::span<const Gap> gaps) {
  std::uint64_t written = gaps.empty() ? binary_.size() : gaps.front().begin;
  for (std::size_t i = 0; i < gaps.size(); ++i) {
    const std::uint64_t begin = gaps[i].begin + gaps[i].length,
                        end = i + 1 < gaps.size() ? gaps[i + 1].begin : binary_.size();
    std::memmove(binary_.data() + written, binary_.data() + begin, end - begin);
    written += end - begin;
  }
  binary_.resize(written);
  if (binary_.empty()) json.erase("buffers");
}

std::vector<std::byte> GlbDraft::finish() {
  if (!binary_.empty()) {
    Json& buffers = list_of(json, "buffers");
    if (buffers.empty()) buffers.push_back(Json::object());
    buffers[0]["byteLength"] = binary_.size();
  }
  binary_.resize((binary_.size() + 3) / 4 * 4);
  // Names in a Character may contain any bytes; JSON is UTF-8.
  std::string text = json.dump(-1, ' ', false, Json::error_handler_t::replace);
  text.resize((text.size() + 3) / 4 * 4, ' ');
  const std::size_t total = 12 + 8 + text.size() + (binary_.empty() ? 0 : 8 + binary_.size());
  if (total > std::numeric_limits<std::uint32_t>::max())
    refuse(StatusCode::limit_exceeded, kNone,
           "the GLB would have %zu bytes; the format's limit is 4 GiB", total);

  std::vector<std::byte> glb;
  glb.reserve(total);
  const auto append_text = [&](std::string_view part) {
    const auto* const first = reinterpret_cast<const std::byte*>(part.data());
    glb.insert(glb.end(), first, first + part.size());
  };
  append_text("glTF");
  append_u32(glb, 2);
  append_u32(glb, total);
  append_u32(glb, text.size());
  append_text("JSON");
  append_text(text);
  if (!binary_.empty()) {
    append_u32(glb, binary_.size());
    append_text(std::string_view("BIN\0", 4));
    glb.insert(glb.end(), binary_.begin(), binary_.end());
  }
  return glb;
}

}  // namespace sunder::gltf
