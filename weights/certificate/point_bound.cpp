#include "weights/certificate/point_bound.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace sunder::certificate {
namespace {

constexpr double kBoundSafety = 1.0 + 1e-10;
constexpr double kRounding = 1e-13;  // of the terms' lengths, for sums that cancel
constexpr int kSweeps = 6;
constexpr int kSectionSteps = 14;

template <int lanes>
double distance_at_top(const PreparedJoint& top, const SubtreeBall<lanes>& ball) {
  const Vec3d origin = ball.m * top.centre;
  const Lanes<lanes> x = ball.x - origin.x(), y = ball.y - origin.y(), z = ball.z - origin.z();
  return top.growth_above * ((x * x + y * y + z * z).sqrt() + ball.radius).minCoeff();
}

double with_safety(const JointTree::State& tree, std::span<const SkinTerm> terms, double bound) {
  double length = 0;
  for (const SkinTerm& term : terms)
    length += term.x.cwiseAbs().sum() + std::abs(term.m) * tree.extent;
  return kBoundSafety * bound + kRounding * length;
}

/// The s that is best if the joint of a ball alone moves.
/// @param at_bind  the sum of all terms there.
template <int lanes>
double fitted_shrink(const PreparedJoint& joint, const SubtreeBall<lanes>& ball, int lane,
                     const Vec3d& at_bind) {
  const Vec3d arm = Vec3d(ball.x[lane], ball.y[lane], ball.z[lane]) - ball.m * joint.centre;
  return best_shrink(joint, arm, Vec3d(at_bind - arm + ball.m * joint.slide));
}

/// A point's bound as a function of s at each of its joints. Any s >= 0 gives a valid one.
class RefinedBound {
 public:
  RefinedBound(const JointTree::State& tree, std::span<const SkinTerm> terms)
      : tree_(tree), path_(make_path(tree, terms)), balls_(path_.size()), s_(path_.size()) {
    for (const PathJoint& joint : path_) at_bind_ += joint.x;
  }

  /// Minimises joint by joint from several starts, of which one has the s of joints that move
  /// alone.
  double minimise() {
    fit();
    double least = descend();
    for (const double part : {0.0, 0.5, 1.0}) {
      for (std::size_t i = 0; i < path_.size(); ++i)
        s_[i] = 1.0 - part * (1.0 - std::max(0.0, tree_.nodes[path_[i].node].half_cosine));
      least = std::min(least, descend());
    }
    return least;
  }

 private:
  void start() {
    for (std::size_t i = 0; i < path_.size(); ++i)
      balls_[i].set(path_[i].node, path_[i].m, path_[i].x);
  }

  void cross(std::size_t i) {
    const PreparedJoint& joint = tree_.nodes[path_[i].node];
    JointTurn<1> turn;
    joint.set_lane(s_[i], 0, turn);
    cross_joint(joint, turn, balls_[i]);
    balls_[path_[i].parent] += balls_[i];
  }

  void fit() {
    start();
    for (std::size_t i = 0; i + 1 < path_.size(); ++i) {
      s_[i] = fitted_shrink(tree_.nodes[path_[i].node], balls_[i], 0, at_bind_);
      cross(i);
    }
  }

  double descend() {
    double value = evaluate();
    for (int sweep = 0; sweep < kSweeps; ++sweep) {
      const double before = value;
      for (std::size_t i = 0; i + 1 < path_.size(); ++i) value = minimise_along(i, value);
      if (value > before * (1 - 1e-5)) break;
    }
    return value;
  }

  /// Golden section over s of one joint, of which the bound is a convex function. Keeps the old s
  /// if it is better.
  double minimise_along(std::size_t joint, double value) {
    constexpr double kGolden = 0.6180339887498949;
    const double old = s_[joint];
    double low = 0, high = std::max(1.0, 2.0 * old);
    const auto at = [&](double s) {
      s_[joint] = s;
      return evaluate();
    };
    double left = high - kGolden * (high - low), right = low + kGolden * (high - low);
    double of_left = at(left), of_right = at(right);
    for (int step = 0; step < kSectionSteps; ++step) {
      if (of_left < of_right) {
        high = right;
        right = left;
        of_right = of_left;
        left = high - kGolden * (high - low);
        of_left = at(left);
      } else {
        low = left;
        left = right;
        of_left = of_right;
        right = low + kGolden * (high - low);
        of_right = at(right);
      }
    }
    const double best = of_left < of_right ? left : right;
    const double found = at(best);
    if (found < value) return found;
    s_[joint] = old;
    return value;
  }

  double evaluate() {
    start();
    for (std::size_t i = 0; i + 1 < path_.size(); ++i) cross(i);
    return distance_at_top(tree_.nodes[path_.back().node], balls_.back());
  }

  const JointTree::State& tree_;
  std::vector<PathJoint> path_;
  std::vector<SubtreeBall<1>> balls_;
  std::vector<double> s_;  // per joint of the path
  Vec3d at_bind_ = Vec3d::Zero();
};

}  // namespace

PointBound::PointBound(const JointTree::State& tree, std::size_t most_terms, double sum_tolerance)
    : tree_(&tree), sum_tolerance_(sum_tolerance) {
  open_.reserve(most_terms + 1);
}

void PointBound::add(const Ball& ball) {
  std::size_t at = open_.size();
  while (at > 0 && open_[at - 1].node > ball.node) --at;
  if (at == 0 || open_[at - 1].node != ball.node) {
    open_.insert(open_.begin() + static_cast<std::ptrdiff_t>(at), ball);
    return;
  }
  open_[at - 1] += ball;
}

double PointBound::without_safety(std::span<const SkinTerm> terms) {
  open_.clear();
  crossed_.clear();
  double sum = 0;
  Vec3d at_bind = Vec3d::Zero();
  for (const SkinTerm& term : terms) {
    Ball ball;
    ball.set(tree_->node_of_bone[term.bone], term.m, term.x);
    add(ball);
    sum += term.m;
    at_bind += term.x;
  }
  if (!(std::abs(sum) <= kSumTolerance)) return std::numeric_limits<double>::infinity();
  while (open_.size() > 1) {
    Ball ball = open_.back();
    open_.pop_back();
    const PreparedJoint& joint = tree_->nodes[ball.node];
    if (!joint.has_scale_range) return std::numeric_limits<double>::infinity();
    if (!joint.has_slide_range && ball.m != 0) {
      if (std::abs(ball.m) > sum_tolerance_) return std::numeric_limits<double>::infinity();
      crossed_.push_back(
          {ball.node - 1, std::abs(ball.m) * tree_->nodes[joint.parent].growth_above, 0});
    }
    JointTurn<kLanes> turn = joint.turn;
    joint.set_lane(fitted_shrink(joint, ball, kFittedLane, at_bind), kFittedLane, turn);
    cross_joint(joint, turn, ball);
    ball.node = joint.parent;
    add(ball);
  }
  const PreparedJoint& top = tree_->nodes[open_.back().node];
  return top.unscaled_bone == kNone ? distance_at_top(top, open_.back())
                                    : std::numeric_limits<double>::infinity();
}

double PointBound::of(std::span<const SkinTerm> terms) {
  return terms.empty() ? 0.0 : with_safety(*tree_, terms, without_safety(terms));
}

double refined_bound(const JointTree::State& tree, std::span<const SkinTerm> terms) {
  return terms.empty() ? 0.0 : with_safety(tree, terms, RefinedBound(tree, terms).minimise());
}

}  // namespace sunder::certificate
