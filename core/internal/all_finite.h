#pragma once

#include <array>
#include <cstddef>
#include <vector>

namespace sunder {

/// Whether no number is infinite or NaN: one addition and one multiplication per number.
[[nodiscard]] inline bool all_finite(const float* numbers, std::size_t count) {
  constexpr std::size_t kLanes = 8;  // independent sums, which the processor adds side by side
  std::array<float, kLanes> zeros{};
  std::size_t i = 0;
  for (; i + kLanes <= count; i += kLanes)
    for (std::size_t lane = 0; lane < kLanes; ++lane) zeros[lane] += 0.0f * numbers[i + lane];
  for (; i < count; ++i) zeros[0] += 0.0f * numbers[i];
  float sum = 0.0f;  // Zero times infinity is NaN, and so is every sum with a NaN.
  for (const float zero : zeros) sum += zero;
  return sum == 0.0f;
}

/// The same for vectors that are stored without gaps.
template <class Vector>
[[nodiscard]] bool all_finite(const std::vector<Vector>& values) {
  static_assert(sizeof(Vector) == Vector::SizeAtCompileTime * sizeof(float));
  return values.empty() ||
         all_finite(values.data()->data(), values.size() * Vector::SizeAtCompileTime);
}

[[nodiscard]] inline bool all_finite(const std::vector<float>& values) {
  return all_finite(values.data(), values.size());
}

}  // namespace sunder
