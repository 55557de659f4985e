#include "io/gltf/container.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <string>
#include <vector>

#include "io/gltf/refusal.h"

namespace sunder::gltf {
namespace {

constexpr std::size_t kHeaderBytes = 12, kChunkHeaderBytes = 8;
constexpr std::uint32_t kJsonChunk = 0x4E4F534A, kBinaryChunk = 0x004E4942;
constexpr std::size_t kMaximumNesting = 256;
// The JSON object keeps the order of its members and searches them linearly, so without a limit a
// hostile object takes quadratic time.
constexpr std::size_t kMaximumMembers = 10'000;

std::uint32_t read_u32(std::span<const std::byte> bytes, std::size_t offset) {
  std::array<unsigned char, 4> b{};
  std::memcpy(b.data(), bytes.data() + offset, 4);
  return b[0] | static_cast<std::uint32_t>(b[1]) << 8 | static_cast<std::uint32_t>(b[2]) << 16 |
         static_cast<std::uint32_t>(b[3]) << 24;
}

Container split_glb(std::span<const std::byte> content) {
  if (content.size() < kHeaderBytes)
    refuse(StatusCode::malformed_file, kNone, "GLB: %zu bytes are too few for a header",
           content.size());
  if (const std::uint32_t version = read_u32(content, 4); version != 2)
    refuse(StatusCode::unsupported_format, kNone, "GLB: version %u is not supported; expected 2",
           version);
  const std::size_t claimed = read_u32(content, 8);
  if (claimed > content.size())
    refuse(StatusCode::malformed_file, kNone,
           "GLB: the header declares %zu bytes, the file has %zu", claimed, content.size());

  Container container{true, {}, {}};
  bool has_json = false;
  for (std::size_t offset = kHeaderBytes, chunk = 0;
       claimed >= offset && claimed - offset >= kChunkHeaderBytes; ++chunk) {
    const std::size_t length = read_u32(content, offset);
    const std::uint32_t type = read_u32(content, offset + 4);
    offset += kChunkHeaderBytes;
    if (length > claimed - offset)
      refuse(StatusCode::malformed_file, kNone,
             "GLB: chunk %zu at byte %zu declares %zu bytes, %zu are left", chunk,
             offset - kChunkHeaderBytes, length, claimed - offset);
    const auto data = content.subspan(offset, length);
    if (chunk == 0 && type == kJsonChunk) {
      container.json = {reinterpret_cast<const char*>(data.data()), data.size()};
      has_json = true;
    } else if (chunk == 1 && type == kBinaryChunk) {
      container.binary = data;
    }
    offset += std::min((length + 3) / 4 * 4, claimed - offset);
  }
  if (!has_json) refuse(StatusCode::malformed_file, kNone, "GLB: the first chunk is not JSON");
  return container;
}

// Bytes that a value and an object or array take when they are parsed, lists growing by doubling.
constexpr std::uint64_t kValueMemory = 32, kContainerMemory = 80;

void check_nesting(std::string_view text, std::uint64_t maximum_memory) {
  std::uint64_t memory = text.size();
  std::vector<std::size_t>
      members;  // One entry per open array or object. Arrays are counted too, but not limited.
  std::vector<bool> is_object;
  bool in_string = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (in_string) {
      if (c == '\\')
        ++i;
      else if (c == '"')
        in_string = false;
      continue;
    }
    memory += c == ',' ? kValueMemory : c == '{' || c == '[' ? kContainerMemory : 0;
    if (memory > maximum_memory)
      refuse(StatusCode::limit_exceeded, kNone,
             "JSON: parsed, it exceeds %llu bytes (LoadOptions::maximum_memory)",
             static_cast<unsigned long long>(maximum_memory));
    if (c == '"') {
      in_string = true;
    } else if (c == '{' || c == '[') {
      if (members.size() == kMaximumNesting)
        refuse(StatusCode::limit_exceeded, kNone, "JSON: nested deeper than %zu levels at byte %zu",
               kMaximumNesting, i);
      members.push_back(1);
      is_object.push_back(c == '{');
    } else if (c == '}' || c == ']') {
      if (members.empty()) return;  // The parser reports the fault.
      members.pop_back();
      is_object.pop_back();
    } else if (c == ',' && !members.empty() && ++members.back() > kMaximumMembers &&
               is_object.back()) {
      refuse(StatusCode::limit_exceeded, kNone,
             "JSON: an object of more than %zu members at byte %zu", kMaximumMembers, i);
    }
  }
}

bool is_compression(std::string_view extension) {
  return extension == "KHR_draco_mesh_compression" || extension == "EXT_meshopt_compression" ||
         extension == "KHR_meshopt_compression";
}

bool can_decompress(std::string_view extension, const Decoders& decoders) {
  return extension == "KHR_draco_mesh_compression" ? decoders.draco_primitives != nullptr
                                                   : decoders.meshopt_views != nullptr;
}

/// Whether a file that requires this extension can be read: those that io/gltf supports, and those
/// that do not change geometry, skins or animation.
bool can_read(std::string_view extension) {
  constexpr std::array<std::string_view, 17> kHarmless = {
      "KHR_materials_",        "EXT_materials_",    "ADOBE_materials_",
      "KHR_texture_",          "EXT_texture_",      "MSFT_texture_",
      "GOOGLE_texture_",       "MSFT_packing_",     "KHR_technique",
      "KHR_lights_",           "EXT_lights_",       "KHR_xmp",
      "FB_ngon_encoding",      "EXT_mesh_features", "EXT_structural_metadata",
      "EXT_instance_features", "MSFT_lod"};
  const auto has_prefix = [&](std::string_view prefix) { return extension.starts_with(prefix); };
  return extension == "KHR_mesh_quantization" || is_compression(extension) ||
         std::any_of(kHarmless.begin(), kHarmless.end(), has_prefix);
}

void check_version(const Cursor& document) {
  const Cursor asset = document.member("asset");
  const std::string& version = asset.member("version").to_string();
  if (version.substr(0, 2) != "2.")
    refuse(StatusCode::unsupported_format, kNone,
           "/asset/version: glTF %.20s is not supported; expected 2.x", version.c_str());
  if (const auto minimum = asset.find("minVersion"); minimum && minimum->to_string() != "2.0")
    refuse(StatusCode::unsupported_format, kNone,
           "/asset/minVersion: %.20s is not supported; expected 2.0", minimum->to_string().c_str());
}

void check_required_extensions(const Cursor& document) {
  const auto required = document.find("extensionsRequired");
  if (!required) return;
  for (std::size_t i = 0; i < required->size(); ++i) {
    const Cursor extension = required->element(i);
    if (!can_read(extension.to_string()))
      refuse(StatusCode::unsupported_feature, static_cast<std::uint32_t>(i),
             "%s: the required extension %.100s is not supported", extension.pointer().c_str(),
             extension.to_string().c_str());
  }
}

/// Also a compression that the file only uses: its data may have no other form.
void check_compression(const Cursor& document, const Decoders& decoders) {
  if (decoders.draco_primitives != nullptr && decoders.meshopt_views != nullptr) return;
  const auto used = document.find("extensionsUsed");
  if (!used) return;
  for (std::size_t i = 0; i < used->size(); ++i) {
    const Cursor extension = used->element(i);
    if (is_compression(extension.to_string()) && !can_decompress(extension.to_string(), decoders))
      refuse(StatusCode::unsupported_feature, static_cast<std::uint32_t>(i),
             "%s: this build does not decode %s", extension.pointer().c_str(),
             extension.to_string().c_str());
  }
}

Json parse_json(std::string_view text, std::uint64_t maximum_memory, const Decoders& decoders) {
  // simdjson keeps a copy of the text and up to eight bytes per character, before a value is read.
  constexpr std::uint64_t kParserMemory = 10;
  if (text.size() > maximum_memory / kParserMemory)
    refuse(StatusCode::limit_exceeded, kNone,
           "JSON: parsing its %zu bytes exceeds %llu bytes (LoadOptions::maximum_memory)",
           text.size(), static_cast<unsigned long long>(maximum_memory));
  // Its memory and that of the document are needed at once; of small files, the document may take
  // what there is at least.
  constexpr std::uint64_t kSmall = std::uint64_t{48} << 20;
  const std::uint64_t memory = std::max(maximum_memory / 2, std::min(maximum_memory, kSmall));
  const JsonLimits limits = {kMaximumNesting, kMaximumMembers, memory};
  if (decoders.json != nullptr)
    if (auto document = decoders.json(text, limits)) return *std::move(document);
  check_nesting(text, memory);
  try {
    return Json::parse(text.begin(), text.end());
  } catch (const nlohmann::json::exception& error) {
    refuse(StatusCode::malformed_file, kNone, "JSON: %.200s", error.what());
  }
}

}  // namespace

