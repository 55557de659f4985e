#include "tear/geometry/blade_plane.h"

#include <cmath>
#include <limits>

#include "core/internal/ordered.h"
#include "tear/geometry/cross.h"
#include "tear/geometry/tolerances.h"

namespace sunder::tear {
namespace {

/// The half-plane bounded by the line through a and b that holds `inside`. A line that has no
/// direction, or that passes through `inside`, is replaced by the one through a at right angles to
/// `fallback`: a blade that turns about its own end reaches the points along it.
BladePlane::HalfPlane beside(const Vec2d& a, const Vec2d& b, const Vec2d& inside,
                             const Vec2d& fallback) {
  Vec2d normal{-(b - a).y(), (b - a).x()};
  const double length = norm(normal);
  const double side = dot(normal, inside - a);
  if (!(length > kDirectionLengths * norm(fallback)) ||
      !(std::abs(side) > kDirectionLengths * length * norm(fallback)))
    normal = fallback;
  else if (side < 0)
    normal = -normal;
  normal /= norm(normal);
  return {normal, dot(normal, a)};
}

}  // namespace

std::optional<BladePlane> BladePlane::through(const Vec3d& anchor, const Blade& from,
                                              const Blade& to) {
  const Vec3d blade = to.tip - to.base;
  BladePlane plane;
  plane.origin_ = to.base;
  plane.along_ = blade / norm(blade);
  const Vec3d offset = to.base - anchor;
  const Vec3d across = offset - dot(plane.along_, offset) * plane.along_;
  const double distance = norm(across);
  if (!(distance > kSweptLengths * (norm(blade) + norm(offset)))) return std::nullopt;
  plane.across_ = across / distance;
  // A second time, because subtracting nearly parallel vectors loses the right angle.
  plane.across_ -= dot(plane.along_, plane.across_) * plane.along_;
  plane.across_ /= norm(plane.across_);
  plane.normal_ = plane.across_.cross(plane.along_);

  plane.from_base_ = plane.project(from.base);
  plane.from_tip_ = plane.project(from.tip);
  plane.to_base_ = plane.project(to.base);
  plane.to_tip_ = plane.project(to.tip);
  const Vec2d middle = (plane.from_base_ + plane.from_tip_ + plane.to_base_ + plane.to_tip_) / 4;
  const Vec2d down = (plane.from_tip_ - plane.from_base_) + (plane.to_tip_ - plane.to_base_);
  plane.reach_[0] = beside(plane.to_base_, plane.from_base_, middle, down);
  plane.reach_[1] = beside(plane.to_tip_, plane.from_tip_, middle, -down);
  plane.reach_[2] = {Vec2d(-1, 0), 0.0};
  plane.e_ = plane.to_base_ - plane.from_base_;
  plane.d_ = plane.from_tip_ - plane.from_base_;
  plane.g_ = (plane.to_tip_ - plane.to_base_) - plane.d_;
  plane.a_ = -cross(plane.e_, plane.g_);
  plane.cross_e_d_ = cross(plane.e_, plane.d_);
  plane.not_before_ = plane.from_progress(0);
  return plane;
}

double BladePlane::progress(const Vec2d& point) const {
  // The point lies on the blade's line where cross(point - base(s), direction(s)) = 0: inverse
  // bilinear interpolation, a quadratic in s.
  const Vec2d p = point - from_base_;
  const double b = cross(p, g_) - cross_e_d_;
  const double c = cross(p, d_);
  const double discriminant = b * b - 4 * a_ * c;
  if (std::abs(a_ * c) <= kLinearSquares * b * b || discriminant < 0) return b != 0 ? -c / b : 0.0;
  const auto distance_from_sweep = [](double s) { return s < 0 ? -s : s > 1 ? s - 1 : 0.0; };
  const double q = -0.5 * (b + std::copysign(std::sqrt(discriminant), b));
  const double one = q / a_;
  const double other = q != 0 ? c / q : one;
  return distance_from_sweep(other) <= distance_from_sweep(one) ? other : one;
}

SweepCoordinates BladePlane::sweep_coordinates(const Vec2d& point) const {
  const double at = progress(point);
  const Vec2d direction = d_ + at * g_;
  const double squared = squared_norm(direction);
  return {at, squared > 0 ? dot(direction, (point - from_base_) - at * e_) / squared : 0.0};
}

BladePlane::HalfPlane BladePlane::from_progress(double progress) const {
  const Vec2d base = from_base_ + progress * e_;
  const Vec2d direction = d_ + progress * g_;
  Vec2d normal{direction.y(),
               -direction.x()};  // to the blade's right when it points down y: towards growing x
  normal /= norm(normal);
  return {normal, dot(normal, base)};
}

Mat3d BladePlane::axes() const {
  Mat3d axes;
  axes << along_.transpose(), across_.transpose(), normal_.transpose();
  return axes;
}

double BladePlane::least_progress(const FrameBox& box) const {
  // As in sweep_coordinates(), a point p is ahead of the blade at progress s where cross(p -
  // base(s), direction(s)) > 0, which is quadratic in s and linear in p. The least value over the
  // box is the value at its middle minus a radius. The radius is convex in s, so it is at most the
  // linear interpolation of its values at 0 and 1. While the difference is positive the whole box
  // is ahead of the blade. A point that is ahead of the first blade and within reach of the second
  // has exactly one progress in [0, 1], so that root is the one meant.
  constexpr double kUnknown = -std::numeric_limits<double>::infinity();
  const Vec3d half = box.half_size(), middle = box.middle();
  const Vec2d e = to_base_ - from_base_, d = from_tip_ - from_base_, g = (to_tip_ - to_base_) - d;
  const auto radius = [&](const Vec2d& direction) {
    return std::abs(direction.y()) * half.y() + std::abs(direction.x()) * half.x();
  };
  const double radius_before = radius(d), radius_after = radius(d + g);
  const Vec2d p = Vec2d(middle.y(), middle.x()) - from_base_;
  const double a = -cross(e, g);
  const double b = cross(p, g) - cross(e, d) - (radius_after - radius_before);
  const double c = cross(p, d) - radius_before;
  if (!(c > 0)) return kUnknown;
  const double discriminant = b * b - 4 * a * c;
  double first = 1;  // root above 0
  if (discriminant >= 0) {
    const double q = -0.5 * (b + std::copysign(std::sqrt(discriminant), b));
    if (b < 0)
      first = std::min(first, c / q);
    else if (a < 0)
      first = std::min(first, q / a);
  } else if (!(discriminant < 0)) {
    return kUnknown;
  }
  return first - kRootSweeps;
}

}  // namespace sunder::tear
