#include "certificate/pose_search.h"

#include <algorithm>
#include <cmath>

namespace sunder::certificate {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr int kMostPasses = 60;

double uniform(std::mt19937_64& random, double low, double high) {
  return low + (high - low) * static_cast<double>(random() >> 11) * 0x1p-53;
}

Vec3d random_direction(std::mt19937_64& random) {
  for (;;) {
    const Vec3d v{uniform(random, -1, 1), uniform(random, -1, 1), uniform(random, -1, 1)};
    const double length = norm(v);
    if (length > 0.1 && length < 1) return v / length;
  }
}

Mat3d rotation_about(const Vec3d& unit_axis, double angle) {
  return Mat3d(Eigen::AngleAxisd(angle, unit_axis).toRotationMatrix());
}

/// Any unit vector across a unit vector.
Vec3d across(const Vec3d& unit) {
  Vec3d other = Vec3d::Zero();
  Eigen::Index least = 0;
  unit.cwiseAbs().minCoeff(&least);
  other[least] = 1.0;
  return normalized(unit.cross(other));
}

/// Turns the direction of y towards that of the goal, by at most `angle`.
Mat3d ball_towards(const Vec3d& y, const Vec3d& goal, double angle) {
  const Vec3d from = normalized(y), to = normalized(goal);
  const Vec3d axis = from.cross(to);
  const double sine = norm(axis);
  const double wanted = std::atan2(sine, dot(from, to));
  const Vec3d unit = sine > 1e-12 ? Vec3d(axis / sine) : across(from);
  return rotation_about(unit, std::min(wanted, angle));
}

/// The angle within [lower, upper] at which y, turned about the axis, is closest to the goal.
double hinge_towards(const PreparedJoint& joint, const Vec3d& y, const Vec3d& goal) {
  const Vec3d& a = joint.axis;
  const double cosine = dot(y, goal) - dot(a, y) * dot(a, goal);
  const double sine = dot(a, y.cross(goal));
  if (cosine == 0 && sine == 0) return std::clamp(0.0, joint.lower, joint.upper);
  double best = std::atan2(sine, cosine);
  best += 2 * kPi * std::ceil((joint.lower - best) / (2 * kPi));
  if (best <= joint.upper) return best;
  const auto value = [&](double angle) {
    return cosine * std::cos(angle) + sine * std::sin(angle);
  };
  return value(joint.lower) > value(joint.upper) ? joint.lower : joint.upper;
}

}  // namespace

PoseSearch::PoseSearch(const JointTree::State& tree, std::span<const SkinTerm> terms, Goal goal)
    : tree_(tree),
      sign_(goal == Goal::longest ? 1.0 : -1.0),
      path_(make_path(tree, terms)),
      motions_(path_.size()),
      m_(path_.size()),
      x_(path_.size()),
      rest_(path_.size()) {
  start_at_bind();
}

void PoseSearch::set_positions(std::span<const SkinTerm> terms) {
  for (PathJoint& joint : path_) joint.x = Vec3d::Zero();
  for (const SkinTerm& term : terms)
    for (PathJoint& joint : path_)
      if (joint.node == tree_.node_of_bone[term.bone]) joint.x += term.x;
}

JointMotion PoseSearch::neutral(const PreparedJoint& joint) const {
  JointMotion motion;
  if (joint.is_hinge)
    motion.rotation = rotation_about(joint.axis, std::clamp(0.0, joint.lower, joint.upper));
  const double square = squared_norm(joint.half_segment);
  const double part =
      square > 0 ? std::clamp(-dot(joint.slide, joint.half_segment) / square, -1.0, 1.0) : 0.0;
  const Vec3d nearest = joint.slide + part * joint.half_segment;
  const double distance = norm(nearest);
  if (distance > joint.slide_radius) motion.slide = nearest * (1 - joint.slide_radius / distance);
  motion.scale = std::clamp(1.0, joint.scale_lower, joint.scale_upper);
  return motion;
}

