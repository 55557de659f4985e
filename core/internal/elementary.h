#pragma once

#include <sunder/core/api.h>

namespace sunder::elementary {

/// Sine, exponential and their kind with the same bits on every platform, which the C libraries do
/// not promise: only operations that IEEE 754 rounds exactly are used (+, -, *, /, square root,
/// scaling by powers of two). Whatever a replayed log or a restored snapshot computes calls these.
///
/// The result is within 4 units in the last place of the exact one (sin and cos up to 1e6; beyond,
/// an error of 2^-53 of the argument is added). Infinities and NaN give what the C library gives.
///
/// Polynomials are near-minimax (Chebyshev), at arguments reduced as in Cody and Waite, *Software
/// Manual for the Elementary Functions*, 1980.
[[nodiscard]] SUNDER_API double sin(double x);
[[nodiscard]] SUNDER_API double cos(double x);
[[nodiscard]] SUNDER_API double asin(double x);
[[nodiscard]] SUNDER_API double acos(double x);
[[nodiscard]] SUNDER_API double atan2(double y, double x);
[[nodiscard]] SUNDER_API double exp(double x);
[[nodiscard]] SUNDER_API double expm1(double x);
[[nodiscard]] SUNDER_API double log(double x);

}  // namespace sunder::elementary
