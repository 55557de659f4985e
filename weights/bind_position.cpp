#include "weights/internal/bind_position.h"

#include <algorithm>

#include <Eigen/LU>

namespace sunder {

std::optional<Vec3d> solve_bind_position(std::span<const Influence> influences, const Vec3d& posed,
                                         std::span<const Affine3d> model_from_bind) {
  Eigen::Matrix3d linear = Eigen::Matrix3d::Zero();
  Eigen::Vector3d translation = Eigen::Vector3d::Zero();
  double largest = 0;
  for (const Influence& influence : influences) {
    const Affine3d& bone = model_from_bind[influence.slot];
    const double weight = static_cast<double>(influence.weight);
    linear += weight * bone.linear();
    translation += weight * bone.translation();
    largest = std::max(largest, bone.linear().norm());
  }
  Eigen::Matrix3d inverse;
  bool is_invertible = false;
  linear.computeInverseWithCheck(inverse, is_invertible, 0.0);
  if (!is_invertible || !(inverse.norm() * largest / 3 <= kLargestAmplification))
    return std::nullopt;
  return Vec3d(inverse * (Eigen::Vector3d(posed) - translation));
}

}  // namespace sunder
