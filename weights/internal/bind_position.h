#pragma once

#include <sunder/core/api.h>
#include <sunder/core/math.h>
#include <sunder/core/skin.h>

#include <optional>
#include <span>

namespace sunder {

/// The largest acceptable amplification, as a mean over directions: how many times as large an
/// offset in bind space may become in another pose as the error that it removes in this pose. In
/// the worst direction rotations may amplify it sqrt(3) times as much.
inline constexpr double kLargestAmplification = 10.0;

/// The bind position that linear blend skinning maps to a given posed position: M^-1 p with M =
/// sum_k w_k M_k.
///
/// @param influences  normalised.
/// @param posed       p, model space.
/// @return nullopt if M is ill-conditioned, that is if |M^-1| times the largest |M_k| exceeds
/// kLargestAmplification. Both are Frobenius norms of the linear parts, and the product is divided
/// by 3, so it is 1 if all bones rotate alike. O(influences), no allocation.
[[nodiscard]] SUNDER_API std::optional<Vec3d> solve_bind_position(
    std::span<const Influence> influences, const Vec3d& posed,
    std::span<const Affine3d> model_from_bind);

}  // namespace sunder
