#include "weights/internal/bind_position.h"

#include <algorithm>

#include "core/internal/ordered.h"

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
    largest = std::max(largest, norm(bone.linear()));
  }
  const Mat3d bind_from_posed = inverse(linear);
  if (!(norm(bind_from_posed) * largest / 3 <=
        kLargestAmplification))  // nor where it is not finite
    return std::nullopt;
  return multiply(bind_from_posed, Eigen::Vector3d(posed) - translation);
}

}  // namespace sunder
