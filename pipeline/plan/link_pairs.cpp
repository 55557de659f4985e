#include "pipeline/plan/link_pairs.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>
#include <variant>

#include <Eigen/Geometry>

#include "pipeline/plan/next_share.h"

namespace sunder::plan {
namespace {

constexpr int kHalvings = 48;     ///< Of a segment, by the golden ratio.
constexpr int kRandomPoses = 64;  ///< In which shapes are looked at that overlap always.
constexpr double kOften = 0.35;
constexpr std::uint64_t kPairSeed = 0x51e5;

/// The core of a ball or a capsule: a segment of this half length along the frame's y axis.
struct Core {
  double half_length = 0, radius = 0;
};

bool core_of(const Collider& collider, Core& core) {
  if (const auto* const ball = std::get_if<Collider::Sphere>(&collider.shape)) {
    core = {0, ball->radius};
    return true;
  }
  if (const auto* const capsule = std::get_if<Collider::Capsule>(&collider.shape)) {
    core = {capsule->half_length, capsule->radius};
    return true;
  }
  return false;
}

/// The distance from a convex shape is convex along a segment: a search by the golden ratio.
double least_along(const Core& core, const Collider& of, const Collider& other) {
  const Vec3d axis = of.turn * Vec3d(0, core.half_length, 0);
  const auto at = [&](double share) {
    return distance_to(other, of.place + share * axis).distance;
  };
  if (core.half_length == 0) return at(0);
  constexpr double kGolden = 0.6180339887498949;
  double low = -1, high = 1;
  double left = high - kGolden * (high - low), right = low + kGolden * (high - low);
  double at_left = at(left), at_right = at(right);
  for (int i = 0; i < kHalvings; ++i) {
    if (at_left < at_right) {
      high = right;
      right = left;
      at_right = at_left;
      at_left = at(left = high - kGolden * (high - low));
    } else {
      low = left;
      left = right;
      at_left = at_right;
      at_right = at(right = low + kGolden * (high - low));
    }
  }
  return std::min({at_left, at_right, at(-1), at(1)});
}

Eigen::Matrix3d axes_of(const Collider& box) {
  return Eigen::Quaterniond(box.turn).toRotationMatrix();
}

/// By separating axes (Gottschalk, Lin and Manocha 1996).
double between_boxes(const Collider& a, const Collider& b) {
  const Eigen::Matrix3d of_a = axes_of(a), of_b = axes_of(b);
  const Vec3d half_a = std::get<Collider::Box>(a.shape).half_size;
  const Vec3d half_b = std::get<Collider::Box>(b.shape).half_size;
  const Eigen::Vector3d away = b.place - a.place;
  double widest = -std::numeric_limits<double>::infinity();
  const auto try_axis = [&](const Eigen::Vector3d& axis) {
    const double length = axis.norm();
    if (length < 1e-9) return;  // of parallel edges
    const double reach = half_a.dot(Vec3d((of_a.transpose() * axis).cwiseAbs())) +
                         half_b.dot(Vec3d((of_b.transpose() * axis).cwiseAbs()));
    widest = std::max(widest, (std::abs(away.dot(axis)) - reach) / length);
  };
  for (Eigen::Index i = 0; i < 3; ++i) {
    try_axis(of_a.col(i));
    try_axis(of_b.col(i));
    for (Eigen::Index k = 0; k < 3; ++k) try_axis(of_a.col(i).cross(of_b.col(k)));
  }
  return widest;
}

double least_of_corners(const Collider& box, const Collider& other) {
  const Vec3d half = std::get<Collider::Box>(box.shape).half_size;
  double least = std::numeric_limits<double>::infinity();
  for (unsigned i = 0; i < 8; ++i) {
    const Vec3d corner((i & 1U) != 0 ? half.x() : -half.x(), (i & 2U) != 0 ? half.y() : -half.y(),
                       (i & 4U) != 0 ? half.z() : -half.z());
    least = std::min(least, distance_to(other, box.place + box.turn * corner).distance);
  }
  return least;
}

/// The link above fixed joints: links that they join are one.
std::uint32_t rigid_root(const Robot& robot, std::uint32_t link) {
  while (link != 0 && robot.joints[link - 1].type == RobotJointType::fixed)
    link = robot.links[link].parent;
  return link;
}

/// Half of the least width of a shape.
double thickness_of(const Collider& collider) {
  Core core;
  if (core_of(collider, core)) return core.radius;
  if (const auto* const box = std::get_if<Collider::Box>(&collider.shape))
    return box->half_size.minCoeff();
  return 0;
}

/// The joint between a link and its parent, and the one above it, are one joint of several axes if
/// their places are nearer to one another than `near`.
bool is_one_joint(const Robot& robot, std::uint32_t link, double near) {
  const std::uint32_t above = rigid_root(robot, robot.links[link].parent);
  Affine3d from_above = robot.joints[link - 1].parent_from_joint;
  for (std::uint32_t of = robot.links[link].parent; of != above; of = robot.links[of].parent)
    from_above = robot.joints[of - 1].parent_from_joint * from_above;
  return from_above.translation().norm() < near;
}

/// Whether one joint joins two links, which may have several axes.
/// @param near  what counts as one place, metres.
bool is_joined_below(const Robot& robot, std::uint32_t above, std::uint32_t below, double near) {
  above = rigid_root(robot, above);
  below = rigid_root(robot, below);
  while (below != above && below != 0) {
    const std::uint32_t next = rigid_root(robot, robot.links[below].parent);
    if (next == above) return true;
    if (next == 0 || !is_one_joint(robot, below, near)) return false;
    below = next;
  }
  return below == above;
}

bool are_neighbours(const Robot& robot, const BoneCollider& a, const BoneCollider& b) {
  const double near = std::min(thickness_of(a.collider), thickness_of(b.collider));
  return is_joined_below(robot, a.bone, b.bone, near) ||
         is_joined_below(robot, b.bone, a.bone, near);
}

}  // namespace

double radius_of(const Collider& collider) {
  if (const auto* const ball = std::get_if<Collider::Sphere>(&collider.shape)) return ball->radius;
  if (const auto* const capsule = std::get_if<Collider::Capsule>(&collider.shape))
    return capsule->radius + capsule->half_length;
  if (const auto* const box = std::get_if<Collider::Box>(&collider.shape))
    return box->half_size.norm();
  return std::numeric_limits<double>::infinity();
}

double distance_between(const Collider& a, const Collider& b) {
  Core core;
  if (core_of(a, core)) return least_along(core, a, b) - core.radius;
  if (core_of(b, core)) return least_along(core, b, a) - core.radius;
  const bool is_a_box = std::holds_alternative<Collider::Box>(a.shape);
  const bool is_b_box = std::holds_alternative<Collider::Box>(b.shape);
  if (is_a_box && is_b_box) return between_boxes(a, b);
  if (is_a_box) return least_of_corners(a, b);
  if (is_b_box) return least_of_corners(b, a);
  return std::numeric_limits<double>::infinity();  // two half-spaces
}

LinkPairs::LinkPairs(const PlanTool& tool) : tool_(&tool) {
  for (const BoneCollider& shape : tool.shapes) radii_.push_back(radius_of(shape.collider));
  for (std::size_t a = 0; a < tool.shapes.size(); ++a)
    for (std::size_t b = a + 1; b < tool.shapes.size(); ++b)
      if (!are_neighbours(tool.robot, tool.shapes[a], tool.shapes[b])) pairs_.push_back({a, b, 0});
  leave_out_coarse_ones();
}

void LinkPairs::leave_out_coarse_ones() {
  Result<RobotKinematics> kinematics = RobotKinematics::create(tool_->robot);
  if (!kinematics) return;
  std::vector<Affine3d> frames(tool_->robot.links.size());
  std::vector<int> overlapping(pairs_.size());
  std::uint64_t state = kPairSeed;
  for (int pose = 0; pose <= kRandomPoses; ++pose) {
    std::vector<double> values = rest_values(tool_->robot);
    for (std::size_t i = 0; i < values.size() && pose > 0; ++i) {
      const RobotValue& value = tool_->robot.values[i];
      const double low = std::max(value.lower, values[i] - 3),
                   high = std::min(value.upper, values[i] + 3);
      values[i] = low + next_share(state) * (high - low);
    }
    if (!kinematics->evaluate(values, frames)) continue;
    for (std::size_t i = 0; i < pairs_.size(); ++i)
      if (distance(pairs_[i], frames, 0) < 0) overlapping[i] += pose == 0 ? kRandomPoses : 1;
  }
  std::size_t kept = 0;
  for (std::size_t i = 0; i < pairs_.size(); ++i)
    if (overlapping[i] < kOften * kRandomPoses) pairs_[kept++] = pairs_[i];
  pairs_.resize(kept);
}

double LinkPairs::distance(const Near& pair, std::span<const Affine3d> frames, double most) const {
  const BoneCollider &a = tool_->shapes[pair.a], &b = tool_->shapes[pair.b];
  const Vec3d apart = frames[a.bone] * a.collider.place - frames[b.bone] * b.collider.place;
  if (apart.norm() - radii_[pair.a] - radii_[pair.b] >= most) return most;
  return std::min(
      most, distance_between(posed_collider(a, frames[a.bone]), posed_collider(b, frames[b.bone])));
}

LinkPairs::Near LinkPairs::nearest(std::span<const Affine3d> frames, double most) const {
  Near nearest{0, 0, most};
  for (const Near& pair : pairs_) {
    const double of_pair = distance(pair, frames, nearest.distance);
    if (of_pair < nearest.distance) nearest = {pair.a, pair.b, of_pair};
  }
  return nearest;
}

std::vector<LinkPairs::Near> LinkPairs::overlaps(std::span<const Affine3d> frames) const {
  std::vector<Near> found;
  for (const Near& pair : pairs_)
    if (const double of_pair = distance(pair, frames, 0); of_pair < 0)
      found.push_back({pair.a, pair.b, of_pair});
  return found;
}

}  // namespace sunder::plan
