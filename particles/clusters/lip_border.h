#pragma once

#include <sunder/core/index.h>
#include <sunder/tear/torn_model.h>

#include "tear/internal/surface.h"

namespace sunder::particles {
using tear::Surface;

/// Whether a triangle is part of a wall or cap.
[[nodiscard]] inline bool is_filling(const Surface& surface, Index triangle) {
  if (triangle < surface.first_triangle.back()) return false;
  const tear::TriangleRef& ref = surface.appended[triangle - surface.first_triangle.back()];
  return ref.source_triangle >=
         surface.first_triangle[ref.mesh + 1] - surface.first_triangle[ref.mesh];
}

/// The borders of the surface without the walls and caps that close it.
class LipBorder {
 public:
  explicit LipBorder(const TornModel& model) : surface_(model.surface()) {}

  /// Whether a half-edge is a border: it has a face on its own side only.
  [[nodiscard]] bool has(Index half_edge) const {
    if (is_filling(surface_, half_edge / 3)) return false;
    const Index twin = surface_.twin[half_edge];
    return twin == kNone || is_filling(surface_, twin / 3);
  }
  /// The border half-edge that leaves a point, or that arrives at it; kNone if there is none.
  [[nodiscard]] Index leaving(Index point) const {
    return find(point, [](Index corner) { return corner; });
  }
  [[nodiscard]] Index arriving(Index point) const { return find(point, Surface::previous); }
  /// The next and the previous point on the border.
  [[nodiscard]] Index next(Index point) const {
    const Index half_edge = leaving(point);
    return half_edge == kNone ? kNone : surface_.corner_point[Surface::next(half_edge)];
  }
  [[nodiscard]] Index previous(Index point) const {
    const Index half_edge = arriving(point);
    return half_edge == kNone ? kNone : surface_.corner_point[half_edge];
  }

 private:
  /// The first border half-edge among those of a point's corners.
  template <class HalfEdgeOf>
  [[nodiscard]] Index find(Index point, HalfEdgeOf half_edge_of) const {
    const Index start = surface_.point_corner[point];
    if (start == kNone) return kNone;
    const Index first = surface_.first_of_fan(start);
    Index corner = first;
    do {
      if (has(half_edge_of(corner))) return half_edge_of(corner);
      corner = surface_.rotate_ccw(corner);
    } while (corner != kNone && corner != first);
    return kNone;
  }

  const Surface& surface_;
};

}  // namespace sunder::particles
