#pragma once

#include <cstdint>

namespace sunder {

/// Index of a vertex, triangle, bone or other element of an array.
using Index = std::uint32_t;

/// "No such index" in every 32-bit index of the library.
inline constexpr Index kNone = 0xFFFF'FFFFu;

/// `count` successive elements of a buffer, from `first` on.
struct IndexRange {
  Index first = 0, count = 0;

  bool operator==(const IndexRange&) const = default;
};

}  // namespace sunder
