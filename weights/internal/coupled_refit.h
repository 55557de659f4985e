#pragma once

#include <sunder/core/status.h>

#include <span>
#include <vector>

#include "weights/internal/point_refit.h"

namespace sunder {

/// Two neighbours on the surface whose weights and bind positions should change alike.
struct RefitNeighbours {
  std::uint32_t a = 0;
  /// Another point; kNone: a vertex of the untorn surface, which is not fitted.
  std::uint32_t b = kNone;
  double length = 0;  ///< Length of their common edge in bind space, metres.
};

struct CoupledRefitOptions {
  PointRefit::Options point;
  /// Cost of a difference between neighbours, relative to the mean squared distances. It multiplies
  /// the squared difference of their bind position offsets, and the squared difference of their
  /// weight changes times the edge length; >= 0.
  double smoothness = 0.01;
};

/// The weights and bind position of a point after the fit.
struct CoupledFit {
  std::vector<Influence> influences;  ///< By descending weight, sum 1.
  Vec3d position = Vec3d::Zero();
  double mean_square = 0;              ///< As in PointRefit::Fit.
  double barycentric_mean_square = 0;  ///< Likewise.
  bool is_better = false;              ///< If false, the result is the barycentric start.
};

/// Fits each point alone, then all of them together: least squares over their weights and bind
/// positions plus the costs of neighbours that differ (a Laplacian along the lips and towards the
/// untorn surface). Deterministic. A point whose common fit is worse than its barycentric weights,
/// or exceeds a bound, goes only a part of the way to it from its fit alone.
///
/// @return one fit per point; unsupported_feature if has_coupled_refit() is false;
/// index_out_of_range for a neighbour that is no point; invalid_argument for a smoothness or length
/// that is negative or not finite; empty_input without poses.
[[nodiscard]] SUNDER_API Result<std::vector<CoupledFit>> refit_coupled(
    std::span<const PointToRefit> points, std::span<const RefitNeighbours> neighbours,
    const CoupledRefitOptions& options, const PoseMoments& moments);

/// The function behind refit_coupled(). It is in a library of its own, sunder::coupled_refit, so
/// that programs without coupled fits do not link Ceres.
using CoupledSolver = decltype(&refit_coupled);
/// Called by use_coupled_refit().
SUNDER_API void set_coupled_solver(CoupledSolver solver);
/// Whether it was.
[[nodiscard]] SUNDER_API bool has_coupled_refit();

}  // namespace sunder
