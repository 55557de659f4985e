#pragma once

#include <cstdint>

namespace sunder {

/// Index of a vertex, triangle, bone or other element of an array.
using Index = std::uint32_t;

/// Means "no such index" wherever the library uses a 32-bit index.
inline constexpr Index kNone = 0xFFFF'FFFFu;

/// `count` consecutive elements of a buffer, starting at `first`.
struct IndexRange {
  Index first = 0, count = 0;

  bool operator==(const IndexRange&) const = default;
};

}  // namespace sunder
