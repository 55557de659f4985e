#include "skinning/animation/internal/swing_twist.h"

#include "core/internal/elementary.h"
#include "skinning/internal/rotation.h"

namespace sunder::animation {

double twist_angle(const Quatd& rotation, const Vec3d& axis) {
  return 2.0 * elementary::atan2(dot(rotation.vec(), axis), rotation.w());
}

SwingTwist split_rotation(const Quatd& rotation, const Vec3d& axis) {
  const double along = dot(rotation.vec(), axis);
  Quatd twist(rotation.w(), along * axis.x(), along * axis.y(), along * axis.z());
  twist = norm(twist) > 1e-9 ? unit(twist) : Quatd(Quatd::Identity());
  Quatd swing = multiply(rotation, conjugate(twist));
  if (swing.w() < 0.0) swing.coeffs() = -swing.coeffs();
  return {swing, 2.0 * elementary::atan2(norm(swing.vec()), swing.w()), twist_angle(twist, axis)};
}

}  // namespace sunder::animation
