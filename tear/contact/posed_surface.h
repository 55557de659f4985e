#pragma once

#include <sunder/tear/contact.h>

#include "tear/contact/nearest_point.h"
#include "tear/posed/posed_points.h"

namespace sunder::tear {

/// The surface of a model in one pose, displaced, as queries see it: the only place of this room
/// that knows how points are posed and how faces are found. The boxes of PosedPoints hold the
/// surface on which operations find their way; they are widened by the farthest that any point is
/// moved away from it.
class PosedSurface {
 public:
  /// @param posed  in a pose; the editor is that of its model.
  PosedSurface(const SurfaceEditor& editor, PosedPoints& posed) : editor_(editor), posed_(posed) {}

  /// The farthest that displacements move a point, metres.
  /// @return size_mismatch or non_finite_value with the mesh or the particle.
  [[nodiscard]] static Result<double> reach_of(const ContactOptions& options,
                                               const Character& character);
  /// Moves the surface. @param reach  by reach_of().
  void set_options(const ContactOptions& options, double reach);

  [[nodiscard]] const SurfaceEditor& editor() const { return editor_; }
  [[nodiscard]] const CharacterPose& pose() const { return posed_.pose(); }
  [[nodiscard]] Vec3d position(Index point);
  [[nodiscard]] Corners corners(Index face);

  /// The frame of boxes. All queries of a pose share it, so that a box is posed once: with axes
  /// along each ray they are fewer by a tenth, but each ray poses its own.
  [[nodiscard]] Frame frame() const { return posed_.frame_along(Mat3d::Identity(), editor_); }

  /// Visits the faces in whose boxes something may be found, roughly the nearest first.
  /// @param frame  frame().
  /// @param bound  bound(const FrameBox&): a lower bound of the figure that is minimised; infinity
  ///        where nothing can be found.
  /// @param visit  visit(face): returns the greatest figure that is still of interest.
  template <class Bound, class Visit>
  void visit_faces(const Frame& frame, Bound bound, Visit visit) {
    const auto bound_of_moved = [&](const FrameBox& box) {
      const Vec3d more = Vec3d::Constant(box.margin(frame.reach()) + reach_);
      return bound(FrameBox{box.low - more, box.high + more});
    };
    posed_.visit_faces(editor_, frame, bound_of_moved, visit);
  }

 private:
  [[nodiscard]] bool is_drawn_elsewhere(Index mesh, Index vertex) const;
  [[nodiscard]] Vec3d drawn_position(Index mesh, Index vertex) const;
  [[nodiscard]] Vec3d displacement(Index mesh, Index vertex) const;
  [[nodiscard]] double farthest_drawn();

  const SurfaceEditor& editor_;
  PosedPoints& posed_;
  std::span<const VertexDisplacements> displacements_;
  bool are_drawn_ = false;  ///< Whether a point may be drawn elsewhere than it is torn.
  double reach_ = 0;        ///< Metres.
};

}  // namespace sunder::tear
