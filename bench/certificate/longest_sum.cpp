// A cell holds rotations: those of a ball are vectors along the axis with the angle as length, of
// which only those across its arm count where nothing below the joint moves; those of a hinge are
// angles. One joint below the top takes its best rotation in closed form. The exponential map does
// not lengthen distances, so a cell of the half diagonal r turns an arm by at most r away from
// where its centre puts it.

#include "bench/certificate/longest_sum.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include <Eigen/Geometry>

namespace sunder::bench {
namespace {

using Eigen::Vector3d;

constexpr std::size_t kMostJoints = 6;

/// Parameters of one joint: a box of up to three dimensions.
struct Box {
  Vector3d centre = Vector3d::Zero(), half = Vector3d::Zero();
};

struct Cell {
  std::array<Box, kMostJoints> boxes;
};

/// A vector known up to a radius.
struct Ball {
  Vector3d centre = Vector3d::Zero();
  double radius = 0.0;
};

/// What a cell is known to hold: a length that is reached, and one that is not exceeded.
struct Range {
  double reached = 0.0, bound = 0.0;
};

Vector3d turned(const Vector3d& v, const Vector3d& rotation) {
  const double angle = rotation.norm();
  return angle > 0 ? Vector3d(Eigen::AngleAxisd(angle, rotation / angle) * v) : v;
}

class Search {
 public:
  explicit Search(const std::vector<SumJoint>& joints)
      : joints_(joints), children_(joints.size()), is_plane_(joints.size(), false) {
    for (std::size_t i = 1; i < joints.size(); ++i) children_[joints[i].parent].push_back(i);
    for (std::size_t i = 1; i < joints.size(); ++i) {
      is_plane_[i] = children_[i].empty() && !joints[i].is_hinge;
      if (joints[i].parent == 0 && (closed_ == 0 || dimensions(i) > dimensions(closed_)))
        closed_ = i;
    }
  }

  LongestSum run(double accuracy, std::uint64_t most_cells) {
    LongestSum result;
    std::vector<std::pair<double, Cell>> open;
    const Cell whole = first_cell();
    const Range range = range_of(whole);
    result.least = range.reached;
    open.emplace_back(range.bound, whole);
    while (!open.empty() && result.cells < most_cells) {
      const auto [bound, cell] = open.back();
      open.pop_back();
      ++result.cells;
      if (bound <= (1 + accuracy) * result.least) {
        result.most = std::max(result.most, bound);
        continue;
      }
      split(cell, open, result);
    }
    result.most = std::max(result.most, result.least);
    for (const auto& [bound, cell] : open) result.most = std::max(result.most, bound);
    return result;
  }

 private:
  [[nodiscard]] int dimensions(std::size_t i) const {
    return joints_[i].is_hinge ? 1 : is_plane_[i] ? 2 : 3;
  }

  [[nodiscard]] Cell first_cell() const {
    Cell cell;
    for (std::size_t i = 1; i < joints_.size(); ++i)
      if (i != closed_)
        for (int k = 0; k < dimensions(i); ++k)
          cell.boxes[i].half[k] = std::min(joints_[i].angle, std::numbers::pi);
    return cell;
  }

  /// Halves a cell where that narrows the sum most. The half with the larger bound is tried first.
  void split(const Cell& cell, std::vector<std::pair<double, Cell>>& open,
             LongestSum& result) const {
    std::size_t joint = 0;
    double widest = -1;
    const auto lengths = lengths_of(cell);
    for (std::size_t i = 1; i < joints_.size(); ++i) {
      const double width = cell.boxes[i].half.norm() * lengths[i];
      if (i == closed_ || width <= widest) continue;
      widest = width;
      joint = i;
    }
    int axis = 0;
    cell.boxes[joint].half.maxCoeff(&axis);
    std::vector<std::pair<double, Cell>> halves;
    for (const double side : {-0.5, 0.5}) {
      Cell half = cell;
      Box& box = half.boxes[joint];
      box.centre[axis] += side * box.half[axis];
      box.half[axis] *= 0.5;
      if (is_out_of_range(joint, box)) continue;
      const Range range = range_of(half);
      result.least = std::max(result.least, range.reached);
      halves.emplace_back(range.bound, half);
    }
    std::sort(halves.begin(), halves.end(),
              [](const auto& a, const auto& b) { return a.first < b.first; });
    open.insert(open.end(), halves.begin(), halves.end());
  }

