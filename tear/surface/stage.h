#pragma once

#include "tear/surface/edit_columns.h"

namespace sunder::tear {

/// Stores, for each triangle appended since the stage began, its ancestor: the triangle from which
/// it was split that existed when the stage began.
class Stage {
 public:
  explicit Stage(EditColumns& columns) : columns_(columns) { begin(); }

  /// Begins a new stage.
  void begin() {
    first_triangle_ = columns_.surface.triangle_count();
    columns_.ancestors.clear();
  }
  [[nodiscard]] Index ancestor(Index triangle) const {
    return triangle < first_triangle_ ? triangle : columns_.ancestors[triangle - first_triangle_];
  }
  /// The first triangle that was appended since the stage began.
  [[nodiscard]] Index first_triangle() const { return first_triangle_; }
  /// To be called after triangles from `triangle_count` on were removed.
  void roll_back(Index triangle_count) {
    first_triangle_ = std::min(first_triangle_, triangle_count);
  }

 private:
  EditColumns& columns_;
  Index first_triangle_ = 0;
};

}  // namespace sunder::tear
