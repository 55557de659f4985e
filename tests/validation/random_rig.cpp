#include "validation/random_rig.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <string>

#include <gtest/gtest.h>

namespace sunder::test {
namespace {

Affine3d rigid(Random& random, double reach) {
  Affine3d matrix = Affine3d::Identity();
  const Vec3d axis = random.direction();
  const double angle = random.uniform(-std::numbers::pi, std::numbers::pi),
               length = random.uniform(0, reach);
  const Vec3d direction = random.direction();
  matrix.linear() = Eigen::AngleAxisd(angle, axis).toRotationMatrix();
  matrix.translation() = length * direction;
  return matrix;
}

JointRange random_range(Random& random, const RandomRigKind& kind) {
  JointRange range;
  const std::uint32_t choice = random.index(8);
  range.angle = choice == 0 ? 0.0 : random.uniform(0, kind.most_angle);
  if (kind.has_hinges && choice > 4) {
    range.turn = JointRange::Turn::hinge;
    range.axis = random.uniform(0.5, 2) * random.direction();
    range.lower = random.uniform(-kind.most_angle, kind.most_angle);
    range.upper = range.lower + random.uniform(0, kind.most_angle);
  }
  if (kind.has_slides && random.index(3) == 0) {
    range.slide_from = random.uniform(0, 0.2) * random.direction();
    range.slide_to = random.uniform(0, 0.2) * random.direction();
    range.slide_radius = random.index(2) * random.uniform(0, 0.1);
  }
  if (kind.has_scales && random.index(3) == 0) {
    range.scale_lower = random.uniform(0.3, 1.1);
    range.scale_upper = range.scale_lower + random.uniform(0, 0.8);
  }
  return range;
}

/// A value of [low, high], half of the time one of its ends.
double extreme(Random& random, double low, double high) {
  const std::uint32_t choice = random.index(4);
  return choice == 0 ? low : choice == 1 ? high : random.uniform(low, high);
}

/// The motion of a bone about its origin at bind, model space of bind.
Affine3d random_motion(Random& random, const JointRange& range, const Affine3d& bone) {
  Mat3d axes = bone.linear();
  for (int i = 0; i < 3; ++i) axes.col(i).normalize();
  Vec3d axis = random.direction();
  double angle = extreme(random, 0, std::min(range.angle, std::numbers::pi));
  if (range.turn == JointRange::Turn::hinge) {
    axis = (axes * range.axis).normalized();
    angle = extreme(random, range.lower, range.upper);
  }
  const double part = extreme(random, 0, 1);
  const Vec3d slide =
      axes * ((1 - part) * range.slide_from + part * range.slide_to) +
      extreme(random, 0, std::isfinite(range.slide_radius) ? range.slide_radius : 0) *
          random.direction();
  const Mat3d turn =
      Eigen::AngleAxisd(random.uniform(0, std::numbers::pi), random.direction()).toRotationMatrix();
  const Vec3d stretch(extreme(random, range.scale_lower, range.scale_upper),
                      extreme(random, range.scale_lower, range.scale_upper),
                      extreme(random, range.scale_lower, range.scale_upper));
  const Vec3d centre = bone.translation();
  Affine3d motion = Affine3d::Identity();
  motion.linear() = Eigen::AngleAxisd(angle, axis).toRotationMatrix() * turn *
                    stretch.asDiagonal() * turn.transpose();
  motion.translation() = centre + slide - motion.linear() * centre;
  return motion;
}

}  // namespace

RandomRig make_random_rig(Random& random, const RandomRigKind& kind) {
  RandomRig rig;
  const std::uint32_t count = 2 + random.index(kind.most_bones - 1);
  const bool is_chain = random.index(2) == 0;
  for (std::uint32_t bone = 0; bone < count; ++bone) {
    Bone of;
    of.name = std::to_string(bone);
    const bool is_root = bone == 0 || (kind.has_roots && random.index(4) == 0);
    if (!is_root) of.parent = is_chain ? bone - 1 : random.index(bone);
    Affine3d matrix = rigid(random, 0.5);
    if (of.parent != kNone) matrix = rig.bind.model_from_bone[of.parent] * matrix;
    matrix.linear() *= random.index(3) == 0 ? random.uniform(0.5, 2) : 1.0;
    rig.skeleton.bones.push_back(of);
    rig.bind.model_from_bone.push_back(matrix);
    rig.limits.of_bone.push_back(random_range(random, kind));
  }
  return rig;
}

std::vector<Affine3d> random_pose_within(Random& random, const RandomRig& rig) {
  std::vector<Affine3d> model_from_bone;
  for (std::size_t bone = 0; bone < rig.skeleton.bones.size(); ++bone) {
    const Affine3d& bind = rig.bind.model_from_bone[bone];
    const std::uint32_t parent = rig.skeleton.bones[bone].parent;
    const Affine3d moved = random_motion(random, rig.limits.of_bone[bone], bind) * bind;
    if (parent == kNone) {
      model_from_bone.push_back(moved);
      continue;
    }
    const Affine3d parent_from_bone = rig.bind.model_from_bone[parent].inverse() * moved;
    model_from_bone.push_back(model_from_bone[parent] * parent_from_bone);
  }
  return model_from_bone;
}

RandomWeights random_weights(Random& random, std::uint32_t bones) {
  std::map<std::uint32_t, double> weight_of;
  const std::uint32_t count = 1 + random.index(4);
  double sum = 0;
  for (std::uint32_t i = 0; i < count; ++i) {
    const std::uint32_t bone = random.index(bones);
    const double weight = random.uniform(0.01, 1);
    weight_of[bone] += weight;
    sum += weight;
  }
  RandomWeights result;
  for (const auto& [bone, weight] : weight_of) {
    result.bones.push_back(bone);
    result.weights.push_back(weight / sum);
  }
  return result;
}

Vec3d posed_point(const RandomRig& rig, const std::vector<Affine3d>& model_from_bone,
                  const RandomWeights& weights, const Vec3d& position) {
  Vec3d sum = Vec3d::Zero();
  for (std::size_t i = 0; i < weights.bones.size(); ++i) {
    const std::uint32_t bone = weights.bones[i];
    sum += weights.weights[i] *
           (model_from_bone[bone] * (rig.bind.model_from_bone[bone].inverse() * position));
  }
  return sum;
}

void add_terms(const RandomWeights& weights, const Vec3d& position, double factor,
               std::vector<SkinTerm>& terms) {
  for (std::size_t i = 0; i < weights.bones.size(); ++i)
    terms.push_back({weights.bones[i], factor * weights.weights[i],
                     Vec3d(factor * weights.weights[i] * position)});
}

void append_row(std::vector<SkinTerm> terms, SkinDifferences& rows) {
  std::map<std::uint32_t, SkinTerm> of_bone;
  for (const SkinTerm& term : terms) {
    SkinTerm& sum = of_bone[term.bone];
    sum.bone = term.bone;
    sum.m += term.m;
    sum.x += term.x;
  }
  for (const auto& [bone, term] : of_bone)
    if (term.m != 0 || !term.x.isZero(0)) rows.terms.push_back(term);
  rows.first.push_back(static_cast<std::uint32_t>(rows.terms.size()));
}

JointTree make_tree(const RandomRig& rig) {
  auto tree = JointTree::create(rig.skeleton, rig.bind, rig.limits);
  EXPECT_TRUE(tree) << tree.error().text();
  return *tree;
}

}  // namespace sunder::test
