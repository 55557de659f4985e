#pragma once

#include <cstddef>
#include <span>
#include <string>

namespace sunder::tools {

/// RFC 4648, with padding.
[[nodiscard]] std::string base64(std::span<const std::byte> bytes);

}  // namespace sunder::tools
