#pragma once

#include <sunder/core/api.h>
#include <sunder/core/math.h>
#include <sunder/core/skin.h>

#include <optional>
#include <span>

namespace sunder {

/// Where an offset in bind space could show this many times as large in another pose as what it
/// takes away in this one, it is not worth having.
inline constexpr double kLargestAmplification = 10.0;

/// The bind position that linear blend skinning carries to a place: M^-1 p with M = sum_k w_k M_k.
///
/// @param influences  normalised.
/// @param posed       p, model space.
/// @return nothing where M is ill-conditioned: where |M^-1| times the largest |M_k| is more than
/// kLargestAmplification (Frobenius
///         norms of the linear parts over 3: 1 where all bones turn alike). O(influences), no
///         allocation.
[[nodiscard]] SUNDER_API std::optional<Vec3d> solve_bind_position(
    std::span<const Influence> influences, const Vec3d& posed,
    std::span<const Affine3d> model_from_bind);

}  // namespace sunder
