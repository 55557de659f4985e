#pragma once

#include <sunder/core/math.h>

#include <assimp/types.h>

namespace sunder::assimp_import {

using Mat4d = Eigen::Matrix<double, 4, 4, Eigen::DontAlign>;
using Mat4f = Eigen::Matrix<float, 4, 4, Eigen::DontAlign>;

[[nodiscard]] Mat4d to_eigen(const aiMatrix4x4& matrix);

/// translation * rotation * scale, the only transforms that a glTF node can have.
struct Trs {
  Vec3d translation = Vec3d::Zero();
  Quatd rotation = Quatd::Identity();
  Vec3d scale = Vec3d::Ones();
};

[[nodiscard]] Mat4d matrix_of(const Trs& trs);

/// Nearest Trs of an affine matrix: exact unless its axes are not at right angles. A mirrored
/// matrix gets three negative scales, as assimp's own decomposition does, so that rest and key
/// frames agree.
[[nodiscard]] Trs decompose(const Mat4d& matrix);

/// Largest difference between the two linear parts, relative to the longest axis.
[[nodiscard]] double linear_difference(const Mat4d& a, const Mat4d& b);

/// Two transforms whose product, outer first, is `matrix`: any affine map is a rotation, a scale
/// along axes, another rotation.
struct ShearParts {
  Trs outer, inner;
};
[[nodiscard]] ShearParts split_shear(const Mat4d& matrix);

/// Whether the matrix is finite, affine and has an inverse that floats can hold.
[[nodiscard]] bool is_usable_bind(const Mat4d& matrix);

}  // namespace sunder::assimp_import
