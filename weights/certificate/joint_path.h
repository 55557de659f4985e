#pragma once

#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include "core/internal/ordered.h"
#include "weights/certificate/joint_tree.h"

namespace sunder::certificate {

/// The sum of a subtree's terms, seen from the joint at its top: weight m, and a ball that holds
/// the position in every pose. One ball per lane.
template <int lanes>
struct SubtreeBall {
  std::uint32_t node = 0;
  double m = 0.0;
  Lanes<lanes> x, y, z, radius;

  /// A ball without extent.
  void set(std::uint32_t at, double weight, const Vec3d& position) {
    node = at;
    m = weight;
    x.setConstant(position.x());
    y.setConstant(position.y());
    z.setConstant(position.z());
    radius.setZero();
  }
  SubtreeBall& operator+=(const SubtreeBall& other) {
    m += other.m;
    x += other.x;
    y += other.y;
    z += other.z;
    radius += other.radius;
    return *this;
  }
};

/// Adds the motion of the joint of `ball.node`: after it the ball is seen from the joint's parent.
template <int lanes>
void cross_joint(const PreparedJoint& joint, const JointTurn<lanes>& turn,
                 SubtreeBall<lanes>& ball) {
  const double m = ball.m, k = joint.scale(), h = joint.scale_half();
  const Vec3d from = m * joint.centre, to = m * (joint.centre + joint.slide), a = joint.axis;
  const Lanes<lanes> x = ball.x - from.x(), y = ball.y - from.y(), z = ball.z - from.z();
  const Lanes<lanes> length = (x * x + y * y + z * z).sqrt();
  const Lanes<lanes> grown =
      joint.scale_upper * ball.radius + h * length + std::abs(m) * joint.slide_reach;
  if (!joint.is_hinge) {
    ball.x = to.x() + k * turn.cosine * x;
    ball.y = to.y() + k * turn.cosine * y;
    ball.z = to.z() + k * turn.cosine * z;
    ball.radius = grown + k * turn.radius * length;
    return;
  }
  const Lanes<lanes> along = a.x() * x + a.y() * y + a.z() * z;
  const Lanes<lanes> px = x - along * a.x(), py = y - along * a.y(), pz = z - along * a.z();
  ball.x = to.x() + k * (along * a.x() + turn.cosine * px + turn.sine * (a.y() * z - a.z() * y));
  ball.y = to.y() + k * (along * a.y() + turn.cosine * py + turn.sine * (a.z() * x - a.x() * z));
  ball.z = to.z() + k * (along * a.z() + turn.cosine * pz + turn.sine * (a.x() * y - a.y() * x));
  ball.radius = grown + k * turn.radius * (px * px + py * py + pz * pz).sqrt();
}

/// A joint that lies between the terms of a point and the lowest joint that has all of them below.
struct PathJoint {
  std::uint32_t node = 0;
  std::uint32_t parent = 0;  ///< In the path; its own index at the top.
  double m = 0.0;            ///< Sum of the terms of this joint's own bones.
  Vec3d x = Vec3d::Zero();
};

/// The joints of a point, descending by node: children before parents, the top last.
/// Not empty if there are terms. Allocates.
[[nodiscard]] std::vector<PathJoint> make_path(const JointTree::State& tree,
                                               std::span<const SkinTerm> terms);

/// Sums of what the joints between two nodes do.
struct Way {
  double angle = 0.0;
  double strain = 0.0;
};
[[nodiscard]] Way way_between(const JointTree::State& tree, std::uint32_t a, std::uint32_t b);

/// The reason why a joint on the way to the top, or above it, rules out a certificate.
struct PathGap {
  CertificateGap::Reason reason = CertificateGap::Reason::unequal_sums;
  std::uint32_t bone = kNone;
};

/// @return whether there is a gap.
[[nodiscard]] bool find_gap(const JointTree::State& tree, std::span<const SkinTerm> terms,
                            PathGap& gap);

/// The rows' offsets and bones exist and the numbers are finite.
[[nodiscard]] Status check_rows(const JointTree::State& tree, const SkinDifferences& rows);

[[nodiscard]] inline std::span<const SkinTerm> row_of(const SkinDifferences& rows,
                                                      std::size_t point) {
  return {rows.terms.data() + rows.first[point], rows.first[point + 1] - rows.first[point]};
}

}  // namespace sunder::certificate
