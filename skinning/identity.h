#pragma once

#include <cstdint>

namespace sunder::skinning {

/// A number that no other object of this process has. A buffer remembers by it what it was written
/// from: addresses come back.
[[nodiscard]] std::uint64_t new_identity();

}  // namespace sunder::skinning