  /// Whether every rotation of a box is larger than the joint's limit.
  [[nodiscard]] bool is_out_of_range(std::size_t i, const Box& box) const {
    return (box.centre.cwiseAbs() - box.half).cwiseMax(0.0).norm() > joints_[i].angle;
  }

  /// What a joint adds to its parent: its arm turned by the centre of its box.
  [[nodiscard]] Vector3d posed(std::size_t i, const Vector3d& arm, Vector3d rotation) const {
    if (joints_[i].is_hinge) return turned(arm, rotation[0] * joints_[i].axis);
    if (!is_plane_[i]) return turned(arm, rotation);
    const Vector3d u = arm.unitOrthogonal(), v = arm.normalized().cross(u);
    return turned(arm, rotation[0] * u + rotation[1] * v);
  }

  [[nodiscard]] std::array<double, kMostJoints> lengths_of(const Cell& cell) const {
    std::array<double, kMostJoints> lengths = {};
    std::array<Vector3d, kMostJoints> arms;
    for (std::size_t i = joints_.size(); i-- > 0;) {
      arms[i] = joints_[i].own;
      for (const std::size_t child : children_[i])
        if (child != closed_) arms[i] += posed(child, arms[child], cell.boxes[child].centre);
      lengths[i] = arms[i].norm();
    }
    return lengths;
  }

  /// @param is_reached  centres are moved into the limits, so that the sum is one that occurs.
  [[nodiscard]] double sum_of(const Cell& cell, bool is_reached, double& radius) const {
    std::array<Ball, kMostJoints> balls;
    for (std::size_t i = joints_.size(); i-- > 0;) {
      balls[i].centre += joints_[i].own;
      if (i == 0 || i == closed_) continue;
      const Box& box = cell.boxes[i];
      Vector3d rotation = box.centre;
      if (is_reached && rotation.norm() > joints_[i].angle)
        rotation *= joints_[i].angle / rotation.norm();
      const double width = std::min(box.half.norm(), std::numbers::pi);
      Ball& parent = balls[joints_[i].parent];
      parent.centre += posed(i, balls[i].centre, rotation);
      parent.radius += balls[i].radius + 2 * std::sin(width / 2) * balls[i].centre.norm();
    }
    radius = balls[0].radius + balls[closed_].radius;
    return longest_turned(balls[0].centre, balls[closed_].centre);
  }

  [[nodiscard]] Range range_of(const Cell& cell) const {
    double radius = 0, unused = 0;
    const double bound = sum_of(cell, false, radius);
    return {sum_of(cell, true, unused), bound + radius};
  }

  /// The largest |rest + R arm| over the rotations of the joint in closed form.
  [[nodiscard]] double longest_turned(const Vector3d& rest, const Vector3d& arm) const {
    const SumJoint& joint = joints_[closed_];
    if (!joint.is_hinge) {
      const double between = std::atan2(rest.cross(arm).norm(), rest.dot(arm));
      const double left = std::max(0.0, between - joint.angle);
      return std::sqrt(rest.squaredNorm() + arm.squaredNorm() +
                       2 * rest.norm() * arm.norm() * std::cos(left));
    }
    const double best = std::atan2(joint.axis.dot(arm.cross(rest)),
                                   arm.dot(rest) - joint.axis.dot(arm) * joint.axis.dot(rest));
    const double angle = std::clamp(best, -joint.angle, joint.angle);
    return (rest + turned(arm, angle * joint.axis)).norm();
  }

  const std::vector<SumJoint>& joints_;
  std::vector<std::vector<std::size_t>> children_;
  std::vector<bool> is_plane_;  // balls with nothing below: rotations across the arm are enough
  std::size_t closed_ = 0;
};

}  // namespace

LongestSum longest_sum(const std::vector<SumJoint>& joints, double accuracy,
                       std::uint64_t most_cells) {
  return Search(joints).run(accuracy, most_cells);
}

}  // namespace sunder::bench
