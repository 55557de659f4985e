#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <zlib.h>

namespace sunder::usd {

/// The CRC-32 of ZIP.
[[nodiscard]] inline std::uint32_t checksum(std::span<const std::byte> bytes) {
  return static_cast<std::uint32_t>(
      crc32_z(0, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size()));
}

}  // namespace sunder::usd
