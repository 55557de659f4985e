#pragma once

#include <cstdint>

namespace sunder {

/// Some elements of a buffer, from `first` on.
struct Range {
  std::uint32_t first = 0, count = 0;

  bool operator==(const Range&) const = default;
};

}  // namespace sunder
