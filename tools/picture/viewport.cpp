#include "tools/picture/viewport.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace sunder::tools {
namespace {

constexpr double kViewAngle = 20;  // Degrees. Narrow, so that lengths compare from near to far.
constexpr double kMargin = 0.05;

/// The nearest position of an eye, along its line of sight and beside it, that sees a set of places
/// between two lines of this slope.
struct Fit {
  double slope;
  double rising = -1e300, falling = -1e300;

  void add(double beside, double towards_eye) {
    rising = std::max(rising, towards_eye + beside / slope);
    falling = std::max(falling, towards_eye - beside / slope);
  }
  [[nodiscard]] double beside() const { return slope * (rising - falling) / 2; }
  [[nodiscard]] double towards_eye() const { return (rising + falling) / 2; }
};

/// Where along `axis` an eye at a given height sees as much on one side as on the other. In the
/// dimension that does not fill the picture this differs a little from Fit::beside().
double middle_of(std::span<const Vec3d> places, const Vec3d& axis, const Vec3d& towards_eye,
                 double eye, double start) {
  double middle = start;
  for (int i = 0; i < 8; ++i) {
    double least = 1e300, greatest = -1e300;
    for (const Vec3d& place : places) {
      const double seen = (place.dot(axis) - middle) / (eye - place.dot(towards_eye));
      least = std::min(least, seen);
      greatest = std::max(greatest, seen);
    }
    const double depth = eye - places.front().dot(towards_eye);
    middle += depth * (least + greatest) / 2;
  }
  return middle;
}

}  // namespace

Viewport::Viewport(const ViewFrame& frame, const PictureSize& size, std::span<const Vec3d> places)
    : frame_(frame), size_(size) {
  const double tangent = std::tan(kViewAngle / 2 * std::numbers::pi / 180);
  const double aspect = static_cast<double>(size.width) / size.height;
  Fit across{tangent * aspect * (1 - 2 * kMargin)}, upright{tangent * (1 - 2 * kMargin)};
  double nearest = -1e300, farthest = 1e300;
  for (const Vec3d& place : places) {
    const double towards_eye = place.dot(frame.towards_eye);
    across.add(place.dot(frame.right), towards_eye);
    upright.add(place.dot(frame.up), towards_eye);
    nearest = std::max(nearest, towards_eye);
    farthest = std::min(farthest, towards_eye);
  }
  const double middle = (nearest + farthest) / 2;
  double eye = std::max(across.towards_eye(), upright.towards_eye());
  const double least = 0.6 * (nearest - farthest) + 1e-6;  // Of a set without extent, too.
  eye = std::max(eye, middle + least);
  const double beside = middle_of(places, frame.right, frame.towards_eye, eye, across.beside());
  const double above = middle_of(places, frame.up, frame.towards_eye, eye, upright.beside());
  camera_.eye = beside * frame.right + above * frame.up + eye * frame.towards_eye;
  middle_depth_ = eye - middle;
  camera_.focal_point = camera_.eye - middle_depth_ * frame.towards_eye;
  camera_.up = frame.up;
  camera_.view_angle_degrees = kViewAngle;
  slope_ = 2 * tangent / size.height;
}

double Viewport::line_scale() const {
  return std::max(1.0, std::min(size_.width, size_.height) / 960.0);
}

double Viewport::depth(const Vec3d& place) const {
  return (camera_.eye - place).dot(frame_.towards_eye);
}

Vec2d Viewport::pixel(const Vec3d& place) const {
  const Vec3d offset = place - camera_.eye;
  const double metres_per_pixel = slope_ * depth(place);
  return {size_.width / 2.0 + offset.dot(frame_.right) / metres_per_pixel,
          size_.height / 2.0 - offset.dot(frame_.up) / metres_per_pixel};
}

Vec3d Viewport::place(const Vec2d& pixel, double depth) const {
  const double metres_per_pixel = slope_ * depth;
  return camera_.eye - depth * frame_.towards_eye +
         (pixel.x() - size_.width / 2.0) * metres_per_pixel * frame_.right -
         (pixel.y() - size_.height / 2.0) * metres_per_pixel * frame_.up;
}

bool Viewport::is_inside(const Vec2d& pixel) const {
  return pixel.x() >= 0 && pixel.y() >= 0 && pixel.x() < size_.width && pixel.y() < size_.height;
}

}  // namespace sunder::tools
