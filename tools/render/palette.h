#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "tools/render/png_file.h"

namespace sunder::tools {

/// At most 256 colours that stand for those of all pictures: boxes of colours are cut in two until
/// there are enough [heckbert1982color].
class Palette {
 public:
  explicit Palette(std::span<const Picture> pictures);

  [[nodiscard]] const std::vector<Picture::Color>& colors() const { return colors_; }
  /// The index of the colour for one of the pictures' colours.
  [[nodiscard]] std::uint8_t at(const Picture::Color& color) const;

 private:
  std::vector<Picture::Color> colors_;
  std::vector<std::uint8_t> of_cell_;  ///< Per cell of colours.
};

}  // namespace sunder::tools
