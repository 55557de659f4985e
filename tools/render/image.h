#pragma once

#include <sunder/core/math.h>
#include <sunder/core/status.h>

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace sunder::tools {

/// Pixels of 8 bits per channel, sRGB with straight alpha, row by row from the top.
struct Image {
  int width = 0, height = 0;
  std::vector<std::uint8_t> rgba;
};

/// Reads a PNG or a JPEG, which is recognised by its first bytes.
/// @return unsupported_format: another kind of file; malformed_file; limit_exceeded: more than
///         2^26 pixels.
[[nodiscard]] Result<Image> decode_image(std::span<const std::byte> file);

}  // namespace sunder::tools
