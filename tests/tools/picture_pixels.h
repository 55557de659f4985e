#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <vector>

namespace sunder::test {

/// The pixels of a PNG, row by row from the top.
struct Pixels {
  using Color = std::array<std::uint8_t, 3>;

  int width = 0, height = 0;
  std::vector<Color> colors;

  [[nodiscard]] const Color& at(int x, int y) const {
    return colors[static_cast<std::size_t>(y * width + x)];
  }
};

/// Reads a PNG of 8 bits per channel, RGB or RGBA, not interlaced; nothing if it is another file.
std::optional<Pixels> read_png(const std::filesystem::path& file);

/// A PNG of RGBA pixels, row by row from the top.
std::vector<std::byte> make_png(int width, int height,
                                const std::vector<std::array<std::uint8_t, 4>>& colors);

/// The box of all pixels for which `counts` is true; nothing if there is none.
struct PixelBox {
  int left = 0, top = 0, right = 0, bottom = 0;  ///< Inclusive.
  int count = 0;

  [[nodiscard]] int width() const { return right - left + 1; }
  [[nodiscard]] int height() const { return bottom - top + 1; }
};
std::optional<PixelBox> box_of(const Pixels& pixels,
                               const std::function<bool(const Pixels::Color&)>& counts);

/// Whether no channel differs by more than `tolerance`.
bool is_near(const Pixels::Color& a, const Pixels::Color& b, int tolerance);

}  // namespace sunder::test
