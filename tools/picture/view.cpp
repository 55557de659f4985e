#include "tools/picture/view.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace sunder::tools {

ViewFrame view_from(const Vec3d& towards_eye) {
  ViewFrame frame;
  frame.towards_eye = towards_eye.normalized();
  const double rise = frame.towards_eye.y();
  // From above, the front (+z) is at the bottom of the picture; from below, at the top.
  const Vec3d up = std::abs(rise) < 0.999 ? Vec3d(Vec3d::UnitY()) : Vec3d(0, 0, rise > 0 ? -1 : 1);
  frame.right = Vec3d(up.cross(frame.towards_eye)).normalized();
  frame.up = frame.towards_eye.cross(frame.right);
  return frame;
}

ViewFrame choose_view(const Bounds& bounds) {
  const Vec3d size = bounds.size();
  const bool is_broad_from_the_front = size.x() >= 0.8 * size.z();
  const Vec3d side = is_broad_from_the_front ? Vec3d(0.30, 0.12, 1.0) : Vec3d(1.0, 0.12, 0.30);
  return view_from(side);
}

DepthImage::DepthImage(const Character& character, const std::vector<DeformedMesh>& posed,
                       const ViewFrame& frame, int size)
    : frame_(frame) {
  // Corners as (right, up, towards the eye).
  const auto seen = [&](const Vec3f& position) {
    const Vec3d p = position.cast<double>();
    return Vec3d(p.dot(frame.right), p.dot(frame.up), p.dot(frame.towards_eye));
  };
  Vec3d least = Vec3d::Constant(1e300), greatest = Vec3d::Constant(-1e300);
  for (std::size_t mesh = 0; mesh < posed.size(); ++mesh)
    for (const Triangle& triangle : character.meshes[mesh].triangles)
      for (const std::uint32_t vertex : triangle) {
        const Vec3d corner = seen(posed[mesh].positions[vertex]);
        least = least.cwiseMin(corner);
        greatest = greatest.cwiseMax(corner);
      }
  const Vec3d extent = greatest - least;
  if (!(extent.head<2>().maxCoeff() > 0)) return;
  least_ = least.head<2>();
  pixel_size_ = extent.head<2>().maxCoeff() / size;
  nearest_depth_ = greatest.z();
  width_ = static_cast<int>(extent.x() / pixel_size_) + 1;
  height_ = static_cast<int>(extent.y() / pixel_size_) + 1;
  pixels_.resize(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_));
  for (std::uint32_t mesh = 0; mesh < posed.size(); ++mesh)
    for (std::size_t t = 0; t < character.meshes[mesh].triangles.size(); ++t) {
      const Triangle& triangle = character.meshes[mesh].triangles[t];
      std::array<Vec3d, 3> corners;
      for (std::size_t i = 0; i < 3; ++i) {
        corners[i] = seen(posed[mesh].positions[triangle[i]]);
        corners[i].head<2>() = (corners[i].head<2>() - least_) / pixel_size_;
      }
      draw({mesh, character.meshes[mesh].triangle_submesh[t]}, corners);
    }
}

void DepthImage::draw(const Pixel& surface, const std::array<Vec3d, 3>& corners) {
  const auto cross = [](const Vec3d& a, const Vec3d& b, double x, double y) {
    return (b.x() - a.x()) * (y - a.y()) - (b.y() - a.y()) * (x - a.x());
  };
  const double area = cross(corners[0], corners[1], corners[2].x(), corners[2].y());
  if (area == 0) return;
  const auto pixel_range = [](double a, double b, double c, int count) {
    return std::pair(std::max(0, static_cast<int>(std::floor(std::min({a, b, c})))),
                     std::min(count - 1, static_cast<int>(std::ceil(std::max({a, b, c})))));
  };
  const auto [x_first, x_last] =
      pixel_range(corners[0].x(), corners[1].x(), corners[2].x(), width_);
  const auto [y_first, y_last] =
      pixel_range(corners[0].y(), corners[1].y(), corners[2].y(), height_);
  const double scale = 1 / pixel_size_;
  const auto in_pixels = [&](const Vec3d& corner) {
    return Vec3d(corner.x(), corner.y(), corner.z() * scale);
  };
  const Vec3d normal = (in_pixels(corners[1]) - in_pixels(corners[0]))
                           .cross(in_pixels(corners[2]) - in_pixels(corners[0]));
  const double facing = std::abs(normal.z()) / normal.norm();
  for (int y = y_first; y <= y_last; ++y)
    for (int x = x_first; x <= x_last; ++x) {
      const double a = cross(corners[1], corners[2], x, y) / area,
                   b = cross(corners[2], corners[0], x, y) / area, c = 1 - a - b;
      if (a < 0 || b < 0 || c < 0) continue;
      const double depth = a * corners[0].z() + b * corners[1].z() + c * corners[2].z();
      Pixel& pixel = pixels_[static_cast<std::size_t>(y * width_ + x)];
      if (depth > pixel.depth) pixel = {surface.mesh, surface.submesh, depth, facing};
    }
}

DepthImage::Pixel DepthImage::at(double x, double y) const {
  const int column = static_cast<int>(std::lround(x)), row = static_cast<int>(std::lround(y));
  if (column < 0 || row < 0 || column >= width_ || row >= height_) return {};
  return pixels_[static_cast<std::size_t>(row * width_ + column)];
}

Vec3d DepthImage::position(double x, double y) const {
  return (least_.x() + x * pixel_size_) * frame_.right +
         (least_.y() + y * pixel_size_) * frame_.up + at(x, y).depth * frame_.towards_eye;
}

}  // namespace sunder::tools
