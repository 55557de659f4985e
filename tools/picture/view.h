#pragma once

#include <sunder/core/character.h>

#include <optional>
#include <vector>

#include "tools/model/posed_model.h"

namespace sunder::tools {

/// An orthonormal frame from which a model is seen.
struct ViewFrame {
  Vec3d right, up, towards_eye;
};

/// A view from this side, upright: y is up, or -z if that is the line of sight.
/// @param towards_eye  any length except zero.
[[nodiscard]] ViewFrame view_from(const Vec3d& towards_eye);

/// A view of the model's broader side, a little from above and from the side. y is up.
[[nodiscard]] ViewFrame choose_view(const Bounds& bounds);

/// An orthographic depth image of a posed model: per pixel the nearest surface.
class DepthImage {
 public:
  struct Pixel {
    std::uint32_t mesh = kNone;  ///< kNone: background.
    std::uint32_t submesh = 0;
    double depth = -1e300;  ///< Along towards_eye, metres; larger is nearer.
    double facing = 0;      ///< Cosine between the surface's normal and the line of sight, >= 0.
  };

  /// @param size  pixels along the longer side.
  DepthImage(const Character& character, const std::vector<DeformedMesh>& posed,
             const ViewFrame& frame, int size);

  [[nodiscard]] int width() const { return width_; }
  [[nodiscard]] int height() const { return height_; }
  [[nodiscard]] double pixel_size() const { return pixel_size_; }  ///< Metres.
  [[nodiscard]] double nearest_depth() const { return nearest_depth_; }
  /// The background pixel if it is outside the image.
  [[nodiscard]] Pixel at(double x, double y) const;
  /// The position of the surface in model space; not for background pixels.
  [[nodiscard]] Vec3d position(double x, double y) const;

 private:
  /// @param surface  the mesh and the submesh of all pixels.
  void draw(const Pixel& surface, const std::array<Vec3d, 3>& corners);

  ViewFrame frame_;
  Vec2d least_ = Vec2d::Zero();
  double pixel_size_ = 1, nearest_depth_ = -1e300;
  int width_ = 0, height_ = 0;
  std::vector<Pixel> pixels_;
};

}  // namespace sunder::tools
