#pragma once

#include <vector>

#include <Eigen/SparseCore>

#include "pipeline/binding/welded_surface.h"

namespace sunder::binding {

/// How heat flows along a surface.
struct Stiffness {
  /// Minus the cotangent Laplacian, integrated: symmetric, rows sum to zero, no entry beside the
  /// diagonal is positive, so that heat never exceeds its sources (maximum principle).
  Eigen::SparseMatrix<double> matrix;
  std::vector<double> mass;  ///< Per point: a third of the area around it; > 0.
  std::uint32_t edges = 0, clamped_edges = 0;
};

/// Accepts every surface: an edge may have any number of faces, and faces without area conduct
/// weakly, so that what they join stays joined.
/// Sources: Pinkall and Polthier 1993 [pinkall1993computing].
[[nodiscard]] Stiffness make_stiffness(const WeldedSurface& surface);

}  // namespace sunder::binding
