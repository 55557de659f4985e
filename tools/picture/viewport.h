#pragma once

#include <span>

#include "tools/picture/view.h"
#include "tools/render/camera.h"

namespace sunder::tools {

/// A camera and the pixels of its picture: x to the right, y down, from the upper left corner.
class Viewport {
 public:
  /// Looks from the side of `frame` such that all places fit into the picture, with a margin of 5 %
  /// on each side in the dimension that they fill.
  /// @param places  model space; at least one.
  Viewport(const ViewFrame& frame, const PictureSize& size, std::span<const Vec3d> places);

  [[nodiscard]] const Camera& camera() const { return camera_; }
  [[nodiscard]] const PictureSize& size() const { return size_; }
  /// How much wider lines and larger letters are than in a picture of the default size; at least 1.
  [[nodiscard]] double line_scale() const;
  [[nodiscard]] const ViewFrame& frame() const { return frame_; }
  /// Distance from the plane of the eye, along the line of sight; metres.
  [[nodiscard]] double depth(const Vec3d& place) const;
  /// The distance of the middle of what fills the picture.
  [[nodiscard]] double middle_depth() const { return middle_depth_; }
  /// The pixel of a place at a positive depth.
  [[nodiscard]] Vec2d pixel(const Vec3d& place) const;
  /// The place at a pixel and a depth.
  [[nodiscard]] Vec3d place(const Vec2d& pixel, double depth) const;
  [[nodiscard]] bool is_inside(const Vec2d& pixel) const;

 private:
  ViewFrame frame_;
  PictureSize size_;
  Camera camera_;
  double middle_depth_ = 1;
  double slope_ = 1;  ///< Metres per pixel and metre of depth.
};

}  // namespace sunder::tools
