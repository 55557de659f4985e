#pragma once

#include <array>
#include <span>

#include "tear/internal/surface.h"
#include "tear/surface/scratch_memory.h"

namespace sunder::tear {

/// A triangle of a cap, by the numbers of its points.
using FlatTriangle = std::array<Index, 3>;

/// The border around a region of a section, which a cap closes.
struct CapRim {
  explicit CapRim(ScratchMemory& scratch) : half_edges(&scratch) {}

  ScratchVector<Index> half_edges;  ///< Of all its loops, as triangulate() numbers their points.
  std::span<const Vec2d> places;    ///< Of those points.

  [[nodiscard]] Index size() const { return static_cast<Index>(half_edges.size()); }
  /// The point at which the cap's edge along a border half-edge begins, which is where the
  /// half-edge ends.
  [[nodiscard]] static Index point_before(Index half_edge, const Surface& surface) {
    return surface.corner_point[Surface::next(half_edge)];
  }
  /// Whether two points, by their numbers, are joined by an edge other than the rim's: a fold or a
  /// face in the plane, or a border elsewhere. With an edge of the cap between them, that edge
  /// would have too many faces.
  [[nodiscard]] bool is_joined(Index first, Index second, const Surface& surface) const {
    const Index from = half_edges[first], to = half_edges[second], a = point_before(from, surface),
                b = point_before(to, surface);
    const Index ab = surface.find_half_edge(a, b), ba = surface.find_half_edge(b, a);
    return (ab != kNone && ab != to) || (ba != kNone && ba != from);
  }
};

}  // namespace sunder::tear
