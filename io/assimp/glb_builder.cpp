#include "io/assimp/glb_builder.h"

#include <algorithm>
#include <bit>
#include <cstring>
#include <string>
#include <utility>

#include "io/assimp/failure.h"

namespace sunder::assimp_import {
namespace {

static_assert(std::endian::native == std::endian::little, "glTF buffers are little-endian");

// Component types: unsigned ones, and float.
constexpr int kByte = 5121, kShort = 5123, kInt = 5125, kFloat = 5126;
constexpr int kArrayBuffer = 34962, kElementArrayBuffer = 34963;

const char* vector_type(int components) {
  static constexpr const char* kTypes[] = {"SCALAR", "VEC2", "VEC3", "VEC4"};
  return kTypes[components - 1];
}

void append_chunk(std::vector<std::byte>& glb, std::uint32_t type,
                  std::span<const std::byte> content, std::byte padding) {
  const std::size_t padded = (content.size() + 3) / 4 * 4;
  const std::uint32_t head[2] = {static_cast<std::uint32_t>(padded), type};
  const auto head_bytes = std::as_bytes(std::span(head));
  glb.insert(glb.end(), head_bytes.begin(), head_bytes.end());
  glb.insert(glb.end(), content.begin(), content.end());
  glb.insert(glb.end(), padded - content.size(), padding);
}

}  // namespace

std::uint32_t GlbBuilder::append(const char* list, Json value) {
  Json& array = document[list];
  array.push_back(std::move(value));
  return static_cast<std::uint32_t>(array.size() - 1);
}

std::uint32_t GlbBuilder::add_bytes(std::span<const std::byte> bytes, int target) {
  binary_.resize((binary_.size() + 3) / 4 * 4);
  const std::size_t offset = binary_.size();
  // Chunk lengths have 32 bits; a quarter of a GiB is reserved for the JSON.
  const std::uint64_t most = std::min<std::uint64_t>(maximum_bytes_, 0xF000'0000u);
  if (bytes.size() > most - std::min<std::uint64_t>(most, offset))
    throw ImportFailure{Status::failure(StatusCode::limit_exceeded, kNone,
                                        "the imported model is larger than %llu bytes",
                                        static_cast<unsigned long long>(most))};
  binary_.insert(binary_.end(), bytes.begin(), bytes.end());
  Json view = {{"buffer", 0}, {"byteOffset", offset}, {"byteLength", bytes.size()}};
  if (target != 0) view["target"] = target;
  return append("bufferViews", std::move(view));
}

std::uint32_t GlbBuilder::add_accessor(std::span<const std::byte> bytes, int target,
                                       int component_type, const char* type, std::size_t count) {
  const std::uint32_t view = add_bytes(bytes, target);
  return append(
      "accessors",
      {{"bufferView", view}, {"componentType", component_type}, {"count", count}, {"type", type}});
}

std::uint32_t GlbBuilder::add_floats(std::span<const float> values, int components, Use use,
                                     bool with_bounds) {
  const auto width = static_cast<std::size_t>(components);
  const std::uint32_t accessor =
      add_accessor(std::as_bytes(values), use == Use::vertex_attribute ? kArrayBuffer : 0, kFloat,
                   vector_type(components), values.size() / width);
  if (with_bounds) {
    std::vector<float> least(values.begin(), values.begin() + components), most = least;
    for (std::size_t i = 0; i < values.size(); ++i) {
      least[i % width] = std::min(least[i % width], values[i]);
      most[i % width] = std::max(most[i % width], values[i]);
    }
    document["accessors"][accessor]["min"] = least;
    document["accessors"][accessor]["max"] = most;
  }
  return accessor;
}

std::uint32_t GlbBuilder::add_matrices(std::span<const Mat4f> matrices) {
  return add_accessor(std::as_bytes(matrices), 0, kFloat, "MAT4", matrices.size());
}

std::uint32_t GlbBuilder::add_indices(std::span<const std::uint32_t> indices) {
  // Index 65535 is not available: it restarts a strip.
  if (indices.empty() || *std::max_element(indices.begin(), indices.end()) >= 0xFFFF)
    return add_accessor(std::as_bytes(indices), kElementArrayBuffer, kInt, "SCALAR",
                        indices.size());
  std::vector<std::uint16_t> narrow;
  narrow.reserve(indices.size());
  for (const std::uint32_t index : indices) narrow.push_back(static_cast<std::uint16_t>(index));
  return add_accessor(std::as_bytes(std::span(narrow)), kElementArrayBuffer, kShort, "SCALAR",
                      narrow.size());
}

std::uint32_t GlbBuilder::add_joints(std::span<const std::uint16_t> joints,
                                     std::size_t joint_count) {
  if (joint_count > 256)
    return add_accessor(std::as_bytes(joints), kArrayBuffer, kShort, "VEC4", joints.size() / 4);
  std::vector<std::uint8_t> narrow;
  narrow.reserve(joints.size());
  for (const std::uint16_t joint : joints) narrow.push_back(static_cast<std::uint8_t>(joint));
  return add_accessor(std::as_bytes(std::span(narrow)), kArrayBuffer, kByte, "VEC4",
                      narrow.size() / 4);
}

std::vector<std::byte> GlbBuilder::finish() {
  if (!binary_.empty()) document["buffers"] = {{{"byteLength", binary_.size()}}};
  const std::string text = document.dump(-1, ' ', false, Json::error_handler_t::replace);

  std::vector<std::byte> glb;
  glb.reserve(text.size() + binary_.size() + 64);
  glb.resize(12);
  append_chunk(glb, 0x4E4F534A, std::as_bytes(std::span(text)), std::byte{' '});
  if (!binary_.empty()) append_chunk(glb, 0x004E4942, binary_, std::byte{0});
  if (glb.size() > std::min<std::uint64_t>(maximum_bytes_, 0xFFFF'FFFFu))
    throw ImportFailure{Status::failure(StatusCode::limit_exceeded, kNone,
                                        "the imported model is larger than the size limit")};
  const std::uint32_t head[3] = {0x46546C67, 2, static_cast<std::uint32_t>(glb.size())};
  std::memcpy(glb.data(), head, sizeof head);
  return glb;
}

}  // namespace sunder::assimp_import
