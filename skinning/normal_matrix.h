#pragma once

#include <sunder/core/math.h>

#include <algorithm>
#include <cmath>

#include "core/internal/ordered.h"

namespace sunder::skinning {

/// Maximum deviation from a scaled rotation, relative to the squared scale, that still counts as
/// one: the rounding of floats in files.
inline constexpr double kEvenScale = 1e-5;

/// Whether a linear map scales all directions alike (rotation, uniform scale, mirror), so that it
/// transforms normals like vectors.
template <class Scalar, class Matrix>
bool has_even_scale(const Matrix& linear) {
  const Eigen::Matrix<Scalar, 3, 3> gram = multiply(linear.transpose(), linear);
  const Scalar mean = trace(gram) / Scalar(3);
  return (gram - mean * Eigen::Matrix<Scalar, 3, 3>::Identity()).cwiseAbs().maxCoeff() <=
         Scalar(kEvenScale) * mean;
}

/// The matrix that transforms normals: the map itself if it scales evenly; otherwise its inverse
/// transpose at the map's own scale, so that bones count in a blend by their weights, whatever
/// their scales. It is computed from the cofactors, which exist for flat maps too; the sign of the
/// determinant keeps outward normals outward under mirrors. Zero if the map has rank below 2.
template <class Scalar, class Matrix>
Eigen::Matrix<Scalar, 3, 3> normal_matrix(const Matrix& linear) {
  if (has_even_scale<Scalar>(linear)) return linear;
  const Scalar scale = linear.cwiseAbs().maxCoeff();  // not 0, which would be even
  const Eigen::Matrix<Scalar, 3, 3> unit = linear / scale;
  Eigen::Matrix<Scalar, 3, 3> cofactors;
  cofactors.col(0) = unit.col(1).cross(unit.col(2));
  cofactors.col(1) = unit.col(2).cross(unit.col(0));
  cofactors.col(2) = unit.col(0).cross(unit.col(1));
  const Scalar size = norm(cofactors);
  if (!(size > Scalar(1e-20))) return Eigen::Matrix<Scalar, 3, 3>::Zero();
  const Scalar sign = dot(unit.col(0), cofactors.col(0)) < Scalar(0) ? Scalar(-1) : Scalar(1);
  return (sign * norm(linear) / size) * cofactors;
}

}  // namespace sunder::skinning
