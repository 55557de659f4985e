#pragma once

#include <span>
#include <vector>

#include "pipeline/validation/internal/weight_row.h"
#include "pipeline/validation/transfer/laplacian.h"

namespace sunder::validation {

enum class PointState : std::uint8_t {
  fixed,    ///< Its row is given.
  unknown,  ///< Its row is wanted; its part has a fixed point.
  ignored,  ///< Left as it is.
};

/// Continues the rows of fixed points to the unknown ones: minimises the trace of W^T Q W with Q =
/// S + s S M^-1 S, S the stiffness and M the mass, by one sparse Cholesky factorisation for all
/// bones. Rows sum to one as the fixed ones do, but may have negative weights.
/// @param smoothness  s, squared unit of the positions.
/// @return false if the matrix could not be factorised; rows are unchanged then.
[[nodiscard]] bool inpaint(const Laplacian& laplacian, double smoothness,
                           std::span<const PointState> states, std::vector<WeightRow>& rows);

/// Averages the rows of some points with those of their neighbours on the surface: (1 - strength)
/// own + strength mean, all points at once, so that their order does not matter.
void smooth(const Laplacian& laplacian, const std::vector<bool>& is_smoothed, std::uint32_t sweeps,
            double strength, std::vector<WeightRow>& rows);

/// The points within a distance of the unknown ones, along edges.
[[nodiscard]] std::vector<bool> points_near_unknown(const Laplacian& laplacian,
                                                    std::span<const Vec3d> positions,
                                                    std::span<const PointState> states,
                                                    double distance);

}  // namespace sunder::validation
