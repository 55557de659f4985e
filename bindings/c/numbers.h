#pragma once

#include <sunder/core/math.h>

#include <cstdint>

namespace sunder::c {

[[nodiscard]] inline Vec3d vector_of(const double numbers[3]) {
  return {numbers[0], numbers[1], numbers[2]};
}

/// The numbers of an array of vectors, back to back; null if there are none.
template <class Vectors>
[[nodiscard]] auto numbers_of(const Vectors& vectors) -> decltype(vectors.front().data()) {
  return vectors.empty() ? nullptr : vectors.front().data();
}

template <class Values>
[[nodiscard]] std::uint32_t count_of(const Values& values) {
  return static_cast<std::uint32_t>(values.size());
}

}  // namespace sunder::c
