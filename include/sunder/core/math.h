#pragma once

#include <sunder/core/index.h>

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace sunder {

// Eigen types whose layout does not depend on compiler flags (DontAlign), so that a host built with
// -mavx and a library built without it agree on every struct. Column vectors, right-handed; see
// docs/conventions.md.

using Vec2f = Eigen::Matrix<float, 2, 1, Eigen::DontAlign>;
using Vec3f = Eigen::Matrix<float, 3, 1, Eigen::DontAlign>;
using Vec4f = Eigen::Matrix<float, 4, 1, Eigen::DontAlign>;
using Vec2d = Eigen::Matrix<double, 2, 1, Eigen::DontAlign>;
using Vec3d = Eigen::Matrix<double, 3, 1, Eigen::DontAlign>;
using Vec4d = Eigen::Matrix<double, 4, 1, Eigen::DontAlign>;
using Mat3f = Eigen::Matrix<float, 3, 3, Eigen::DontAlign>;
using Mat3d = Eigen::Matrix<double, 3, 3, Eigen::DontAlign>;

/// Memory order x, y, z, w (Eigen's and glTF's).
using Quatf = Eigen::Quaternion<float, Eigen::DontAlign>;
using Quatd = Eigen::Quaternion<double, Eigen::DontAlign>;

/// 3 x 4 affine transforms, column-major. Named to_from_from: `model_from_bone * bone_from_bind`.
using Affine3f = Eigen::Transform<float, 3, Eigen::AffineCompact, Eigen::DontAlign>;
using Affine3d = Eigen::Transform<double, 3, Eigen::AffineCompact, Eigen::DontAlign>;

}  // namespace sunder
