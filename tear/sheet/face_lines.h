#pragma once

#include <array>
#include <span>

#include "tear/posed/posed_points.h"
#include "tear/surface/open.h"

namespace sunder::tear {

/// Draws straight lines within an area that was one face. All its parts lie in one plane of the
/// pose, so edges between them can be flipped.
class FaceLines {
 public:
  /// @param face  the face as it was when the editor's stage began; it is also its own first child.
  /// @param points  its corners at that time.
  /// @param children  pairs (face, child) of the other children.
  FaceLines(Index face, const std::array<Index, 3>& points,
            std::span<const std::array<Index, 2>> children, SurfaceEditor& editor,
            PosedPoints& posed);

  /// Turns a place in the face into a point. @return kNone if the face has no area.
  [[nodiscard]] Index imprint(const Vec3d& position);

  /// Turns the straight line between two points of the face into a chain of edges. Edges that cross
  /// it are flipped where possible and split otherwise. Lines drawn earlier stay.
  /// @param edges  appended, in order from `from` to `to`.
  /// @return false if the faces are too small or degenerate; the edges made until then are
  ///         appended.
  bool draw(Index from, Index to, ScratchVector<PointEdge>& edges);
  /// The same without the list of edges.
  bool draw(Index from, Index to);

 private:
  [[nodiscard]] Vec2d place(Index point);
  [[nodiscard]] bool is_child(Index triangle) const {
    return editor_.stage.ancestor(triangle) == face_;
  }
  [[nodiscard]] bool is_drawn(Index a, Index b) const;
  /// Flips an edge if both new faces keep their winding; otherwise does nothing.
  /// @return whether the edge was flipped.
  bool turn(Index half_edge);

  SurfaceEditor& editor_;
  PosedPoints& posed_;
  Index face_;
  ScratchVector<Index> children_;
  Index first_new_;  ///< Later triangles with this ancestor are children too.
  Vec3d origin_, x_, y_;
  double size_ = 0;  ///< Length of the longest edge; 0 if the face has no area.
  ScratchVector<PointEdge> drawn_;
};

}  // namespace sunder::tear
