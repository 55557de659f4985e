#include "io/gltf/decompose.h"

#include <cmath>

#include <Eigen/SVD>

namespace sunder::gltf {
namespace {

Mat3d linear_of(const BoneTransform& transform) {
  return transform.rotation.cast<double>().toRotationMatrix() *
         transform.scale.cast<double>().asDiagonal();
}

/// Rotation of an orthonormal matrix of positive determinant, stored as floats.
Quatf to_rotation(const Mat3d& orthonormal) {
  Quatd rotation(orthonormal);
  rotation.normalize();
  return rotation.cast<float>();
}

}  // namespace

Decomposition decompose(const Affine3d& matrix) {
  const Mat3d linear = matrix.linear();
  const double largest = linear.cwiseAbs().maxCoeff();
  BoneTransform whole;
  whole.translation = matrix.translation().cast<float>();

  Vec3d scale(linear.col(0).norm(), linear.col(1).norm(), linear.col(2).norm());
  if (linear.determinant() < 0) scale.x() = -scale.x();
  if (scale.cwiseAbs().minCoeff() > 0) {
    whole.rotation = to_rotation(linear * scale.cwiseInverse().asDiagonal());
    whole.scale = scale.cast<float>();
    if ((linear_of(whole) - linear).cwiseAbs().maxCoeff() <= 1e-6 * largest)
      return {whole, std::nullopt};
  }

  // Dynamic size: gcc 12 warns of an uninitialised use in the fixed-size version's early return for
  // input that is not finite.
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(linear, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Mat3d u = svd.matrixU(), v = svd.matrixV();
  Vec3d singular = svd.singularValues();
  if (u.determinant() < 0) {
    u.col(2) = -u.col(2);
    singular.z() = -singular.z();
  }
  if (v.determinant() < 0) {
    v.col(2) = -v.col(2);
    singular.z() = -singular.z();
  }
  whole.rotation = to_rotation(u);
  whole.scale = singular.cast<float>();
  BoneTransform second;
  second.rotation = to_rotation(v.transpose());
  return {whole, second};
}

}  // namespace sunder::gltf
