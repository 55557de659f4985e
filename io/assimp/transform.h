#pragma once

#include <sunder/core/math.h>

#include <assimp/types.h>

namespace sunder::assimp_import {

using Mat4d = Eigen::Matrix<double, 4, 4, Eigen::DontAlign>;
using Mat4f = Eigen::Matrix<float, 4, 4, Eigen::DontAlign>;

[[nodiscard]] Mat4d to_eigen(const aiMatrix4x4& matrix);

/// translation * rotation * scale, the only transform that a glTF node can have.
struct Trs {
  Vec3d translation = Vec3d::Zero();
  Quatd rotation = Quatd::Identity();
  Vec3d scale = Vec3d::Ones();
};

[[nodiscard]] Mat4d matrix_of(const Trs& trs);

/// The nearest Trs of an affine matrix; exact if its axes are at right angles. A mirrored matrix
/// gets three negative scales, as in assimp's own decomposition, so that rest and keyframes agree.
[[nodiscard]] Trs decompose(const Mat4d& matrix);

/// Largest difference between the two linear parts, relative to the longest axis.
[[nodiscard]] double linear_difference(const Mat4d& a, const Mat4d& b);

/// Two transforms whose product, outer first, is `matrix`: any linear map is a rotation, a scale
/// along axes, and another rotation.
struct ShearParts {
  Trs outer, inner;
};
[[nodiscard]] ShearParts split_shear(const Mat4d& matrix);

/// Whether the matrix is finite and affine, with an inverse that fits into floats.
[[nodiscard]] bool is_usable_bind(const Mat4d& matrix);

}  // namespace sunder::assimp_import
