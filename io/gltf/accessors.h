#pragma once

#include <optional>
#include <span>
#include <vector>

#include "io/gltf/source_document.h"

namespace sunder::gltf {

enum class ComponentType : std::uint16_t {
  i8 = 5120,
  u8 = 5121,
  i16 = 5122,
  u16 = 5123,
  u32 = 5125,
  f32 = 5126
};

/// A typed view into the buffers; all its elements are checked to lie inside them.
struct Accessor {
  std::uint32_t index = 0;  ///< In /accessors.
  ComponentType component_type = ComponentType::f32;
  std::uint32_t components = 1;  ///< Numbers per element; 4, 9, 16 for matrices.
  bool is_matrix = false;
  bool normalized = false;
  std::uint32_t count = 0;
  /// First element; null: all elements are zero except the sparse ones.
  const std::byte* data = nullptr;
  std::size_t stride = 0;
  std::uint32_t sparse_count = 0;
  ComponentType sparse_index_type = ComponentType::u32;
  const std::byte* sparse_indices = nullptr;
  const std::byte* sparse_values = nullptr;

  [[nodiscard]] bool is_integer() const { return component_type != ComponentType::f32; }
};

/// Opens and decodes accessors. The bytes of all decoded arrays, and of what is made of them, share
/// one limit, so that a small file with a million instances ends with limit_exceeded instead of
/// exhausting the memory.
class AccessorReader {
 public:
  explicit AccessorReader(const SourceDocument& document);

  [[nodiscard]] Accessor open(const Cursor& reference);

  /// Decodes to floats: normalised integers to [-1, 1] or [0, 1], others by value. `out` has count
  /// x components entries.
  void read_floats(const Accessor& accessor, std::span<float> out) const;
  [[nodiscard]] std::vector<float> read_floats(const Accessor& accessor);
  /// Unsigned integers without conversion; refuses other component types.
  [[nodiscard]] std::vector<std::uint32_t> read_unsigned(const Accessor& accessor);

  /// Subtracts from the limit what reading another part of the file will take.
  /// @param place  names that part in the refusal.
  void charge(std::uint64_t bytes, const std::string& place);

  /// Elements that are vectors of two to four floats.
  template <class Vector>
  [[nodiscard]] std::vector<Vector> read_vectors(const Accessor& accessor) {
    charge(accessor);
    std::vector<Vector> vectors(accessor.count);
    read_floats(accessor, {vectors.data()->data(), vectors.size() * Vector::RowsAtCompileTime});
    return vectors;
  }

  /// Position `i` of those that a sparse accessor replaces; not checked. `i` < sparse_count.
  [[nodiscard]] static std::uint32_t sparse_index(const Accessor& accessor, std::uint32_t i);

  [[nodiscard]] std::string place(const Accessor& accessor) const {
    return "/accessors/" + std::to_string(accessor.index);
  }

 private:
  [[nodiscard]] Accessor open_new(std::uint32_t index) const;
  void charge(const Accessor& accessor);

  const SourceDocument& document_;
  std::vector<std::optional<Accessor>> opened_;  ///< By index: many channels share key times.
  std::uint64_t file_bytes_ = 0;
  std::uint64_t bytes_left_ = 0;
};

}  // namespace sunder::gltf
