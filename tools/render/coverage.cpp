#include "tools/render/coverage.h"

#include <algorithm>
#include <cmath>

namespace sunder::tools {
namespace {

/// The box of a triangle in the picture, in pixels. @return false if it is partly behind the eye.
bool box_of(const RenderTriangle& triangle, const RenderView& view, Vec2f& least, Vec2f& greatest) {
  for (const Vec3f& corner : triangle.corners) {
    const Vec3f offset = corner - view.eye;
    const float depth = offset.dot(view.forward);
    if (!(depth > 1e-6f * offset.norm())) return false;
    const float across = offset.dot(view.right) / (depth * view.right.squaredNorm()),
                above = offset.dot(view.up) / (depth * view.up.squaredNorm());
    const Vec2f pixel((across + 1) / 2 * static_cast<float>(view.size.width),
                      (1 - above) / 2 * static_cast<float>(view.size.height));
    least = least.cwiseMin(pixel);
    greatest = greatest.cwiseMax(pixel);
  }
  return true;
}

}  // namespace

Coverage::Coverage(const RenderScene& scene, const RenderView& view)
    : columns_(static_cast<std::size_t>(view.size.width / kCell + 1)) {
  const auto rows = static_cast<std::size_t>(view.size.height / kCell + 1);
  is_covered_.assign(columns_ * rows, false);
  const auto cell = [](float pixel, std::size_t count) {
    return static_cast<std::size_t>(
        std::clamp(pixel / static_cast<float>(kCell), 0.0f, static_cast<float>(count - 1)));
  };
  for (const RenderTriangle& triangle : scene.triangles) {
    Vec2f least = Vec2f::Constant(1e30f), greatest = -least;
    if (!box_of(triangle, view, least, greatest)) {
      least.setConstant(-1e30f);
      greatest = -least;
    }
    // A pixel of margin for rounding.
    for (std::size_t y = cell(least.y() - 1, rows); y <= cell(greatest.y() + 1, rows); ++y)
      for (std::size_t x = cell(least.x() - 1, columns_); x <= cell(greatest.x() + 1, columns_);
           ++x)
        is_covered_[y * columns_ + x] = true;
  }
}

}  // namespace sunder::tools
