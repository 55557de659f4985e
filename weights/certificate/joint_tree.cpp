#include "weights/certificate/joint_tree.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <new>
#include <utility>

#include "core/internal/ordered.h"

namespace sunder {
namespace certificate {
namespace {

Status fault_of(const JointRange& range, std::uint32_t bone) {
  const auto is_number = [](double value) { return !std::isnan(value); };
  if (!range.axis.allFinite() || !range.slide_from.allFinite() || !range.slide_to.allFinite() ||
      !std::isfinite(range.lower) || !std::isfinite(range.upper) || !is_number(range.angle) ||
      !is_number(range.slide_radius) || !is_number(range.scale_lower) ||
      !is_number(range.scale_upper))
    return Status::failure(StatusCode::non_finite_value, bone,
                           "joint range of bone %u is not finite", bone);
  const auto invalid = [&](const char* text) {
    return Status::failure(StatusCode::invalid_argument, bone, "joint range of bone %u: %s", bone,
                           text);
  };
  if (range.turn == JointRange::Turn::ball && range.angle < 0)
    return invalid("the angle is negative");
  if (range.turn == JointRange::Turn::hinge && range.axis.isZero(0))
    return invalid("the axis has no length");
  if (range.turn == JointRange::Turn::hinge && range.lower > range.upper)
    return invalid("lower is above upper");
  if (range.slide_radius < 0) return invalid("the slide radius is negative");
  if (range.scale_lower < 0 || range.scale_lower > range.scale_upper)
    return invalid("scales must satisfy 0 <= lower <= upper");
  return {};
}

/// Axes of a bone's frame as unit vectors in model space; those without length stay as they are.
Mat3d unit_axes(const Affine3d& model_from_bone) {
  Mat3d axes;
  for (int i = 0; i < 3; ++i) axes.col(i) = normalized(Vec3d(model_from_bone.linear().col(i)));
  return axes;
}

/// Lane 0 is the closed form, where s is 1 and hinges turn about bind. Then s goes from 1 towards
/// the cosine of each joint's largest angle, or to 0 where that is negative; then it is 0
/// everywhere.
void fill_turn(PreparedJoint& joint) {
  const double half = std::min(joint.half_range(), std::numbers::pi);
  joint.middle_cosine = std::cos(joint.middle());
  joint.middle_sine = std::sin(joint.middle());
  joint.half_cosine = std::cos(half);
  joint.half_sine = std::sin(half);
  joint.squared_chord = 4.0 * std::sin(0.5 * half) * std::sin(0.5 * half);
  for (int lane = 1; lane < kZeroLane; ++lane) {
    const double part = static_cast<double>(lane) / (kZeroLane - 1);
    joint.set_lane(1.0 - part * (1.0 - std::max(0.0, joint.half_cosine)), lane, joint.turn);
  }
  joint.set_lane(0.0, kZeroLane, joint.turn);
  joint.set_lane(0.0, kFittedLane, joint.turn);  // set anew for each point
  joint.largest_turn =
      std::min(std::max(std::abs(joint.lower), std::abs(joint.upper)), std::numbers::pi);
  joint.turn.cosine[0] = 1.0;
  joint.turn.sine[0] = 0.0;
  joint.turn.radius[0] = 2.0 * std::sin(0.5 * joint.largest_turn);
}

/// Largest relative change of a length when the joint is crossed in either direction.
double strain_of(const PreparedJoint& joint) {
  if (!joint.has_scale_range || joint.scale_lower == 0)
    return std::numeric_limits<double>::infinity();
  return std::log1p(std::max({joint.scale_upper - 1, 1 - joint.scale_lower,
                              1 / joint.scale_lower - 1, 1 - 1 / joint.scale_upper}));
}

PreparedJoint prepare(const JointRange& range, const Affine3d& model_from_bone) {
  PreparedJoint joint;
  const Mat3d axes = unit_axes(model_from_bone);
  joint.is_hinge = range.turn == JointRange::Turn::hinge;
  joint.centre = model_from_bone.translation();
  if (joint.is_hinge) {
    joint.axis = normalized(multiply(axes, range.axis));
    joint.lower = range.lower;
    joint.upper = range.upper;
  } else {
    joint.upper = std::min(range.angle, std::numbers::pi);
  }
  joint.has_slide_range = std::isfinite(range.slide_radius);
  joint.has_scale_range = std::isfinite(range.scale_upper);
  joint.slide = multiply(axes, Vec3d(0.5 * (range.slide_from + range.slide_to)));
  joint.half_segment = multiply(axes, Vec3d(0.5 * (range.slide_to - range.slide_from)));
  if (joint.has_slide_range) joint.slide_radius = range.slide_radius;
  joint.slide_reach = norm(joint.half_segment) + joint.slide_radius;
  if (joint.has_scale_range) {
    joint.scale_lower = range.scale_lower;
    joint.scale_upper = range.scale_upper;
  }
  fill_turn(joint);
  joint.strain = strain_of(joint);
  return joint;
}

bool can_move(const PreparedJoint& joint) {
  return joint.lower != 0 || joint.upper != 0 || joint.slide_reach != 0 || !joint.slide.isZero(0) ||
         joint.scale_lower != 1 || joint.scale_upper != 1 || !joint.has_slide_range ||
         !joint.has_scale_range;
}

void add_from_above(const PreparedJoint& above, std::uint32_t bone, PreparedJoint& joint) {
  joint.growth_above = above.growth_above * joint.scale_upper;
  joint.shrink_above = joint.has_scale_range ? above.shrink_above * joint.scale_lower : 0.0;
  joint.unscaled_bone = joint.has_scale_range ? above.unscaled_bone : bone;
}

Status check_sizes(const Skeleton& skeleton, const ModelPose& bind, const JointLimits& limits) {
  const std::size_t count = skeleton.bones.size();
  if (bind.model_from_bone.size() != count || limits.of_bone.size() != count)
    return Status::failure(StatusCode::size_mismatch, kNone,
                           "skeleton has %zu bones, the bind pose %zu, the joint limits %zu", count,
                           bind.model_from_bone.size(), limits.of_bone.size());
  return {};
}

}  // namespace

double best_shrink(const PreparedJoint& joint, const Vec3d& arm, const Vec3d& rest) {
  Vec3d middle = joint.scale() * arm, away = -rest;
  if (joint.is_hinge) {
    const Vec3d along = dot(joint.axis, middle) * joint.axis, across = middle - along;
    middle = joint.middle_cosine * across + joint.middle_sine * joint.axis.cross(across);
    away -= along;
  }
  const double length = norm(middle);
  if (length == 0) return 1.0;
  const double along = dot(away, middle) / length;
  const double aside = std::sqrt(std::max(0.0, squared_norm(away) - along * along));
  const double whole = aside + length * joint.half_sine;
  if (!(whole > 0)) return joint.half_cosine > 0 ? 1.0 : 0.0;
  const double at = along + aside / whole * (length * joint.half_cosine - along);
  return std::max(0.0, at / length);
}

}  // namespace certificate

JointTree::JointTree(std::shared_ptr<const State> state) : state_(std::move(state)) {}

Result<JointTree> JointTree::create(const Skeleton& skeleton, const ModelPose& bind,
                                    const JointLimits& limits) {
  using namespace certificate;
  if (const Status status = check_sizes(skeleton, bind, limits); !status) return status;
  const auto count = static_cast<std::uint32_t>(skeleton.bones.size());
  try {
    const auto state = std::make_shared<State>();
    state->nodes.resize(count + std::size_t{1});
    state->node_of_bone.resize(count);
    state->bind = bind;
    for (std::uint32_t bone = 0; bone < count; ++bone) {
      const std::uint32_t parent = skeleton.bones[bone].parent;
      if (parent != kNone && parent >= bone)
        return Status::failure(StatusCode::not_a_tree, bone,
                               "bone %u has parent %u; parents come before children", bone, parent);
      if (const Status status = fault_of(limits.of_bone[bone], bone); !status) return status;
      if (!bind.model_from_bone[bone].matrix().allFinite())
        return Status::failure(StatusCode::non_finite_value, bone,
                               "the bind pose of bone %u is not finite", bone);
      PreparedJoint joint = prepare(limits.of_bone[bone], bind.model_from_bone[bone]);
      joint.parent = parent == kNone ? 0 : state->node_of_bone[parent];
      add_from_above(state->nodes[joint.parent], bone, joint);
      state->node_of_bone[bone] = can_move(joint) ? bone + 1 : joint.parent;
      state->extent = std::max(state->extent, norm(joint.centre));
      state->nodes[bone + std::size_t{1}] = joint;
      state->parents.push_back(parent);
    }
    return JointTree(state);
  } catch (const std::bad_alloc&) {
    return Status::failure(StatusCode::limit_exceeded, kNone, "out of memory");
  }
}

}  // namespace sunder