bool has_glb_magic(std::span<const std::byte> content) {
  return content.size() >= 4 && std::memcmp(content.data(), "glTF", 4) == 0;
}

Container split_container(std::span<const std::byte> content) {
  if (content.empty()) refuse(StatusCode::malformed_file, kNone, "the file is empty");
  if (has_glb_magic(content)) return split_glb(content);
  std::string_view text{reinterpret_cast<const char*>(content.data()), content.size()};
  if (text.substr(0, 3) == "\xEF\xBB\xBF") text.remove_prefix(3);
  const std::size_t start = text.find_first_not_of(" \t\r\n");
  if (start == std::string_view::npos || text[start] != '{')
    refuse(StatusCode::unsupported_format, kNone,
           "neither a GLB (no 'glTF' at the start) nor a JSON object");
  return {false, text, {}};
}

bool is_container_sound(std::span<const std::byte> glb) {
  if (read_u32(glb, 8) != glb.size() || glb.size() % 4 != 0) return false;
  std::size_t offset = kHeaderBytes, chunk = 0;
  for (; offset < glb.size(); ++chunk) {
    if (glb.size() - offset < kChunkHeaderBytes) return false;
    const std::size_t length = read_u32(glb, offset);
    const std::uint32_t type = read_u32(glb, offset + 4);
    const bool is_expected = chunk == 0   ? type == kJsonChunk
                             : chunk == 1 ? type == kBinaryChunk || type != kJsonChunk
                                          : type != kJsonChunk && type != kBinaryChunk;
    offset += kChunkHeaderBytes;
    if (!is_expected || length == 0 || length % 4 != 0 || length > glb.size() - offset)
      return false;
    offset += length;
  }
  return chunk > 0 && std::to_integer<char>(glb[kHeaderBytes + kChunkHeaderBytes]) == '{';
}

Json parse_document(std::string_view text, std::uint64_t maximum_memory, const Decoders& decoders) {
  Json document = parse_json(text, maximum_memory, decoders);
  const Cursor root(document, "");
  check_version(root);
  check_required_extensions(root);
  check_compression(root, decoders);
  return document;
}

}  // namespace sunder::gltf
