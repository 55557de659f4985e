#pragma once

#include <sunder/tear/torn_model.h>

namespace sunder::particles {

using tear::Index;
using tear::Surface;

/// The borders of the surface as it would be without the walls and caps that close it.
class LipBorder {
 public:
  explicit LipBorder(const TornModel& model) : surface_(model.surface()) {}

  /// Whether a half-edge has the surface on its own side alone.
  [[nodiscard]] bool has(Index half_edge) const {
    if (is_filling(half_edge / 3)) return false;
    const Index twin = surface_.twin[half_edge];
    return twin == kNone || is_filling(twin / 3);
  }
  /// The half-edge of the border that leaves a point, or arrives there; kNone where there is none.
  [[nodiscard]] Index leaving(Index point) const;
  [[nodiscard]] Index arriving(Index point) const;
  /// The points there.
  [[nodiscard]] Index next(Index point) const {
    const Index half_edge = leaving(point);
    return half_edge == kNone ? kNone : surface_.corner_point[Surface::next(half_edge)];
  }
  [[nodiscard]] Index previous(Index point) const {
    const Index half_edge = arriving(point);
    return half_edge == kNone ? kNone : surface_.corner_point[half_edge];
  }

 private:
  /// Whether a triangle is part of a wall or cap.
  [[nodiscard]] bool is_filling(Index triangle) const {
    if (triangle < surface_.first_triangle.back()) return false;
    const tear::TriangleRef& ref = surface_.appended[triangle - surface_.first_triangle.back()];
    return ref.source_triangle >= surface_.first_triangle[ref.mesh + 1] - surface_.first_triangle[ref.mesh];
  }

  const Surface& surface_;
};

}  // namespace sunder::particles