void PoseSearch::start_at_bind() {
  for (std::size_t i = 0; i < path_.size(); ++i) motions_[i] = neutral(tree_.nodes[path_[i].node]);
}

void PoseSearch::start_at_random(std::mt19937_64& random) {
  for (std::size_t i = 0; i < path_.size(); ++i) {
    const PreparedJoint& joint = tree_.nodes[path_[i].node];
    const Vec3d axis = random_direction(random);
    const double angle = uniform(random, joint.lower, joint.upper);
    motions_[i].rotation = rotation_about(joint.is_hinge ? joint.axis : axis, angle);
    motions_[i].slide = joint.slide + uniform(random, -1, 1) * joint.half_segment +
                        uniform(random, 0, 1) * joint.slide_radius * random_direction(random);
    motions_[i].scale = uniform(random, joint.scale_lower, joint.scale_upper);
  }
}

/// The part that the subtree of a joint adds to that of its parent.
Vec3d PoseSearch::posed(std::size_t i) const {
  const Vec3d& centre = tree_.nodes[path_[i].node].centre;
  const JointMotion& motion = motions_[i];
  return m_[i] * (centre + motion.slide) +
         motion.scale * multiply(motion.rotation, Vec3d(x_[i] - m_[i] * centre));
}

void PoseSearch::add_up() {
  for (std::size_t i = 0; i < path_.size(); ++i) {
    m_[i] = path_[i].m;
    x_[i] = path_[i].x;
  }
  for (std::size_t i = 0; i + 1 < path_.size(); ++i) {
    m_[path_[i].parent] += m_[i];
    x_[path_[i].parent] += posed(i);
  }
}

/// @param rest  the sum without what the joint turns, seen from the joint's parent.
void PoseSearch::turn(std::size_t i, const Vec3d& rest) {
  const PreparedJoint& joint = tree_.nodes[path_[i].node];
  const Vec3d y = x_[i] - m_[i] * joint.centre, goal = sign_ * rest;
  if (squared_norm(y) == 0 || squared_norm(goal) == 0) return;
  motions_[i].rotation = joint.is_hinge ? rotation_about(joint.axis, hinge_towards(joint, y, goal))
                                        : ball_towards(y, goal, joint.upper);
}

/// @param rest  the sum without what the slide adds. Only for the longest sum.
void PoseSearch::slide(std::size_t i, const Vec3d& rest) {
  const PreparedJoint& joint = tree_.nodes[path_[i].node];
  if (sign_ < 0 || m_[i] == 0 || joint.slide_reach == 0) return;
  const Vec3d first = joint.slide - joint.half_segment, last = joint.slide + joint.half_segment;
  const bool is_first =
      squared_norm(Vec3d(rest + m_[i] * first)) > squared_norm(Vec3d(rest + m_[i] * last));
  const Vec3d end = is_first ? first : last;
  Vec3d direction = normalized(Vec3d(rest + m_[i] * end));
  if (direction.isZero(0)) direction = Vec3d::UnitX();  // all are alike
  motions_[i].slide = end + std::copysign(joint.slide_radius, m_[i]) * direction;
}

void PoseSearch::stretch(std::size_t i, const Vec3d& rest) {
  const PreparedJoint& joint = tree_.nodes[path_[i].node];
  if (joint.scale_lower == joint.scale_upper) return;
  const Vec3d y = multiply(motions_[i].rotation, Vec3d(x_[i] - m_[i] * joint.centre));
  if (sign_ < 0) {
    const double square = squared_norm(y);
    if (square > 0)
      motions_[i].scale = std::clamp(-dot(rest, y) / square, joint.scale_lower, joint.scale_upper);
    return;
  }
  const bool is_small = squared_norm(Vec3d(rest + joint.scale_lower * y)) >
                        squared_norm(Vec3d(rest + joint.scale_upper * y));
  motions_[i].scale = is_small ? joint.scale_lower : joint.scale_upper;
}

