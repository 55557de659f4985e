#pragma once

#include <cstddef>
#include <vector>

namespace sunder::particles {

/// The memory that a vector keeps beside itself, in bytes.
template <class T>
[[nodiscard]] std::size_t bytes_of(const std::vector<T>& values) {
  return values.capacity() * sizeof(T);
}
template <class T>
[[nodiscard]] std::size_t bytes_of(const std::vector<std::vector<T>>& lists) {
  std::size_t bytes = lists.capacity() * sizeof(std::vector<T>);
  for (const std::vector<T>& list : lists) bytes += bytes_of(list);
  return bytes;
}

}  // namespace sunder::particles
