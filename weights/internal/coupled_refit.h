#pragma once

#include <sunder/core/status.h>

#include <span>
#include <vector>

#include "weights/internal/point_refit.h"

namespace sunder {

/// Two neighbours on the surface whose weights and bind positions are to change alike.
struct RefitNeighbours {
  std::uint32_t a = 0;
  std::uint32_t b = kNone;  ///< Another point; kNone: an old neighbour, which keeps what it has.
  double length = 0;        ///< Of the edge between them in bind space, metres.
};

struct CoupledRefitOptions {
  PointRefit::Options point;
  /// What a difference between neighbours costs, beside the mean squared distance of both: of how
  /// far their bind positions were moved, and of how much their weights were changed times the
  /// length of the edge between them; >= 0.
  double smoothness = 0.01;
};

/// A point's weights and bind position after the fit.
struct CoupledFit {
  std::vector<Influence> influences;  ///< Largest first, sum 1.
  Vec3d position = Vec3d::Zero();
  double mean_square = 0;              ///< As in PointRefit::Fit.
  double barycentric_mean_square = 0;  ///< Likewise.
  bool is_better = false;              ///< Otherwise it is what it started from.
};

/// Whether this build can fit points together: it takes Ceres, which is optional (SUNDER_CERES).
[[nodiscard]] SUNDER_API bool has_coupled_refit();

/// Fits points one by one, and from there all of them together: least squares over their weights
/// and bind positions, with what neighbours that differ cost (a Laplacian along the lips and
/// towards the old neighbours). The same bits for the same input. A point that is worse off than
/// with its barycentric weights keeps those.
///
/// @return one fit a point; unsupported_feature where has_coupled_refit() is false;
/// index_out_of_range for a neighbour that is no
///         point; invalid_argument for a smoothness or a length that is not finite or less than
///         zero; empty_input without poses.
[[nodiscard]] SUNDER_API Result<std::vector<CoupledFit>> refit_coupled(
    std::span<const PointToRefit> points, std::span<const RefitNeighbours> neighbours,
    const CoupledRefitOptions& options, const PoseMoments& moments);

}  // namespace sunder