void PoseSearch::move_joint(std::size_t i) {
  const std::size_t parent = path_[i].parent;
  const PreparedJoint& joint = tree_.nodes[path_[i].node];
  const Vec3d old = posed(i);
  const Vec3d others = rest_[parent] + x_[parent] - old + m_[i] * joint.centre;
  slide(i, others + (old - m_[i] * (joint.centre + motions_[i].slide)));
  const Vec3d unturned = others + m_[i] * motions_[i].slide;
  turn(i, unturned);
  stretch(i, unturned);
  x_[parent] += posed(i) - old;
  const double scale = motions_[i].scale;
  if (scale > 0)
    rest_[i] =
        multiply(Mat3d(motions_[i].rotation.transpose()), unturned) / scale - m_[i] * joint.centre;
  else
    rest_[i] = Vec3d::Zero();  // the terms below vanish
}

double PoseSearch::improve() {
  add_up();
  const std::size_t top = path_.size() - 1;
  rest_[top] = -m_[top] * tree_.nodes[path_[top].node].centre;
  for (std::size_t i = top; i-- > 0;) move_joint(i);
  add_up();
  return norm(Vec3d(rest_[top] + x_[top]));
}

double PoseSearch::improve_fully() {
  double value = improve();
  for (int pass = 0; pass < kMostPasses; ++pass) {
    const double before = value;
    value = improve();
    if (std::abs(value - before) <= 1e-7 * before) break;
  }
  return value;
}

std::vector<Affine3d> PoseSearch::model_from_bind() const {
  std::vector<Affine3d> matrices(tree_.parents.size());
  for (std::size_t bone = 0; bone < matrices.size(); ++bone) {
    const PreparedJoint& joint = tree_.nodes[bone + 1];
    JointMotion motion = neutral(joint);
    for (std::size_t i = 0; i + 1 < path_.size(); ++i)
      if (path_[i].node == bone + 1) motion = motions_[i];
    Affine3d local;
    local.linear() = motion.scale * motion.rotation;
    local.translation() =
        joint.centre + motion.slide - multiply(Mat3d(local.linear()), joint.centre);
    const std::uint32_t parent = tree_.parents[bone];
    matrices[bone] = parent == kNone ? local : multiply(matrices[parent], local);
  }
  return matrices;
}

FoundPose PoseSearch::pose() const {
  FoundPose result;
  result.pose = tree_.bind;
  const std::vector<Affine3d> matrices = model_from_bind();
  for (std::uint32_t bone = 0; bone < matrices.size(); ++bone) {
    result.pose.model_from_bone[bone] = multiply(matrices[bone], tree_.bind.model_from_bone[bone]);
    JointMotion motion = neutral(tree_.nodes[bone + std::size_t{1}]);
    for (std::size_t i = 0; i + 1 < path_.size(); ++i)
      if (path_[i].node == bone + 1) motion = motions_[i];
    if (motion.rotation.isIdentity(0) && motion.slide.isZero(0) && motion.scale == 1) continue;
    result.motions.push_back(
        {bone, normalized(Quatd(motion.rotation)), motion.slide, motion.scale});
  }
  return result;
}

double PoseSearch::measure(std::span<const SkinTerm> terms) const {
  const std::vector<Affine3d> matrices = model_from_bind();
  Vec3d sum = Vec3d::Zero();
  double m = 0;
  for (const SkinTerm& term : terms) {
    const Affine3d& matrix = matrices[term.bone];
    sum += multiply(Mat3d(matrix.linear()), term.x) + term.m * matrix.translation();
    m += term.m;
  }
  if (path_.empty() || path_.back().node == 0) return norm(sum);
  const std::uint32_t top = path_.back().node - 1;
  return norm(Vec3d(sum - m * transform(matrices[top], tree_.nodes[top + 1].centre)));
}

}  // namespace sunder::certificate
