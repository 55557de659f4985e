#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace sunder::scene {

/// Per number of bytes that follow, and per byte: what it adds to a CRC-64/XZ.
inline constexpr std::array<std::array<std::uint64_t, 256>, 8> kChecksumOfByte = [] {
  constexpr std::uint64_t kPolynomial = 0xC96C5795D7870F42u;  // reflected
  std::array<std::array<std::uint64_t, 256>, 8> tables{};
  for (std::uint64_t byte = 0; byte < 256; ++byte) {
    std::uint64_t rest = byte;
    for (auto& table : tables) {
      for (int bit = 0; bit < 8; ++bit) rest = (rest >> 1u) ^ ((rest & 1u) != 0 ? kPolynomial : 0);
      table[byte] = rest;
    }
  }
  return tables;
}();

/// The CRC-64/XZ of bytes: the polynomial of ECMA-182 (1992), annex B, reflected, as in the format
/// .xz. It finds every change within 64 bits, and of other accidents all but one in 2^64; whoever
/// changes bytes on purpose computes it anew. Eight bytes at a time, because each step waits for
/// the one before. O(bytes).
[[nodiscard]] inline std::uint64_t checksum_of(std::span<const std::byte> bytes) {
  std::uint64_t rest = ~std::uint64_t{0};
  for (; bytes.size() >= 8; bytes = bytes.subspan(8)) {
    for (unsigned i = 0; i < 8; ++i) rest ^= std::to_integer<std::uint64_t>(bytes[i]) << (8 * i);
    std::uint64_t next = 0;
    for (unsigned i = 0; i < 8; ++i) next ^= kChecksumOfByte[7 - i][(rest >> (8 * i)) & 0xFFu];
    rest = next;
  }
  for (const std::byte byte : bytes)
    rest = kChecksumOfByte[0][(rest ^ std::to_integer<std::uint64_t>(byte)) & 0xFFu] ^ (rest >> 8u);
  return ~rest;
}

}  // namespace sunder::scene
