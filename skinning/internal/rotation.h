#pragma once

#include <sunder/core/math.h>

#include <cmath>
#include <optional>

#include "core/internal/elementary.h"
#include "core/internal/ordered.h"

namespace sunder {

/// A rotation by a vector: its direction is the axis, its length the angle in radians.
inline Quatd rotation_by(const Vec3d& vector) {
  const double angle = norm(vector);
  // sin(x / 2) / x by its series where the quotient has no digits.
  const double factor = angle > 1e-8 ? elementary::sin(0.5 * angle) / angle : 0.5;
  return {elementary::cos(0.5 * angle), factor * vector.x(), factor * vector.y(),
          factor * vector.z()};
}

/// A unit quaternion; identity for one without length.
template <class Scalar>
Eigen::Quaternion<Scalar, Eigen::DontAlign> unit(
    const Eigen::Quaternion<Scalar, Eigen::DontAlign>& rotation) {
  using Quat = Eigen::Quaternion<Scalar, Eigen::DontAlign>;
  const Scalar length = norm(rotation);
  return length > Scalar(0) ? Quat(rotation.coeffs() / length) : Quat(Quat::Identity());
}

template <class Scalar>
Eigen::Quaternion<Scalar, Eigen::DontAlign> conjugate(
    const Eigen::Quaternion<Scalar, Eigen::DontAlign>& q) {
  return {q.w(), -q.x(), -q.y(), -q.z()};
}

/// The rotation nearest to a matrix: its polar factor, by Newton's iteration (Higham 1986). Of a
/// mirroring matrix, the third axis is turned around first. Empty if the matrix is singular.
inline std::optional<Quatd> nearest_rotation(const Mat3d& matrix) {
  const double size = norm(matrix);
  if (!(size > 0.0) || !std::isfinite(size)) return std::nullopt;
  Mat3d x = matrix / size;
  if (determinant(x) < 0.0) x.col(2) = -x.col(2).eval();
  if (!(determinant(x) > 1e-12)) return std::nullopt;
  for (int i = 0; i < 60; ++i) {
    const Mat3d next = 0.5 * (x + inverse(x).transpose());
    const double change = norm(Mat3d(next - x));
    x = next;
    if (change < 1e-14) break;
  }
  if (!std::isfinite(norm(x))) return std::nullopt;
  return unit(Quatd(x));
}

}  // namespace sunder
