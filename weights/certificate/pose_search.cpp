#include "weights/certificate/pose_search.h"

#include <algorithm>
#include <cmath>

namespace sunder::certificate {
namespace {

constexpr int kMostPasses = 60;
constexpr int kStartsTried = 16;

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
  best += 2 * std::numbers::pi * std::ceil((joint.lower - best) / (2 * std::numbers::pi));
  if (best <= joint.upper) return best;
  const auto value = [&](double angle) {
    return cosine * std::cos(angle) + sine * std::sin(angle);
  };
  return value(joint.lower) > value(joint.upper) ? joint.lower : joint.upper;
}

/// The reflection that takes one unit vector to another; the identity if they are equal.
Mat3d reflection(const Vec3d& from, const Vec3d& to) {
  const Vec3d normal = from - to;
  const double square = squared_norm(normal);
  if (square < 1e-24) return Mat3d::Identity();
  return Mat3d::Identity() - 2.0 / square * Mat3d(normal * normal.transpose());
}

}  // namespace

PoseSearch::PoseSearch(const JointTree::State& tree, std::span<const SkinTerm> terms, Goal goal)
    : tree_(tree),
      sign_(goal == Goal::longest ? 1.0 : -1.0),
      path_(make_path(tree, terms)),
      motions_(path_.size()),
      m_(path_.size()),
      x_(path_.size()),
      inside_(path_.size()) {
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
  motion.stretch *= std::clamp(1.0, joint.scale_lower, joint.scale_upper);
  return motion;
}

JointMotion PoseSearch::random_motion(const PreparedJoint& joint, std::mt19937_64& random) const {
  JointMotion motion;
  const Vec3d axis = random_direction(random);
  const double angle = uniform(random, joint.lower, joint.upper);
  motion.rotation = rotation_about(joint.is_hinge ? joint.axis : axis, angle);
  motion.slide = joint.slide + uniform(random, -1, 1) * joint.half_segment +
                 uniform(random, 0, 1) * joint.slide_radius * random_direction(random);
  if (joint.scale_half() == 0) {
    motion.stretch *= joint.scale();
    return motion;
  }
  Vec3d scales;
  for (int i = 0; i < 3; ++i)
    scales[i] = std::clamp(joint.scale() + uniform(random, -2, 2) * joint.scale_half(),
                           joint.scale_lower, joint.scale_upper);
  const Vec3d turned = random_direction(random);
  const Mat3d axes = rotation_about(turned, uniform(random, 0, std::numbers::pi));
  motion.stretch = multiply(Mat3d(axes * scales.asDiagonal()), Mat3d(axes.transpose()));
  return motion;
}

void PoseSearch::start_at_bind() {
  for (std::size_t i = 0; i < path_.size(); ++i) motions_[i] = neutral(tree_.nodes[path_[i].node]);
}

void PoseSearch::start_at_random(std::mt19937_64& random) {
  std::vector<JointMotion> best;
  double value = 0;
  for (int tried = 0; tried < kStartsTried; ++tried) {
    for (std::size_t i = 0; i < path_.size(); ++i)
      motions_[i] = random_motion(tree_.nodes[path_[i].node], random);
    const double length = sign_ * add_up();
    if (!best.empty() && length <= value) continue;
    best = motions_;
    value = length;
  }
  motions_ = best;
}

/// The part that the subtree of a joint adds to that of its parent.
Vec3d PoseSearch::posed(std::size_t i) const {
  const Vec3d& centre = tree_.nodes[path_[i].node].centre;
  const JointMotion& motion = motions_[i];
  return m_[i] * (centre + motion.slide) +
         multiply(motion.rotation, multiply(motion.stretch, Vec3d(x_[i] - m_[i] * centre)));
}

/// Sums of subtrees and the total. @return its length.
double PoseSearch::add_up() {
  for (std::size_t i = 0; i < path_.size(); ++i) {
    m_[i] = path_[i].m;
    x_[i] = path_[i].x;
  }
  for (std::size_t i = 0; i + 1 < path_.size(); ++i) {
    m_[path_[i].parent] += m_[i];
    x_[path_[i].parent] += posed(i);
  }
  total_ = x_.back() - m_.back() * tree_.nodes[path_.back().node].centre;
  return norm(total_);
}

/// An end of the segment, and from there towards the sum. Only for the longest sum.
/// @param above  from the joint's parent to the top. @param rest  the sum without the slide.
void PoseSearch::slide(std::size_t i, const Mat3d& above, const Vec3d& rest) {
  const PreparedJoint& joint = tree_.nodes[path_[i].node];
  if (sign_ < 0 || m_[i] == 0 || joint.slide_reach == 0) return;
  const auto sum_of = [&](const Vec3d& slide) {
    return Vec3d(rest + m_[i] * multiply(above, slide));
  };
  double best = squared_norm(sum_of(motions_[i].slide));
  for (const double end : {-1.0, 1.0}) {
    const Vec3d at = joint.slide + end * joint.half_segment;
    Vec3d direction = normalized(multiply(Mat3d(above.transpose()), sum_of(at)));
    if (direction.isZero(0)) direction = Vec3d::UnitX();  // all are alike
    const Vec3d slide = at + std::copysign(joint.slide_radius, m_[i]) * direction;
    const double square = squared_norm(sum_of(slide));
    if (square <= best) continue;
    best = square;
    motions_[i].slide = slide;
  }
}

