#include "pipeline/ragdoll/joint_frames.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/internal/elementary.h"
#include "core/internal/ordered.h"
#include "skinning/animation/internal/swing_twist.h"
#include "skinning/internal/rotation.h"

namespace sunder::ragdoll {
namespace {

/// Radians: a hinge whose bone stands farther off its axis becomes a cone.
constexpr double kOffAxis = 1e-3;
constexpr double kHingeTilt = 0.1;   ///< Radians by which the axis of a hinge may swing in clips.
constexpr double kHingeTurn = 0.15;  ///< Radians: smaller turns do not show an axis.
constexpr double kStill = 1e-3;      ///< Radians: smaller turns are rounding.
constexpr double kMargin = 0.2;      ///< Radians beyond what the clips show.
constexpr double kUnmoved = 0.5;     ///< Radians: cone and twist of joints that no clip turns.

/// A right-handed frame whose x axis is along a vector.
Mat3d frame_along(const Vec3d& vector) {
  Mat3d frame;
  frame.col(0) = normalized(Vec3d(vector / vector.cwiseAbs().maxCoeff()));
  int least = 0;
  frame.col(0).cwiseAbs().minCoeff(&least);
  frame.col(1) = normalized(Vec3d(Vec3d::Unit(least).cross(Vec3d(frame.col(0)))));
  frame.col(2) = frame.col(0).cross(frame.col(1));
  return frame;
}

/// The angle by whole turns nearer to a range.
double near_range(double angle, double lower, double upper) {
  constexpr double kTurn = 2.0 * std::numbers::pi;
  for (const double other : {angle - kTurn, angle + kTurn})
    if (other >= lower && other <= upper) return other;
  return angle;
}

/// The limit with a turn from rest in it. @param axis  of the limit, unit length.
BoneLimit widened(BoneLimit limit, const Vec3d& axis, Quatd turn) {
  if (turn.w() < 0.0) turn.coeffs() = -turn.coeffs();
  const animation::SwingTwist parts = animation::split_rotation(turn, axis);
  double twist = parts.twist_angle;
  if (!(twist >= limit.lower && twist <= limit.upper))
    twist = near_range(twist, limit.lower, limit.upper);
  limit.lower = std::min(limit.lower, twist);
  limit.upper = std::max(limit.upper, twist);
  if (limit.kind == BoneLimit::Kind::hinge && parts.swing_angle > kOffAxis) {
    limit.kind = BoneLimit::Kind::cone;
    limit.cone = 0.0;
  }
  if (limit.kind == BoneLimit::Kind::cone) limit.cone = std::max(limit.cone, parts.swing_angle);
  return limit;
}

/// The range of twists and the greatest swing about a unit axis; rest is within.
BoneLimit range_about(const Vec3d& axis, const std::vector<Quatd>& turns) {
  BoneLimit range{BoneLimit::Kind::cone, 0, axis, 0.0, 0.0, 0.0};
  for (const Quatd& turn : turns) {
    const animation::SwingTwist parts = animation::split_rotation(turn, axis);
    range.lower = std::min(range.lower, parts.twist_angle);
    range.upper = std::max(range.upper, parts.twist_angle);
    range.cone = std::max(range.cone, parts.swing_angle);
  }
  return range;
}

double angle_of(const Quatd& turn) { return 2.0 * elementary::atan2(norm(turn.vec()), turn.w()); }

Vec3d unit_axis(const BoneLimit& limit) {
  return normalized(Vec3d(limit.axis / limit.axis.cwiseAbs().maxCoeff()));
}

Affine3d rigid(const Mat3d& turn, const Vec3d& place) {
  Affine3d frame = Affine3d::Identity();
  frame.linear() = turn;
  frame.translation() = place;
  return frame;
}

}  // namespace

std::optional<Affine3d> rigid_frame(const Affine3d& model_from_bone) {
  const std::optional<Quatd> turn = nearest_rotation(Mat3d(model_from_bone.linear()));
  if (!turn) return std::nullopt;
  return rigid(Mat3d(turn->toRotationMatrix()), Vec3d(model_from_bone.translation()));
}

Affine3d inverse_of_rigid(const Affine3d& frame) {
  const Mat3d back = frame.linear().transpose();
  return rigid(back, Vec3d(-multiply(back, Vec3d(frame.translation()))));
}

Quatd turn_between(const ModelPose& pose, std::uint32_t from, std::uint32_t to) {
  const std::optional<Affine3d> a = rigid_frame(pose.model_from_bone[from]);
  const std::optional<Affine3d> b = rigid_frame(pose.model_from_bone[to]);
  if (!a || !b) return Quatd::Identity();
  return unit(Quatd(multiply(Mat3d(a->linear().transpose()), Mat3d(b->linear()))));
}

Joint given_joint(const Skeleton& skeleton, const ModelPose& rest, const BoneLimit& limit,
                  std::uint32_t parent_bone, std::uint32_t bone) {
  Joint joint{turn_between(rest, parent_bone, bone), limit};
  // The axis by the matrix of the parent, which may mirror: a turn looks reversed there.
  const Bone& of = skeleton.bones[limit.bone];
  Vec3d axis =
      multiply(unit(Quatd(of.rest.rotation.cast<double>())).toRotationMatrix(), unit_axis(limit));
  if (of.parent != kNone) {
    const Mat3d above = rest.model_from_bone[of.parent].linear();
    axis = multiply(above, axis);
    if (determinant(above) < 0.0) axis = -axis;
  }
  if (const std::optional<Affine3d> frame = rigid_frame(rest.model_from_bone[bone]))
    axis = multiply(Mat3d(frame->linear().transpose()), axis);
  if (norm(axis) > 0.0) joint.limit.axis = normalized(axis);
  return joint;
}

Joint shown_joint(const Quatd& rest, std::vector<Quatd> turns, const Vec3d& direction) {
  for (Quatd& turn : turns)
    if (turn.w() < 0.0) turn.coeffs() = -turn.coeffs();
  const auto most = std::ranges::min_element(turns, {}, [](const Quatd& turn) { return turn.w(); });
  if (most == turns.end() || angle_of(*most) < kStill)
    return {rest, {BoneLimit::Kind::cone, 0, direction, -kUnmoved, kUnmoved, kUnmoved}};
  Joint joint{rest, range_about(direction, turns)};
  if (angle_of(*most) >= kHingeTurn) {
    BoneLimit hinge = range_about(normalized(Vec3d(most->vec())), turns);
    if (hinge.cone <= kHingeTilt) {
      hinge.kind = BoneLimit::Kind::hinge;
      joint.limit = hinge;
    }
  }
  const bool is_hinge = joint.limit.kind == BoneLimit::Kind::hinge;
  joint.limit.lower -= kMargin;
  joint.limit.upper += kMargin;
  joint.limit.cone = is_hinge ? 0.0 : std::min(joint.limit.cone + kMargin, std::numbers::pi);
  return joint;
}

void set_joint(const Joint& joint, const ModelPose& pose, const Vec3d& origin,
               const RagdollBody& parent, RagdollBody& body) {
  const Vec3d axis = unit_axis(joint.limit);
  const Quatd turned = turn_between(pose, parent.bone, body.bone);
  body.limit = widened(joint.limit, axis, unit(multiply(conjugate(joint.rest), turned)));
  body.limit.bone = body.bone;
  const Mat3d above =
      rigid_frame(pose.model_from_bone[parent.bone]).value_or(Affine3d::Identity()).linear();
  const Mat3d along = frame_along(axis);
  const auto joint_at = [&](const Quatd& turn) {
    return rigid(multiply(multiply(above, Mat3d(turn.toRotationMatrix())), along), origin);
  };
  body.parent_from_joint = multiply(inverse_of_rigid(parent.model_from_body), joint_at(joint.rest));
  body.body_from_joint = multiply(inverse_of_rigid(body.model_from_body), joint_at(turned));
}

}  // namespace sunder::ragdoll
