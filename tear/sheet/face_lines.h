#pragma once

#include <array>
#include <span>
#include <vector>

#include "tear/posed/posed_points.h"
#include "tear/surface/open.h"

namespace sunder::tear {

/// Draws straight lines within what was one face: its parts lie in one plane of the pose, so edges
/// between them can be turned.
class FaceLines {
 public:
  /// @param face    the face as it was when the editor's stage began, now the first of its own
  /// children.
  /// @param points  its corners then.
  /// @param children  (face, child) of the others.
  FaceLines(Index face, const std::array<Index, 3>& points,
            std::span<const std::array<Index, 2>> children, SurfaceEditor& editor,
            PosedPoints& posed);

  /// Makes a place of the face a point. @return kNone where the face has no area.
  [[nodiscard]] Index imprint(const Vec3d& position);

  /// Makes the line between two points of the face edges: the edges that cross it are turned out of
  /// its way where that can be, else split. Lines drawn before stay.
  /// @param edges  appended: from `from` to `to`.
  /// @return false where the faces are too small or degenerate for that; edges are appended as far
  /// as it came.
  bool draw(Index from, Index to, std::vector<PointEdge>& edges);

 private:
  [[nodiscard]] Vec2d place(Index point);
  [[nodiscard]] bool is_child(Index triangle) const {
    return editor_.stage.ancestor(triangle) == face_;
  }
  [[nodiscard]] bool is_drawn(Index a, Index b) const;
  /// Turns an edge where both faces it would make are upright. Its far point must not be on the
  /// wrong side of the line's begin.
  bool turn(Index half_edge);

  SurfaceEditor& editor_;
  PosedPoints& posed_;
  Index face_;
  std::vector<Index> children_;
  Index first_new_;  ///< Triangles from here on that have this ancestor are children too.
  Vec3d origin_, x_, y_;
  double size_ = 0;  ///< The longest edge's length; 0 where the face has no area.
  std::vector<PointEdge> drawn_;
};

}  // namespace sunder::tear
