#pragma once

#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include "core/internal/ordered.h"
#include "validation/certificate/joint_tree.h"

namespace sunder::validation {

/// The sum of a subtree's terms, seen from the joint at its top: weight m, and a ball that holds
/// the position in every pose. One ball per lane.
template <int lanes>
struct SubtreeBall {
  std::uint32_t node = 0;
  double m = 0.0;
  std::array<double, lanes> x{}, y{}, z{}, radius{};
};

/// Adds the motion of the joint of `ball.node`: after it the ball is seen from the joint's parent.
template <int lanes>
void cross_joint(const PreparedJoint& joint, const JointTurn<lanes>& turn,
                 SubtreeBall<lanes>& ball) {
  const double m = ball.m, k = joint.scale(), h = joint.scale_half();
  const double growth = joint.scale_upper, sliding = std::abs(m) * joint.slide_reach;
  const Vec3d from = m * joint.centre, to = m * (joint.centre + joint.slide), a = joint.axis;
  for (std::size_t i = 0; i < lanes; ++i) {
    const double x = ball.x[i] - from.x(), y = ball.y[i] - from.y(), z = ball.z[i] - from.z();
    const double length = std::sqrt(x * x + y * y + z * z);
    double cx = 0, cy = 0, cz = 0, moved = length;
    if (joint.is_hinge) {
      const double along = a.x() * x + a.y() * y + a.z() * z;
      const double px = x - along * a.x(), py = y - along * a.y(), pz = z - along * a.z();
      const double cosine = turn.cosine[i], sine = turn.sine[i];
      cx = along * a.x() + cosine * px + sine * (a.y() * z - a.z() * y);
      cy = along * a.y() + cosine * py + sine * (a.z() * x - a.x() * z);
      cz = along * a.z() + cosine * pz + sine * (a.x() * y - a.y() * x);
      moved = std::sqrt(px * px + py * py + pz * pz);
    } else {
      cx = turn.cosine[i] * x;
      cy = turn.cosine[i] * y;
      cz = turn.cosine[i] * z;
    }
    ball.x[i] = to.x() + k * cx;
    ball.y[i] = to.y() + k * cy;
    ball.z[i] = to.z() + k * cz;
    ball.radius[i] = growth * ball.radius[i] + h * length + k * turn.radius[i] * moved + sliding;
  }
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

}  // namespace sunder::validation
