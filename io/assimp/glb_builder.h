#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <nlohmann/json.hpp>

#include "io/assimp/transform.h"

namespace sunder::assimp_import {

using Json = nlohmann::ordered_json;

/// A glTF document under construction: its JSON, which every converter changes directly, and one
/// binary buffer.
class GlbBuilder {
 public:
  /// Throws ImportFailure (limit_exceeded) if the buffer would exceed `maximum_bytes`.
  explicit GlbBuilder(std::uint64_t maximum_bytes) : maximum_bytes_(maximum_bytes) {}

  Json document;

  enum class Use { vertex_attribute, plain };

  /// Each function returns the index of the new accessor. `components` is 1 to 4: a scalar or a
  /// vector.
  std::uint32_t add_floats(std::span<const float> values, int components, Use use,
                           bool with_bounds = false);
  std::uint32_t add_matrices(std::span<const Mat4f> matrices);
  std::uint32_t add_indices(std::span<const std::uint32_t> indices);
  /// Four joints per vertex; bytes if `joint_count` allows.
  std::uint32_t add_joints(std::span<const std::uint16_t> joints, std::size_t joint_count);
  /// Returns the index of the new buffer view.
  std::uint32_t add_bytes(std::span<const std::byte> bytes, int target = 0);

  /// Appends `value` to the document's array `list` and returns its index there.
  std::uint32_t append(const char* list, Json value);

  /// The finished GLB: header, JSON chunk, BIN chunk.
  [[nodiscard]] std::vector<std::byte> finish();

 private:
  std::uint32_t add_accessor(std::span<const std::byte> bytes, int target, int component_type,
                             const char* type, std::size_t count);

  std::uint64_t maximum_bytes_;
  std::vector<std::byte> binary_;
};

}  // namespace sunder::assimp_import
