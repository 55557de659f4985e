#include "bench/plan/link_gaps.h"

#include <algorithm>
#include <cmath>
#include <variant>

#include "support/machine/random.h"

namespace sunder::bench {
namespace {

constexpr int kMostRounds = 200;
constexpr double kAccuracy = 1e-5;  ///< Of the sizes.
constexpr int kRandomValues = 1000;
constexpr double kOften = 0.35;  ///< A pair that overlaps in more of them is left out.
constexpr double kFromRest = 3;  ///< Radians or metres.

/// What is left of a shape without its radius: a box around its frame's origin, which may be flat.
struct Core {
  Eigen::Vector3d half = Eigen::Vector3d::Zero();
  double radius = 0;
};

Core core_in(const Collider& of) {
  Core core;
  if (const auto* const ball = std::get_if<Collider::Sphere>(&of.shape)) core.radius = ball->radius;
  if (const auto* const capsule = std::get_if<Collider::Capsule>(&of.shape)) {
    core.half.y() = capsule->half_length;
    core.radius = capsule->radius;
  }
  if (const auto* const box = std::get_if<Collider::Box>(&of.shape)) core.half = box->half_size;
  return core;
}

Vec3d projected(const Core& core, const Collider& of, const Vec3d& place) {
  const Eigen::Vector3d local = of.turn.conjugate() * (place - of.place);
  return of.place + of.turn * Vec3d(local.cwiseMax(-core.half).cwiseMin(core.half));
}

/// How far a core reaches along a direction from its frame's origin.
double reach_of(const Core& core, const Collider& of, const Vec3d& along) {
  return core.half.dot(Eigen::Vector3d(of.turn.conjugate() * along).cwiseAbs());
}

double size_of(const Core& core) { return core.half.norm() + core.radius; }

/// The first link of those that fixed joints join.
std::uint32_t body_of(const Robot& robot, std::uint32_t link) {
  if (robot.links[link].parent == kNone) return link;
  const bool is_fixed = robot.joints[link - 1].type == RobotJointType::fixed;
  return is_fixed ? body_of(robot, robot.links[link].parent) : link;
}

/// Bodies from one up to the root.
std::vector<std::uint32_t> bodies_above(const Robot& robot, std::uint32_t body) {
  std::vector<std::uint32_t> bodies = {body};
  while (robot.links[bodies.back()].parent != kNone)
    bodies.push_back(body_of(robot, robot.links[bodies.back()].parent));
  return bodies;
}

/// Whether no moving joint, one, or several in one place are between a body and one above it.
bool are_joined(const Robot& robot, std::span<const Affine3d> at_rest, std::uint32_t below,
                std::uint32_t above, double near) {
  const std::vector<std::uint32_t> bodies = bodies_above(robot, below);
  const auto end = std::find(bodies.begin(), bodies.end(), above);
  if (end == bodies.end()) return false;
  for (auto body = bodies.begin(); body != end && body + 1 != end; ++body) {
    const Vec3d apart = at_rest[*body].translation() - at_rest[*(body + 1)].translation();
    if (apart.norm() >= near) return false;
  }
  return true;
}

double least_width(const Collider& shape) {
  const Core core = core_in(shape);
  return std::holds_alternative<Collider::Box>(shape.shape) ? core.half.minCoeff() : core.radius;
}

}  // namespace

double gap_between(const Collider& a, const Collider& b) {
  const Core core_a = core_in(a), core_b = core_in(b);
  const double enough = kAccuracy * std::min(size_of(core_a), size_of(core_b));
  Vec3d on_a = a.place, on_b = b.place;
  double apart = 0;
  for (int round = 0; round < kMostRounds; ++round) {
    on_a = projected(core_a, a, on_b);
    on_b = projected(core_b, b, on_a);
    const Vec3d between = on_b - on_a;
    apart = between.norm();
    if (apart < enough) {
      apart = 0;
      break;
    }
    const Vec3d along = between / apart;
    const double shown =
        (b.place - a.place).dot(along) - reach_of(core_a, a, along) - reach_of(core_b, b, along);
    if (apart - shown < enough) break;
  }
  return apart - core_a.radius - core_b.radius;
}

LinkGaps::LinkGaps(const PlanTool& tool) : tool_(tool) {
  auto kinematics = RobotKinematics::create(tool.robot);
  const std::vector<double> rest = rest_values(tool.robot);
  std::vector<Affine3d> frames(tool.robot.links.size());
  if (!kinematics || !kinematics->evaluate(rest, frames)) return;
  for (std::size_t a = 0; a < tool.shapes.size(); ++a)
    for (std::size_t b = a + 1; b < tool.shapes.size(); ++b) {
      const double near =
          std::min(least_width(tool.shapes[a].collider), least_width(tool.shapes[b].collider));
      const std::uint32_t of_a = body_of(tool.robot, tool.shapes[a].bone);
      const std::uint32_t of_b = body_of(tool.robot, tool.shapes[b].bone);
      if (are_joined(tool.robot, frames, of_a, of_b, near) ||
          are_joined(tool.robot, frames, of_b, of_a, near))
        continue;
      if (gap({a, b}, frames, 1) > 0) pairs_.push_back({a, b});
    }
  std::vector<int> overlaps(pairs_.size());
  test::Random random(29);
  for (int pose = 0; pose < kRandomValues; ++pose) {
    std::vector<double> values = rest;
    for (std::size_t i = 0; i < values.size(); ++i)
      values[i] = random.uniform(std::max(tool.robot.values[i].lower, rest[i] - kFromRest),
                                 std::min(tool.robot.values[i].upper, rest[i] + kFromRest));
    if (!kinematics->evaluate(values, frames)) continue;
    for (std::size_t i = 0; i < pairs_.size(); ++i)
      overlaps[i] += gap(pairs_[i], frames, 1) <= 0 ? 1 : 0;
  }
  std::vector<Pair> kept;
  for (std::size_t i = 0; i < pairs_.size(); ++i)
    if (overlaps[i] < kOften * kRandomValues) kept.push_back(pairs_[i]);
  pairs_ = std::move(kept);
}

double LinkGaps::gap(const Pair& pair, std::span<const Affine3d> frames, double most) const {
  const BoneCollider &a = tool_.shapes[pair.a], &b = tool_.shapes[pair.b];
  const Vec3d middle_a = frames[a.bone] * a.collider.place;
  const Vec3d middle_b = frames[b.bone] * b.collider.place;
  const double sizes = size_of(core_in(a.collider)) + size_of(core_in(b.collider));
  if ((middle_b - middle_a).norm() - sizes >= most) return most;
  return std::min(
      most, gap_between(posed_collider(a, frames[a.bone]), posed_collider(b, frames[b.bone])));
}

double LinkGaps::least(std::span<const Affine3d> frames, double most) const {
  for (const Pair& pair : pairs_) most = std::min(most, gap(pair, frames, most));
  return most;
}

}  // namespace sunder::bench
