#pragma once

#include <string>
#include <vector>

#include "tools/picture/marks.h"

namespace sunder::tools {

/// Texts in a picture, drawn with strokes: A-Z, digits and some signs; small letters as capitals,
/// others as boxes.
class Labels {
 public:
  explicit Labels(Marks& marks) : marks_(marks) {}

  /// Draws a text beside a pixel, on a light ground, if that is inside the picture and covers no
  /// earlier one. @return whether it was drawn.
  bool place_beside(const Vec2d& pixel, const std::string& text, const Vec4f& color);

 private:
  struct Box {
    Vec2d least, greatest;
  };

  Marks& marks_;
  std::vector<Box> taken_;
};

}  // namespace sunder::tools
