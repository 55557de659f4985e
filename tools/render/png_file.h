#pragma once

#include <sunder/core/status.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <vector>

#include "tools/render/image.h"

namespace sunder::tools {

/// Pixels of 8 bits per channel, sRGB, row by row from the top.
struct Picture {
  using Color = std::array<std::uint8_t, 3>;

  int width = 0, height = 0;
  std::vector<Color> colors;
};

/// Writes a PNG; the whole file or nothing.
[[nodiscard]] Status write_png(const std::filesystem::path& file, const Picture& picture);

/// The bytes of a PNG with the pixels of an image; without alpha if all of them are opaque.
[[nodiscard]] std::vector<std::byte> encode_png(const Image& image);

/// Writes pictures of one size as an animated PNG of 256 colours that runs for ever; programs that
/// do not animate it show the first one. Each picture stores only the box that differs from the
/// one before.
/// @param milliseconds  per picture.
[[nodiscard]] Status write_animated_png(const std::filesystem::path& file,
                                        const std::vector<Picture>& pictures, int milliseconds);

}  // namespace sunder::tools
