#include "io/assimp/transform.h"

#include <algorithm>
#include <cmath>

#include <Eigen/LU>
#include <Eigen/SVD>

namespace sunder::assimp_import {

Mat4d to_eigen(const aiMatrix4x4& matrix) {
  Mat4d result;
  for (unsigned row = 0; row < 4; ++row)
    for (unsigned column = 0; column < 4; ++column)
      result(row, column) = static_cast<double>(matrix[row][column]);
  return result;
}

Mat4d matrix_of(const Trs& trs) {
  Mat4d result = Mat4d::Identity();
  result.topLeftCorner<3, 3>() = trs.rotation.toRotationMatrix() * trs.scale.asDiagonal();
  result.topRightCorner<3, 1>() = trs.translation;
  return result;
}

Trs decompose(const Mat4d& matrix) {
  Trs trs;
  trs.translation = matrix.topRightCorner<3, 1>();
  Mat3d axes = matrix.topLeftCorner<3, 3>();
  trs.scale = axes.colwise().norm().transpose();
  if (axes.determinant() < 0.0) trs.scale = -trs.scale;
  const double longest = trs.scale.cwiseAbs().maxCoeff();
  // The matrix maps everything to a point; any rotation is valid.
  if (!(longest > 0.0)) return trs;

  int collapsed = 0, last_collapsed = 0;
  for (int i = 0; i < 3; ++i) {
    if (std::abs(trs.scale[i]) > 1e-12 * longest) {
      axes.col(i) /= trs.scale[i];
    } else {
      axes.col(i).setZero();
      ++collapsed;
      last_collapsed = i;
    }
  }
  if (collapsed == 1) {
    axes.col(last_collapsed) =
        axes.col((last_collapsed + 1) % 3).cross(axes.col((last_collapsed + 2) % 3));
  } else if (collapsed == 2) {
    int kept = 0;
    while (axes.col(kept).isZero()) ++kept;
    const Quatd turn = Quatd::FromTwoVectors(Mat3d::Identity().col(kept), axes.col(kept));
    axes = turn.toRotationMatrix();
  }
  // The nearest rotation, so that axes with small errors share them.
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(axes, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Mat3d rotation = svd.matrixU() * svd.matrixV().transpose();
  if (rotation.determinant() < 0.0) rotation = -rotation;
  trs.rotation = Quatd(rotation).normalized();
  if (trs.rotation.w() < 0.0) trs.rotation.coeffs() = -trs.rotation.coeffs();
  return trs;
}

double linear_difference(const Mat4d& a, const Mat4d& b) {
  const double longest = a.topLeftCorner<3, 3>().colwise().norm().maxCoeff();
  const double difference = (a - b).topLeftCorner<3, 3>().cwiseAbs().maxCoeff();
  return longest > 0.0 ? difference / longest : difference;
}

ShearParts split_shear(const Mat4d& matrix) {
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(Eigen::Matrix3d(matrix.topLeftCorner<3, 3>()),
                                              Eigen::ComputeFullU | Eigen::ComputeFullV);
  Mat3d left = svd.matrixU();
  Mat3d right = svd.matrixV().transpose();
  Vec3d scale = svd.singularValues();
  // Moves a reflection from the rotations to the scale.
  if (left.determinant() < 0.0) {
    left = -left;
    scale = -scale;
  }
  if (right.determinant() < 0.0) {
    right = -right;
    scale = -scale;
  }
  ShearParts parts;
  parts.outer.translation = matrix.topRightCorner<3, 1>();
  parts.outer.rotation = Quatd(left).normalized();
  parts.outer.scale = scale;
  parts.inner.rotation = Quatd(right).normalized();
  return parts;
}

bool is_usable_bind(const Mat4d& matrix) {
  if (!matrix.allFinite()) return false;
  const Eigen::RowVector4d affine(0.0, 0.0, 0.0, 1.0);
  if ((matrix.row(3) - affine).cwiseAbs().maxCoeff() > 1e-6) return false;
  const Mat3d linear = matrix.topLeftCorner<3, 3>();
  const Vec3d lengths = linear.colwise().norm().transpose();
  // Determinant of the unit axes; near 0 if they lie in one plane.
  return lengths.minCoeff() > 1e-12 * lengths.maxCoeff() &&
         std::abs(linear.determinant()) > 1e-7 * lengths.prod();
}

}  // namespace sunder::assimp_import
