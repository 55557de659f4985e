#pragma once

#include <sunder/core/math.h>

#include <optional>
#include <span>

namespace sunder::tear {

// Signs of polynomials in coordinates, exact: floating point where its error cannot matter, else
// expansions of doubles. The same on every compiler that keeps IEEE arithmetic. Exact for
// coordinates that exact_range() returns.

/// The point as the predicates can take it: magnitudes below 2^-200 become zero, so that no product
/// underflows.
/// @return nothing for magnitudes above 2^200 and for what is not finite.
[[nodiscard]] std::optional<Vec2d> exact_range(const Vec2d& point);

/// 1 where a, b, c turn counter-clockwise, -1 clockwise, 0 on one line.
[[nodiscard]] int orientation(const Vec2d& a, const Vec2d& b, const Vec2d& c);

/// 1 where d is inside the circle through a, b, c (counter-clockwise), -1 outside, 0 on it.
[[nodiscard]] int in_circle(const Vec2d& a, const Vec2d& b, const Vec2d& c, const Vec2d& d);

/// The sign of the area that a closed polygon runs around counter-clockwise.
[[nodiscard]] int area_sign(std::span<const Vec2d> loop);

}  // namespace sunder::tear
