#pragma once

#include <array>
#include <cstdint>

#include "tear/surface/surface_editor.h"

namespace sunder::tear {

/// A half-edge of a lip: a border that operations made, or an edge at which a wall or cap begins.
struct Lip {
  /// Lips with the same line lie in one origin, or on the edge between two.
  std::uint64_t line = 0;
  /// Where it begins and ends: two barycentric coordinates in the origin, or the share of the edge
  /// and 0. Lips that lie on one another have the same places in reverse, up to rounding.
  std::array<double, 2> from = {}, to = {};
  Index half_edge = kNone;
  std::array<Index, 2> points = {kNone, kNone};  ///< Its ends.

  [[nodiscard]] bool is_on_edge() const { return (line & kOnEdge) != 0; }
  static constexpr std::uint64_t kOnEdge = std::uint64_t{1} << 32;
};

/// All lips of the surface, ascending by line and place. Borders of the source are none.
/// O(triangles that operations changed or appended)
[[nodiscard]] ScratchVector<Lip> find_lips(const SurfaceEditor& editor);

/// Whether a half-edge is a border, or a wall or cap begins at it.
[[nodiscard]] bool is_open(Index half_edge, const SurfaceEditor& editor);

/// Calls visit(half_edge) for each open half-edge of triangles that operations changed or appended.
template <class Visit>
void for_each_open_half_edge(const SurfaceEditor& editor, Visit visit) {
  editor.log.for_each_ever_changed([&](Index face) {
    if (editor.surface().has_repeated_point(face)) return;
    for (Index h = 3 * face; h < 3 * face + 3; ++h)
      if (is_open(h, editor)) visit(h);
  });
}

/// The barycentric coordinates, in the origin of a lip's face, of a place on its line.
[[nodiscard]] std::array<double, 3> place_in_origin(const Lip& lip,
                                                    const std::array<double, 2>& place,
                                                    const SurfaceEditor& editor);

}  // namespace sunder::tear
