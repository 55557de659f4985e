#include "skinning/animation/joint_range.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/internal/rotation_about.h"
#include "skinning/animation/internal/swing_twist.h"
#include "skinning/internal/rotation.h"

namespace sunder::animation {
namespace {

constexpr double kTurn = 2.0 * std::numbers::pi;

/// The angle plus whole turns, within the range; the limit that is nearer on the circle if there is
/// no such angle.
double into_range(double angle, double lower, double upper) {
  if (upper - lower >= kTurn) return angle;
  const double above = angle + kTurn * std::ceil((lower - angle) / kTurn);
  if (above >= lower && above <= upper) return above;
  return above - upper <= lower - (above - kTurn) ? upper : lower;
}

}  // namespace

JointRange::JointRange(const BoneLimit& limit, const Quatd& rest)
    : kind_(limit.kind == BoneLimit::Kind::hinge ? Kind::hinge : Kind::cone),
      rest_(rest),
      axis_(normalized(Vec3d(limit.axis / limit.axis.cwiseAbs().maxCoeff()))),
      lower_(limit.lower),
      upper_(limit.upper),
      cone_(limit.cone) {}

Vec3d JointRange::axis_in_parent() const { return multiply(rest_.toRotationMatrix(), axis_); }

double JointRange::hinge_angle(const Quatd& rotation) const {
  return into_range(twist_angle(multiply(conjugate(rest_), rotation), axis_), lower_, upper_);
}

Quatd JointRange::hinge_at(double angle) const {
  return unit(multiply(rest_, rotation_about(angle, axis_)));
}

Quatd JointRange::clamped(const Quatd& rotation) const {
  switch (kind_) {
    case Kind::free: return rotation;
    case Kind::hinge: return hinge_at(hinge_angle(rotation));
    case Kind::cone:
      return unit(multiply(rest_, clamped_cone(multiply(conjugate(rest_), rotation))));
  }
  return rotation;
}

/// Swing and twist are limited each.
Quatd JointRange::clamped_cone(const Quatd& relative) const {
  const SwingTwist parts = split_rotation(relative, axis_);
  const double sine = norm(parts.swing.vec());
  const Quatd swing = parts.swing_angle > cone_ && sine > 0.0
                          ? rotation_about(cone_, parts.swing.vec() / sine)
                          : parts.swing;
  return multiply(swing, rotation_about(into_range(parts.twist_angle, lower_, upper_), axis_));
}

Quatd JointRange::turned(const Quatd& rotation, const Vec3d& turn) const {
  if (kind_ != Kind::hinge) return clamped(unit(multiply(rotation_by(turn), rotation)));
  const double angle = hinge_angle(rotation) + dot(turn, axis_in_parent());
  return hinge_at(upper_ - lower_ >= kTurn ? angle : std::clamp(angle, lower_, upper_));
}

}  // namespace sunder::animation
