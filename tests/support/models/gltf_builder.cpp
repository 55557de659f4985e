#include "support/models/gltf_builder.h"

#include <map>

#include "support/machine/temporary_folder.h"

namespace sunder::test {
namespace {

std::string base64(const std::vector<std::byte>& bytes) {
  constexpr char kDigits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t three = 0;
    for (std::size_t k = 0; k < 3; ++k)
      three =
          three << 8 | (i + k < bytes.size() ? std::to_integer<std::uint32_t>(bytes[i + k]) : 0u);
    for (std::size_t k = 0; k < 4; ++k)
      text += i + k <= bytes.size() ? kDigits[three >> (18 - 6 * k) & 63u] : '=';
  }
  return text;
}

void append_u32(std::vector<std::byte>& bytes, std::size_t value) {
  for (int shift = 0; shift < 32; shift += 8)
    bytes.push_back(static_cast<std::byte>(value >> shift & 0xFFu));
}

void append(std::vector<std::byte>& bytes, const void* data, std::size_t size) {
  const auto* const first = static_cast<const std::byte*>(data);
  bytes.insert(bytes.end(), first, first + size);
}

}  // namespace

GltfBuilder::GltfBuilder() : json({{"asset", {{"version", "2.0"}}}}) {
  json["bufferViews"] = Json::array();
  json["accessors"] = Json::array();
}

GltfBuilder GltfBuilder::from_glb(const std::vector<std::byte>& glb) {
  std::uint32_t length = 0;
  std::memcpy(&length, glb.data() + 12, sizeof length);
  GltfBuilder builder;
  const auto* const text = reinterpret_cast<const char*>(glb.data()) + 20;
  builder.json = Json::parse(text, text + length);
  builder.binary_.assign(glb.begin() + 28 + length, glb.end());
  builder.json.erase("buffers");
  return builder;
}

std::size_t GltfBuilder::add_view(const void* data, std::size_t size) {
  binary_.resize((binary_.size() + 3) / 4 * 4);
  json["bufferViews"].push_back(
      {{"buffer", 0}, {"byteOffset", binary_.size()}, {"byteLength", size}});
  append(binary_, data, size);
  return json["bufferViews"].size() - 1;
}

std::size_t GltfBuilder::add_accessor(const void* data, std::size_t size, std::size_t numbers,
                                      int component_type, const char* type, bool normalized) {
  const std::map<std::string, std::size_t> components = {
      {"SCALAR", 1}, {"VEC2", 2}, {"VEC3", 3}, {"VEC4", 4}, {"MAT4", 16}};
  Json accessor = {{"bufferView", add_view(data, size)},
                   {"componentType", component_type},
                   {"count", numbers / components.at(type)},
                   {"type", type}};
  if (normalized) accessor["normalized"] = true;
  json["accessors"].push_back(accessor);
  return json["accessors"].size() - 1;
}

Json GltfBuilder::with_buffer() const {
  Json document = json;
  if (!document.contains("buffers"))
    document["buffers"] = Json::array({{{"byteLength", binary_.size()}}});
  return document;
}

std::vector<std::byte> GltfBuilder::glb() const {
  std::string text = with_buffer().dump();
  text.resize((text.size() + 3) / 4 * 4, ' ');
  std::vector<std::byte> padded = binary_;
  padded.resize((padded.size() + 3) / 4 * 4);
  std::vector<std::byte> file;
  append(file, "glTF", 4);
  append_u32(file, 2);
  append_u32(file, 12 + 8 + text.size() + 8 + padded.size());
  append_u32(file, text.size());
  append(file, "JSON", 4);
  append(file, text.data(), text.size());
  append_u32(file, padded.size());
  append(file, "BIN\0", 4);
  append(file, padded.data(), padded.size());
  return file;
}

std::string GltfBuilder::text_with_uri(const std::string& uri) const {
  Json document = with_buffer();
  document["buffers"][0]["uri"] = uri;
  return document.dump();
}

std::string GltfBuilder::text() const {
  return text_with_uri("data:application/octet-stream;base64," + base64(binary_));
}

Result<LoadedCharacter> GltfBuilder::load(const LoadOptions& options) const {
  return load_bytes("built.glb", glb(), options);
}

GltfBuilder skinned_strip() {
  GltfBuilder builder;
  std::vector<float> positions, weights, normals, uvs;
  std::vector<std::uint8_t> joints;
  std::vector<std::uint16_t> indices;
  for (int i = 0; i < 10; ++i) {
    const float height = static_cast<float>(i / 2) * 0.5f;
    positions.insert(positions.end(), {static_cast<float>(i % 2), height, 0.0f});
    normals.insert(normals.end(), {0.0f, 0.0f, 1.0f});
    uvs.insert(uvs.end(), {static_cast<float>(i % 2), height * 0.5f});
    weights.insert(weights.end(), {1.0f - height * 0.5f, height * 0.5f, 0.0f, 0.0f});
    joints.insert(joints.end(), {0, 1, 0, 0});
  }
  for (std::uint16_t row = 0; row < 4; ++row) {
    const auto v = static_cast<std::uint16_t>(row * 2);
    for (const int offset : {0, 1, 2, 1, 3, 2})
      indices.push_back(static_cast<std::uint16_t>(v + offset));
  }
  const std::vector<float> binds = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0,  0, 1,
                                    1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, -1, 0, 1};
  Json attributes;
  attributes["POSITION"] = builder.add(positions, "VEC3");
  builder.json["accessors"].back()["min"] = {0, 0, 0};
  builder.json["accessors"].back()["max"] = {1, 2, 0};
  attributes["NORMAL"] = builder.add(normals, "VEC3");
  attributes["TEXCOORD_0"] = builder.add(uvs, "VEC2");
  attributes["JOINTS_0"] = builder.add(joints, "VEC4");
  attributes["WEIGHTS_0"] = builder.add(weights, "VEC4");
  const std::size_t index_accessor = builder.add(indices, "SCALAR");
  const std::size_t bind_accessor = builder.add(binds, "MAT4");
  builder.json["materials"] = {{{"name", "skin"}}, {{"name", "other"}}};
  builder.json["meshes"] = {
      {{"name", "strip"},
       {"primitives",
        {{{"attributes", attributes}, {"indices", index_accessor}, {"material", 0}}}}}};
  builder.json["skins"] = {{{"joints", {1, 2}}, {"inverseBindMatrices", bind_accessor}}};
  builder.json["nodes"] = {{{"name", "body"}, {"mesh", 0}, {"skin", 0}},
                           {{"name", "root"}, {"children", {2}}},
                           {{"name", "tip"}, {"translation", {0, 1, 0}}}};
  builder.json["scenes"] = {{{"nodes", {0, 1}}}};
  builder.json["scene"] = 0;
  return builder;
}

Json& strip_attributes(GltfBuilder& builder) {
  return builder.json["meshes"][0]["primitives"][0]["attributes"];
}

Result<LoadedCharacter> load_bytes(const std::string& name, const std::vector<std::byte>& bytes,
                                   const LoadOptions& options) {
  const TemporaryFolder folder;
  return load_character(folder.write(name, bytes), options);
}

Result<LoadedCharacter> load_text(const std::string& text, const LoadOptions& options) {
  const TemporaryFolder folder;
  return load_character(folder.write("built.gltf", text), options);
}

bool has_note(const LoadReport& report, LoadNote::Kind kind, const std::string& text) {
  for (const LoadNote& note : report.notes)
    if (note.kind == kind && note.text.find(text) != std::string::npos) return true;
  return false;
}

}  // namespace sunder::test
