#include "tear/geometry/box.h"

#include "core/internal/ordered.h"
#include "tear/geometry/tolerances.h"

namespace sunder::tear {
namespace {

/// The unit vector, or zero if the vector has no direction.
Vec3d unit_or_zero(const Vec3d& vector) {
  const double largest = vector.cwiseAbs().maxCoeff();
  if (!(largest > 0) || !std::isfinite(largest)) return Vec3d::Zero();
  const Vec3d scaled = vector / largest;  // otherwise the square of its length may overflow
  return scaled / norm(scaled);
}

}  // namespace

Mat3d axes_along(const Vec3d& first, const Vec3d& second) {
  const Vec3d x = unit_or_zero(first);
  if (x.isZero(0)) return Mat3d::Identity();
  const Vec3d towards = unit_or_zero(second);
  const Vec3d across = towards - dot(x, towards) * x;
  Vec3d y = norm(across) > kAxisSine ? Vec3d(across / norm(across)) : Vec3d(x.unitOrthogonal());
  y -= dot(x, y) * x;
  y /= norm(y);
  Mat3d axes;
  axes << x.transpose(), y.transpose(), x.cross(y).transpose();
  return axes;
}

}  // namespace sunder::tear
