#pragma once

#include <sunder/core/math.h>

#include <cmath>
#include <optional>
#include <span>

namespace sunder::tear {

// Exact signs of polynomials in coordinates: floating point where its error cannot matter,
// otherwise expansions of doubles. The results are the same with every compiler that keeps IEEE
// arithmetic, and exact for coordinates that exact_range() returns.

/// The point in the range of the predicates: magnitudes below 2^-200 become zero, so that no
/// product underflows.
/// @return nullopt for magnitudes above 2^200 and for non-finite values.
[[nodiscard]] std::optional<Vec2d> exact_range(const Vec2d& point);

namespace predicates {

inline constexpr double kUnitRoundoff = 0x1p-53;

inline int sign_of(double value) { return value > 0 ? 1 : value < 0 ? -1 : 0; }
/// The same as the functions below, always by expansions.
[[nodiscard]] int exact_orientation(const Vec2d& a, const Vec2d& b, const Vec2d& c);
[[nodiscard]] int exact_in_circle(const Vec2d& a, const Vec2d& b, const Vec2d& c, const Vec2d& d);

}  // namespace predicates

/// 1 if a, b, c are counter-clockwise, -1 if clockwise, 0 if collinear.
[[nodiscard]] inline int orientation(const Vec2d& a, const Vec2d& b, const Vec2d& c) {
  const double left = (a.x() - c.x()) * (b.y() - c.y());
  const double right = (a.y() - c.y()) * (b.x() - c.x());
  const double value = left - right;
  if (std::abs(value) > (3 + 16 * predicates::kUnitRoundoff) * predicates::kUnitRoundoff *
                            (std::abs(left) + std::abs(right)))
    return predicates::sign_of(value);
  if (left == 0 && right == 0)
    return 0;  // exact: a difference is zero only where it is, and no product underflows
  return predicates::exact_orientation(a, b, c);
}

/// 1 if d is inside the circle through a, b, c (counter-clockwise), -1 if outside, 0 if on it.
[[nodiscard]] inline int in_circle(const Vec2d& a, const Vec2d& b, const Vec2d& c, const Vec2d& d) {
  const double ax = a.x() - d.x(), ay = a.y() - d.y();
  const double bx = b.x() - d.x(), by = b.y() - d.y();
  const double cx = c.x() - d.x(), cy = c.y() - d.y();
  const double a2 = ax * ax + ay * ay, b2 = bx * bx + by * by, c2 = cx * cx + cy * cy;
  const double value =
      a2 * (bx * cy - by * cx) + b2 * (cx * ay - cy * ax) + c2 * (ax * by - ay * bx);
  const double magnitude = a2 * (std::abs(bx * cy) + std::abs(by * cx)) +
                           b2 * (std::abs(cx * ay) + std::abs(cy * ax)) +
                           c2 * (std::abs(ax * by) + std::abs(ay * bx));
  if (std::abs(value) >
      (10 + 96 * predicates::kUnitRoundoff) * predicates::kUnitRoundoff * magnitude)
    return predicates::sign_of(value);
  return predicates::exact_in_circle(a, b, c, d);
}

/// The sign of the signed area of a closed polygon; counter-clockwise is positive.
[[nodiscard]] int area_sign(std::span<const Vec2d> loop);

}  // namespace sunder::tear
