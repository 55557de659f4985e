#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace sunder::scene {

/// Per byte: what it adds to a CRC-64/XZ.
inline constexpr std::array<std::uint64_t, 256> kChecksumOfByte = [] {
  constexpr std::uint64_t kPolynomial = 0xC96C5795D7870F42u;  // reflected
  std::array<std::uint64_t, 256> table{};
  for (std::uint64_t byte = 0; byte < 256; ++byte) {
    std::uint64_t rest = byte;
    for (int bit = 0; bit < 8; ++bit) rest = (rest >> 1u) ^ ((rest & 1u) != 0 ? kPolynomial : 0);
    table[byte] = rest;
  }
  return table;
}();

/// The CRC-64/XZ of bytes: the polynomial of ECMA-182 (1992), annex B, reflected, as in the format
/// .xz. It finds every change within 64 bits, and of other accidents all but one in 2^64; whoever
/// changes bytes on purpose computes it anew. O(bytes).
[[nodiscard]] inline std::uint64_t checksum_of(std::span<const std::byte> bytes) {
  std::uint64_t rest = ~std::uint64_t{0};
  for (const std::byte byte : bytes)
    rest = kChecksumOfByte[(rest ^ std::to_integer<std::uint64_t>(byte)) & 0xFFu] ^ (rest >> 8u);
  return ~rest;
}

}  // namespace sunder::scene
