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

/// Limit for the pixels of all images of a model together: 256 MiB when decoded.
inline constexpr std::uint64_t kMostImagePixels = std::uint64_t{1} << 26;

/// Reads a PNG or a JPEG, which is recognised by its first bytes. Its size is known before memory
/// is taken for its pixels: 4 bytes each.
/// @param begun  optional: gets the number of pixels for which memory and time were taken, also if
///               the file turns out to be malformed.
/// @return unsupported_format: another kind of file; malformed_file; limit_exceeded: more pixels.
[[nodiscard]] Result<Image> decode_image(std::span<const std::byte> file,
                                         std::uint64_t most_pixels = kMostImagePixels,
                                         std::uint64_t* begun = nullptr);

}  // namespace sunder::tools
