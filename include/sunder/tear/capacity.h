#pragma once

#include <cstdint>

namespace sunder {

/// What the operations on a model may append, counted over all that are done and not taken back. With a fixed capacity the memory
/// is there from the start: an operation that finds no room changes nothing and says so. A cut across n faces appends about 2 n
/// vertices and triangles.
struct TornCapacity {
  std::uint32_t vertices = 0;   ///< Each mesh gets room for so many.
  std::uint32_t triangles = 0;  ///< Likewise.
  std::uint32_t operations = 0;

  /// All zero: the model grows as needed, and an operation allocates where it has to grow.
  [[nodiscard]] constexpr bool is_fixed() const { return vertices > 0 || triangles > 0 || operations > 0; }

  bool operator==(const TornCapacity&) const = default;
};

}  // namespace sunder
