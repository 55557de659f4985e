#pragma once

#include <sunder/core/mesh.h>

#include <span>
#include <vector>

#include <Eigen/SparseCore>

namespace sunder::validation {

/// The cotangent Laplacian of a surface and the area around each point.
struct Laplacian {
  /// Minus the Laplacian: symmetric, positive semidefinite, rows sum to zero. Free of the unit.
  Eigen::SparseMatrix<double, Eigen::RowMajor> stiffness;
  std::vector<double>
      mass;  ///< Per point; squared unit of the positions. At least 1e-6 of the mean.
  Index edges = 0;
  Index clamped_edges = 0;
  Index floored_points = 0;
};

/// The weight of an edge is the mean cotangent of the angles opposite to it, clamped to [0.01,
/// 100], so that obtuse and thin triangles and edges of many faces give no negative and no huge
/// weight. Areas are mixed Voronoi areas. Source: Meyer, Desbrun, Schröder, Barr, Discrete
/// differential-geometry operators for triangulated 2-manifolds, 2003 [meyer2003discrete].
[[nodiscard]] Laplacian make_laplacian(std::span<const Vec3d> positions,
                                       std::span<const Triangle> triangles);

}  // namespace sunder::validation
