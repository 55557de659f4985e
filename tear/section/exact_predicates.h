#pragma once

#include <sunder/core/math.h>

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

/// 1 if a, b, c are counter-clockwise, -1 if clockwise, 0 if collinear.
[[nodiscard]] int orientation(const Vec2d& a, const Vec2d& b, const Vec2d& c);

/// 1 if d is inside the circle through a, b, c (counter-clockwise), -1 if outside, 0 if on it.
[[nodiscard]] int in_circle(const Vec2d& a, const Vec2d& b, const Vec2d& c, const Vec2d& d);

/// The sign of the signed area of a closed polygon; counter-clockwise is positive.
[[nodiscard]] int area_sign(std::span<const Vec2d> loop);

}  // namespace sunder::tear