/// The best stretch for a rotation. Stretches take a vector y to every place of the ball around
/// scale * y with the radius scale_half * |y|, and to no other.
void PoseSearch::stretch(const PreparedJoint& joint, const Mat3d& above, const Vec3d& rest,
                         const Vec3d& y, JointMotion& motion) const {
  const double scale = joint.scale();
  motion.stretch = scale * Mat3d::Identity();
  if (joint.scale_half() == 0) return;
  const Vec3d middle = scale * multiply(motion.rotation, y);
  const Vec3d sum = rest + multiply(above, middle);
  Vec3d wanted = multiply(Mat3d(above.transpose()), sum);
  double half = joint.scale_half();
  if (sign_ < 0) {  // not beyond zero
    const double square = squared_norm(above) / 3.0;
    if (!(square > 0)) return;
    wanted = -wanted / square;
    half = std::min(half, norm(wanted) / norm(y));
  }
  if (wanted.isZero(0)) wanted = middle;
  const Vec3d direction = multiply(Mat3d(motion.rotation.transpose()), normalized(wanted));
  motion.stretch += half * reflection(normalized(y), direction);
}

/// @param rest  the sum without what the joint turns. Where all joints above turn and scale evenly,
/// the arm is best turned towards it. Else the sum grows if the arm turns towards the whole sum.
void PoseSearch::turn_and_stretch(std::size_t i, const Mat3d& above, const Vec3d& rest) {
  const PreparedJoint& joint = tree_.nodes[path_[i].node];
  const Vec3d y = x_[i] - m_[i] * joint.centre;
  if (squared_norm(y) == 0) return;
  const auto sum_of = [&](const JointMotion& motion) {
    return Vec3d(rest + multiply(above, multiply(motion.linear(), y)));
  };
  const Vec3d current = sum_of(motions_[i]);
  double best = sign_ * squared_norm(current);
  const JointMotion old = motions_[i];
  for (const Vec3d& target : {rest, current}) {
    const Vec3d goal = sign_ * multiply(Mat3d(above.transpose()), target);
    JointMotion motion = old;
    if (squared_norm(goal) > 0)
      motion.rotation = joint.is_hinge ? rotation_about(joint.axis, hinge_towards(joint, y, goal))
                                       : ball_towards(y, goal, joint.upper);
    stretch(joint, above, rest, y, motion);
    const double value = sign_ * squared_norm(sum_of(motion));
    if (value <= best) continue;
    best = value;
    motions_[i] = motion;
  }
}

void PoseSearch::move_joint(std::size_t i) {
  const Mat3d& above = inside_[path_[i].parent];
  JointMotion& motion = motions_[i];
  const Vec3d y = x_[i] - m_[i] * tree_.nodes[path_[i].node].centre;
  const auto slid = [&] { return Vec3d(m_[i] * multiply(above, motion.slide)); };
  const auto turned = [&] { return Vec3d(multiply(above, multiply(motion.linear(), y))); };
  const Vec3d others = total_ - slid() - turned();
  slide(i, above, Vec3d(others + turned()));
  turn_and_stretch(i, above, Vec3d(others + slid()));
  total_ = others + slid() + turned();
  inside_[i] = multiply(above, motion.linear());
}

double PoseSearch::improve() {
  (void)add_up();
  const std::size_t top = path_.size() - 1;
  inside_[top] = Mat3d::Identity();
  for (std::size_t i = top; i-- > 0;) move_joint(i);
  return add_up();
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

bool PoseSearch::is_from_top_upwards(std::uint32_t node) const {
  if (path_.empty()) return false;
  std::uint32_t above = path_.back().node;
  while (above > node) above = tree_.nodes[above].parent;
  return above == node;
}

double PoseSearch::growth() const {
  return path_.empty() ? 1.0 : tree_.nodes[path_.back().node].growth_above;
}

JointMotion PoseSearch::motion_of(std::uint32_t bone) const {
  const std::uint32_t node = bone + 1;
  for (std::size_t i = 0; i + 1 < path_.size(); ++i)
    if (path_[i].node == node) return motions_[i];
  const PreparedJoint& joint = tree_.nodes[node];
  JointMotion motion = neutral(joint);
  if (is_from_top_upwards(node))
    motion.stretch = (sign_ > 0 ? joint.scale_upper : joint.scale_lower) * Mat3d::Identity();
  return motion;
}

std::vector<Affine3d> PoseSearch::model_from_bind() const {
  std::vector<Affine3d> matrices(tree_.parents.size());
  for (std::uint32_t bone = 0; bone < matrices.size(); ++bone) {
    const Vec3d& centre = tree_.nodes[bone + std::size_t{1}].centre;
    const JointMotion motion = motion_of(bone);
    Affine3d local;
    local.linear() = motion.linear();
    local.translation() = centre + motion.slide - multiply(Mat3d(local.linear()), centre);
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
    const JointMotion motion = motion_of(bone);
    if (motion.rotation.isIdentity(0) && motion.slide.isZero(0) && motion.stretch.isIdentity(0))
      continue;
    result.motions.push_back(
        {bone, normalized(Quatd(motion.rotation)), motion.slide, motion.stretch});
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
