#pragma once

#include <sunder/core/math.h>

#include <algorithm>
#include <cmath>

namespace sunder::skinning {

/// How far a matrix may be from a scaled rotation, relative to its scale squared, to count as one:
/// what a float file leaves of it.
inline constexpr double kEvenScale = 1e-5;

/// Whether a linear map scales all directions alike, as rotations, uniform scales and their mirrors
/// do: it turns normals as vectors.
template <class Scalar, class Matrix>
bool has_even_scale(const Matrix& linear) {
  const Eigen::Matrix<Scalar, 3, 3> gram = linear.transpose() * linear;
  const Scalar mean = gram.trace() / Scalar(3);
  return (gram - mean * Eigen::Matrix<Scalar, 3, 3>::Identity()).cwiseAbs().maxCoeff() <=
         Scalar(kEvenScale) * mean;
}

/// How a linear map turns normals: itself where it scales evenly; else the inverse transpose, at
/// the map's own scale, so that bones count in a blend by their weights, whatever their scales. It
/// is taken from the cofactors, which exist for flat maps too; the determinant's sign keeps outward
/// normals outward under mirrors. Zero where the map leaves no plane.
template <class Scalar, class Matrix>
Eigen::Matrix<Scalar, 3, 3> normal_matrix(const Matrix& linear) {
  if (has_even_scale<Scalar>(linear)) return linear;
  const Scalar scale = linear.cwiseAbs().maxCoeff();  // not 0: that would be even
  const Eigen::Matrix<Scalar, 3, 3> unit = linear / scale;
  Eigen::Matrix<Scalar, 3, 3> cofactors;
  cofactors.col(0) = unit.col(1).cross(unit.col(2));
  cofactors.col(1) = unit.col(2).cross(unit.col(0));
  cofactors.col(2) = unit.col(0).cross(unit.col(1));
  const Scalar norm = cofactors.norm();
  if (!(norm > Scalar(1e-20))) return Eigen::Matrix<Scalar, 3, 3>::Zero();
  const Scalar sign = unit.col(0).dot(cofactors.col(0)) < Scalar(0) ? Scalar(-1) : Scalar(1);
  return (sign * linear.norm() / norm) * cofactors;
}

}  // namespace sunder::skinning
