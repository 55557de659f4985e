#include "tools/picture/marks.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace sunder::tools {
namespace {

/// Parts nearer to the eye than this share of the distance of the model are left out.
constexpr double kLeastDepth = 0.05;

/// The four corners of a line of some width.
std::vector<Vec2d> ribbon(const Vec2d& from, const Vec2d& to, double width) {
  Vec2d along = to - from;
  along = along.norm() > 1e-9 ? Vec2d(along.normalized()) : Vec2d(1, 0);
  const Vec2d across = width / 2 * Vec2d(-along.y(), along.x());
  const Vec2d cap = width / 4 * along;  // Fills the notches between consecutive lines.
  return {from - cap + across, from - cap - across, to + cap - across, to + cap + across};
}

}  // namespace

bool Marks::is_before_the_eye(const Vec3d& place) const {
  return viewport_.depth(place) >= kLeastDepth * viewport_.middle_depth();
}

void Marks::add(std::vector<Vec2d> corners, std::vector<double> depths, const Vec4f& color) {
  marks_.push_back({std::move(corners), std::move(depths), color});
}

void Marks::line(const Vec3d& from, const Vec3d& to, double width, const Vec4f& color,
                 Layer layer) {
  const double least = kLeastDepth * viewport_.middle_depth();
  Vec3d a = from, b = to;
  if (viewport_.depth(a) > viewport_.depth(b)) std::swap(a, b);
  if (viewport_.depth(b) < least) return;
  if (const double near = viewport_.depth(a), far = viewport_.depth(b); near < least)
    a += (least - near) / (far - near) * (b - a);
  std::vector<double> depths;
  if (layer == Layer::in_scene) {
    const double near = viewport_.depth(a), far = viewport_.depth(b);
    depths = {near, near, far, far};
  }
  add(ribbon(viewport_.pixel(a), viewport_.pixel(b), viewport_.line_scale() * width),
      std::move(depths), color);
}

void Marks::disc(const Vec3d& centre, double radius, int corners, const Vec4f& color, Layer layer) {
  if (!is_before_the_eye(centre)) return;
  const Vec2d middle = viewport_.pixel(centre);
  std::vector<Vec2d> rim;
  for (int i = 0; i < corners; ++i) {
    const double angle = std::numbers::pi * (0.25 + 2.0 * i / corners);
    rim.emplace_back(middle +
                     viewport_.line_scale() * radius * Vec2d(std::cos(angle), std::sin(angle)));
  }
  std::vector<double> depths;
  if (layer == Layer::in_scene) depths.assign(rim.size(), viewport_.depth(centre));
  add(std::move(rim), std::move(depths), color);
}

void Marks::polygon(std::span<const Vec3d> corners, const Vec4f& color, Layer layer) {
  if (!std::all_of(corners.begin(), corners.end(),
                   [this](const Vec3d& corner) { return is_before_the_eye(corner); }))
    return;
  std::vector<Vec2d> pixels;
  std::vector<double> depths;
  for (const Vec3d& corner : corners) {
    pixels.push_back(viewport_.pixel(corner));
    if (layer == Layer::in_scene) depths.push_back(viewport_.depth(corner));
  }
  add(std::move(pixels), std::move(depths), color);
}

void Marks::line(const Vec2d& from, const Vec2d& to, double width, const Vec4f& color) {
  add(ribbon(from, to, viewport_.line_scale() * width), {}, color);
}

void Marks::polygon(std::span<const Vec2d> corners, const Vec4f& color) {
  add({corners.begin(), corners.end()}, {}, color);
}

}  // namespace sunder::tools
