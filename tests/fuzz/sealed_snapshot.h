#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "scene/snapshot/checksum.h"

namespace sunder::fuzz {

/// Bytes of a snapshot with the checksum that they need, as whoever changes one on purpose makes
/// it.
inline std::vector<std::byte> sealed(std::vector<std::byte> snapshot) {
  constexpr std::size_t kChecksumAt = 8, kHeaderBytes = 16;
  if (snapshot.size() < kHeaderBytes) return snapshot;
  const auto checksum = scene::checksum_of(std::span(snapshot).subspan(kHeaderBytes));
  for (std::size_t i = 0; i < 8; ++i)
    snapshot[kChecksumAt + i] = static_cast<std::byte>(checksum >> (8 * i));
  return snapshot;
}

}  // namespace sunder::fuzz
