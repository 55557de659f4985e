#pragma once

#include <sunder/core/mesh.h>

#include <bit>
#include <cstdint>
#include <vector>

namespace sunder {

/// FNV-1a (Fowler, Noll, Vo) over 32-bit words instead of bytes, so that the result does not depend
/// on byte order.
class Digest {
 public:
  void add(std::uint32_t word) { value_ = (value_ ^ word) * 0x100000001B3u; }
  void add(float value) { add(std::bit_cast<std::uint32_t>(value)); }
  void add(std::uint64_t word) {
    add(static_cast<std::uint32_t>(word));
    add(static_cast<std::uint32_t>(word >> 32));
  }
  void add(double value) { add(std::bit_cast<std::uint64_t>(value)); }
  template <int N>
  void add(const Eigen::Matrix<float, N, 1, Eigen::DontAlign>& vector) {
    for (int i = 0; i < N; ++i) add(vector[i]);
  }
  void add(const Triangle& triangle) {
    for (const std::uint32_t vertex : triangle) add(vertex);
  }
  void add(const Influence& influence) {
    add(influence.slot);
    add(influence.weight);
  }
  template <class T>
  void add(const std::vector<T>& values) {
    add(static_cast<std::uint32_t>(values.size()));
    for (const T& value : values) add(value);
  }
  [[nodiscard]] std::uint64_t value() const { return value_; }

 private:
  std::uint64_t value_ = 0xCBF29CE484222325u;
};

}  // namespace sunder
