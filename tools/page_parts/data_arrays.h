#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <type_traits>
#include <vector>

#include "tools/messages/json.h"

namespace sunder::tools {

/// The arrays behind the JSON of a page's data, each at a multiple of four bytes, of eight for
/// doubles.
class DataArrays {
 public:
  /// Appends an array. @return what the JSON says of it: type, first byte, number of elements.
  template <class T>
  Json add(const std::vector<T>& values) {
    static_assert(std::endian::native == std::endian::little);
    static_assert(std::is_arithmetic_v<T>);
    const std::size_t unit = sizeof(T) > 4 ? 8 : 4;
    bytes_.resize((bytes_.size() + unit - 1) / unit * unit);
    const std::size_t first = bytes_.size();
    bytes_.resize(first + values.size() * sizeof(T));
    if (!values.empty()) std::memcpy(&bytes_[first], values.data(), values.size() * sizeof(T));
    return {{"type", type_name<T>()}, {"first", first}, {"count", values.size()}};
  }

  [[nodiscard]] std::span<const std::byte> bytes() const { return bytes_; }

 private:
  template <class T>
  static const char* type_name() {
    if constexpr (std::is_same_v<T, double>) return "f64";
    if constexpr (std::is_same_v<T, float>) return "f32";
    if constexpr (std::is_same_v<T, std::uint32_t>) return "u32";
    if constexpr (std::is_same_v<T, std::uint16_t>) return "u16";
    if constexpr (std::is_same_v<T, std::int16_t>) return "i16";
    if constexpr (std::is_same_v<T, std::uint8_t>) return "u8";
  }

  std::vector<std::byte> bytes_;
};

}  // namespace sunder::tools
