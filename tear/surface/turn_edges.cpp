#include "tear/surface/turn_edges.h"

#include <array>
#include <deque>
#include <memory_resource>

#include "tear/internal/surface.h"
#include "tear/surface/flip_edge.h"

namespace sunder::tear {
namespace {

/// Coordinates in the origin.
Vec2d place(Index corner, const SurfaceEditor& editor) {
  const auto barycentric = editor.source_barycentric(corner);
  return {barycentric[1], barycentric[2]};
}

/// The corner of a point in an origin.
Index corner_in(const TriangleRef& origin, Index point, const SurfaceEditor& editor) {
  Index found = kNone;
  const Surface& surface = editor.surface();
  surface.for_each_in_fan(surface.point_corner[point], [&](Index corner) {
    const TriangleRef of = surface.triangle(corner / 3);
    if (of.mesh == origin.mesh && of.source_triangle == origin.source_triangle) found = corner;
  });
  return found;
}

/// Finds the edges that a line crosses, from face to face.
class CrossedEdges {
 public:
  CrossedEdges(Index from, Index to, const TriangleRef& origin, const SurfaceEditor& editor)
      : editor_(editor), surface_(editor.surface()), from_(from), to_(to), origin_(origin) {}

  /// @return false if the line leaves the origin or meets a point.
  bool find(std::pmr::deque<std::array<Index, 2>>& edges) {
    const Index at_from = corner_in(origin_, from_, editor_),
                at_to = corner_in(origin_, to_, editor_);
    if (at_from == kNone || at_to == kNone) return false;
    begin_ = place(at_from, editor_);
    way_ = place(at_to, editor_) - begin_;
    Index crossed = kNone;
    surface_.for_each_in_fan(surface_.point_corner[from_], [&](Index corner) {
      if (is_part(corner / 3) && side(Surface::next(corner)) < 0 &&
          side(Surface::previous(corner)) > 0)
        crossed = Surface::next(corner);
    });
    while (crossed != kNone) {
      const Index twin = surface_.twin[crossed];
      if (twin == kNone || !is_part(twin / 3)) return false;
      edges.push_back({surface_.corner_point[crossed], surface_.corner_point[twin]});
      const Index opposite = Surface::previous(twin);
      if (surface_.corner_point[opposite] == to_) return true;
      const double at = side(opposite);
      if (at == 0) return false;
      crossed = at > 0 ? Surface::next(twin) : opposite;
    }
    return false;
  }

  [[nodiscard]] double side(Index corner) const {
    const Vec2d offset = place(corner, editor_) - begin_;
    return way_.x() * offset.y() - way_.y() * offset.x();
  }

 private:
  [[nodiscard]] bool is_part(Index face) const {
    return surface_.triangle(face).mesh == origin_.mesh &&
           surface_.triangle(face).source_triangle == origin_.source_triangle;
  }

  const SurfaceEditor& editor_;
  const Surface& surface_;
  Index from_, to_;
  TriangleRef origin_;
  Vec2d begin_ = Vec2d::Zero(), way_ = Vec2d::Zero();
};

}  // namespace

bool turn_edges_into_line(Index from, Index to, Index face, SurfaceEditor& editor) {
  const Surface& surface = editor.surface();
  const auto is_edge = [&] {
    return surface.find_half_edge(from, to) != kNone || surface.find_half_edge(to, from) != kNone;
  };
  if (is_edge()) return true;
  CrossedEdges line(from, to, surface.triangle(face), editor);
  std::pmr::deque<std::array<Index, 2>> edges(&editor.scratch());
  if (!line.find(edges)) return false;
  // Sloan 1993: an edge that cannot be flipped yet waits until its neighbours are flipped.
  for (std::size_t turns_left = edges.size() * edges.size() + 4; !edges.empty() && turns_left > 0;
       --turns_left) {
    const std::array<Index, 2> edge = edges.front();
    edges.pop_front();
    const Index h = surface.find_half_edge(edge[0], edge[1]);
    if (h == kNone) return false;
    if (!flip_edge(h, editor)) {
      edges.push_back(edge);
      continue;
    }
    const Index turned = Surface::next(h), twin = surface.twin[turned];
    const std::array<Index, 2> ends = {surface.corner_point[turned], surface.corner_point[twin]};
    if (ends[0] == from || ends[0] == to || ends[1] == from || ends[1] == to) continue;
    if ((line.side(turned) > 0) != (line.side(twin) > 0)) edges.push_back(ends);
  }
  return is_edge();
}

}  // namespace sunder::tear
