#pragma once

#include <cstdint>

namespace sunder::skinning {

/// A number that is unique in this process. A buffer identifies by it what it was written from;
/// addresses may be reused.
[[nodiscard]] std::uint64_t new_identity();

}  // namespace sunder::skinning
