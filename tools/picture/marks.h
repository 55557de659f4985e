#pragma once

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "tools/picture/viewport.h"
#include "tools/render/render_scene.h"

namespace sunder::tools {

/// Lines, discs and polygons of a picture, as flat pieces that face the eye. Widths and radii are
/// pixels of a picture of the default size, wherever a mark is; larger pictures have larger ones.
class Marks {
 public:
  enum class Layer : std::uint8_t {
    in_scene,  ///< The surface hides what is behind it.
    on_top,    ///< Visible through everything; later marks cover earlier ones.
  };

  explicit Marks(const Viewport& viewport) : viewport_(viewport) {}

  [[nodiscard]] const Viewport& viewport() const { return viewport_; }

  /// Parts behind the eye are left out.
  void line(const Vec3d& from, const Vec3d& to, double width, const Vec4f& color, Layer layer);
  /// A regular polygon; with many corners, a disc.
  void disc(const Vec3d& centre, double radius, int corners, const Vec4f& color, Layer layer);
  /// A convex polygon in space. Not drawn if a corner is behind the eye.
  void polygon(std::span<const Vec3d> corners, const Vec4f& color, Layer layer);
  /// In pixels of the picture, on top.
  void line(const Vec2d& from, const Vec2d& to, double width, const Vec4f& color);
  void polygon(std::span<const Vec2d> corners, const Vec4f& color);

  /// All marks, for the scene.
  [[nodiscard]] std::vector<RenderMark> take() { return std::move(marks_); }

 private:
  void add(std::vector<Vec2d> corners, std::vector<double> depths, const Vec4f& color);
  [[nodiscard]] bool is_before_the_eye(const Vec3d& place) const;

  const Viewport& viewport_;
  std::vector<RenderMark> marks_;
};

}  // namespace sunder::tools
