#pragma once

#include <sunder/core/math.h>

#include <Eigen/SVD>

namespace sunder::certificate {

/// A matrix as a rotation, or a reflection, after a stretch; the least and the largest stretch.
struct Polar {
  Mat3d rotation;
  double least = 0.0, largest = 0.0;
};

[[nodiscard]] inline Polar polar(const Mat3d& matrix) {
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(matrix, Eigen::ComputeFullU | Eigen::ComputeFullV);
  return {svd.matrixU() * svd.matrixV().transpose(), svd.singularValues()[2],
          svd.singularValues()[0]};
}

}  // namespace sunder::certificate
