// Bounds of the blended matrix: where it can never collapse.

#include <sunder/certificate/certificate.h>
#include <sunder/skinning/pose.h>

#include <algorithm>
#include <cmath>

#include <Eigen/SVD>
#include <gtest/gtest.h>

#include "support/machine/stress.h"
#include "support/models/rigs.h"
#include "validation/random_rig.h"

namespace sunder {
namespace {

using test::Random;
using test::RandomRig;
using test::RandomRigKind;
using test::RandomWeights;

double smallest_of(const RandomRig& rig, const std::vector<Affine3d>& pose,
                   const RandomWeights& weights) {
  Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(3, 3);
  for (std::size_t i = 0; i < weights.bones.size(); ++i) {
    const std::uint32_t bone = weights.bones[i];
    sum += weights.weights[i] * (pose[bone] * rig.bind.model_from_bone[bone].inverse()).linear();
  }
  return Eigen::JacobiSVD<Eigen::MatrixXd>(sum).singularValues()[2];
}

SkinBlends row_of(const RandomWeights& weights) {
  std::vector<SkinTerm> terms;
  test::add_terms(weights, Vec3d(0.1, 0.2, 0.3), 1, terms);
  SkinDifferences rows;
  test::append_row(terms, rows);
  return {rows, {}};
}

/// Bones from a bone to the root, itself included.
std::vector<std::uint32_t> way_up(const RandomRig& rig, std::uint32_t bone) {
  std::vector<std::uint32_t> way;
  for (; bone != kNone; bone = rig.skeleton.bones[bone].parent) way.push_back(bone);
  return way;
}

/// 1 - sum of the weight beyond each joint * 2 sin(angle / 2), from the best bone: a plainer bound.
double plain_bound(const RandomRig& rig, const RandomWeights& weights) {
  double best = -1e9;
  for (const std::uint32_t reference : weights.bones) {
    double bound = 1;
    for (std::size_t i = 0; i < weights.bones.size(); ++i) {
      const auto a = way_up(rig, reference), b = way_up(rig, weights.bones[i]);
      for (const auto& [way, other] : {std::pair(&a, &b), std::pair(&b, &a)})
        for (const std::uint32_t bone : *way) {
          if (std::find(other->begin(), other->end(), bone) != other->end()) continue;
          const JointRange& range = rig.limits.of_bone[bone];
          const bool is_hinge = range.turn == JointRange::Turn::hinge;
          const double angle =
              is_hinge ? std::max(std::abs(range.lower), std::abs(range.upper)) : range.angle;
          bound -= weights.weights[i] * 2 * std::sin(std::min(angle, std::numbers::pi) / 2);
        }
    }
    best = std::max(best, bound);
  }
  return best;
}

TEST(BlendBound, no_pose_goes_below_it) {
  Random random(31);
  int certified = 0, by_plain_bound = 0;
  std::vector<double> ratios;
  for (int i = 0; i < test::stressed(1'500, 10); ++i) {
    RandomRigKind kind;
    kind.most_bones = 6;
    kind.most_angle = i % 2 == 0 ? 1.0 : 2.0;
    kind.has_scales = i % 3 == 0;
    kind.has_roots = i % 5 == 0;
    const RandomRig rig = test::make_random_rig(random, kind);
    const RandomWeights weights =
        test::random_weights(random, static_cast<std::uint32_t>(rig.skeleton.bones.size()));
    const JointTree tree = test::make_tree(rig);
    const auto bounds = certify_blend(tree, row_of(weights));
    ASSERT_TRUE(bounds) << bounds.error().text();
    const double bound = (*bounds)[0];
    for (int k = 0; k < 20; ++k)
      ASSERT_GE(smallest_of(rig, test::random_pose_within(random, rig), weights), bound)
          << "rig " << i;
    if (!kind.has_scales && weights.bones.size() > 1) {
      EXPECT_GE(bound, plain_bound(rig, weights) - 1e-9);
      if (bound > 0) ++certified;
      if (plain_bound(rig, weights) > 0) ++by_plain_bound;
    }
    if (i % 5 != 1) continue;
    const auto pose = find_collapse_pose(tree, row_of(weights), 0);
    ASSERT_TRUE(pose) << pose.error().text();
    ASSERT_NEAR(smallest_of(rig, pose->pose.model_from_bone, weights), pose->found, 1e-7);
    ASSERT_GE(pose->found, bound) << "rig " << i;
    if (bound > 0 && weights.bones.size() > 1) ratios.push_back(bound / pose->found);
  }
  std::sort(ratios.begin(), ratios.end());
  ASSERT_GT(ratios.size(), 20u);
  EXPECT_GT(ratios[ratios.size() / 2], 0.85);
  EXPECT_GT(certified, 1.1 * by_plain_bound);
}

RandomRig bent_arm(double angle) {
  RandomRig rig;
  rig.skeleton.bones.resize(2);
  rig.skeleton.bones[1].parent = 0;
  rig.bind.model_from_bone.assign(2, Affine3d::Identity());
  rig.limits.of_bone.resize(2);
  rig.limits.of_bone[1].angle = angle;
  return rig;
}

TEST(BlendBound, two_bones_are_exact) {
  for (const double angle : {0.3, 1.0, 2.0, 3.0, std::numbers::pi})
    for (const double weight : {0.5, 0.2, 0.9}) {
      const RandomRig rig = bent_arm(angle);
      const RandomWeights weights{{0, 1}, {1 - weight, weight}};
      // |(1 - w) u + w v| for unit vectors at the largest angle.
      const double expected = std::sqrt(1 - 2 * weight * (1 - weight) * (1 - std::cos(angle)));
      const JointTree tree = test::make_tree(rig);
      const auto bounds = certify_blend(tree, row_of(weights));
      ASSERT_TRUE(bounds);
      EXPECT_NEAR((*bounds)[0], expected, 1e-9);
      const auto pose = find_collapse_pose(tree, row_of(weights), 0);
      ASSERT_TRUE(pose);
      EXPECT_NEAR(pose->found, expected, 1e-6);
    }
}

TEST(BlendBound, one_bone_is_rigid) {
  Random random(32);
  const RandomRig rig = bent_arm(std::numbers::pi);
  const auto bounds = certify_blend(test::make_tree(rig), row_of({{1}, {1.0}}));
  ASSERT_TRUE(bounds);
  EXPECT_NEAR((*bounds)[0], 1, 1e-9);
}

/// The smallest singular value of the blended matrix, relative to bind.
double smallest_of(const RandomRig& rig, const std::vector<Affine3d>& pose,
                   const RandomWeights& weights, const std::vector<Mat3d>& at_bind) {
  Mat3d sum = Mat3d::Zero(), sum_at_bind = Mat3d::Zero();
  for (std::size_t i = 0; i < weights.bones.size(); ++i) {
    const std::uint32_t bone = weights.bones[i];
    const Mat3d linear = (pose[bone] * rig.bind.model_from_bone[bone].inverse()).linear();
    sum += weights.weights[i] * linear * at_bind[i];
    sum_at_bind += weights.weights[i] * at_bind[i];
  }
  return Eigen::JacobiSVD<Eigen::MatrixXd>(Eigen::MatrixXd(sum * sum_at_bind.inverse()))
      .singularValues()[2];
}

TEST(BlendBound, no_pose_goes_below_it_where_skins_have_matrices_of_their_own) {
  Random random(33);
  int certified = 0;
  for (int i = 0; i < test::stressed(300, 10); ++i) {
    RandomRigKind kind;
    kind.most_bones = 5;
    kind.most_angle = 0.8;
    kind.has_scales = i % 3 == 0;
    const RandomRig rig = test::make_random_rig(random, kind);
    const RandomWeights weights =
        test::random_weights(random, static_cast<std::uint32_t>(rig.skeleton.bones.size()));
    SkinBlends blends = row_of(weights);
    const Mat3d common = 0.01 * Eigen::AngleAxisd(1.0, random.direction()).toRotationMatrix();
    for (std::size_t k = 0; k < weights.bones.size(); ++k) {
      Mat3d own = Eigen::AngleAxisd(random.uniform(0, 0.6), random.direction()).toRotationMatrix();
      own.col(0) *= random.uniform(0.9, 1.1);
      blends.at_bind.push_back(own * common);
    }
    const JointTree tree = test::make_tree(rig);
    const auto bounds = certify_blend(tree, blends);
    ASSERT_TRUE(bounds) << bounds.error().text();
    certified += (*bounds)[0] > 0.1;
    for (int k = 0; k < 20; ++k)
      ASSERT_GE(smallest_of(rig, test::random_pose_within(random, rig), weights, blends.at_bind),
                (*bounds)[0])
          << "rig " << i;
    const auto pose = find_collapse_pose(tree, blends, 0);
    ASSERT_TRUE(pose) << pose.error().text();
    ASSERT_NEAR(smallest_of(rig, pose->pose.model_from_bone, weights, blends.at_bind), pose->found,
                1e-7);
    ASSERT_GE(pose->found, (*bounds)[0]) << "rig " << i;
  }
  EXPECT_GT(certified, 30);
}

TEST(BlendBound, of_a_vertex_has_the_matrices_of_its_skin) {
  Character character = test::make_tube(12, 6, 3);
  const ModelPose bind = *bind_pose(character);
  Skin other = character.skins[0];  // its second bone is turned against the bind pose
  other.bone_from_bind[1].linear() =
      other.bone_from_bind[1].linear() * Eigen::AngleAxisf(2.8f, Vec3f(0, 0, 1)).toRotationMatrix();
  character.skins.push_back(other);
  Mesh& mesh = character.meshes[0];
  mesh.weights = {};
  for (std::uint32_t v = 0; v < mesh.vertex_count(); ++v)
    mesh.weights.append(std::vector<Influence>{{0, 0.5f}, {1, 0.5f}});
  JointLimits limits;
  limits.of_bone.resize(character.skeleton.bones.size());
  for (JointRange& range : limits.of_bone) range.angle = 0.3;
  const auto tree = JointTree::create(character.skeleton, bind, limits);
  ASSERT_TRUE(tree);
  const auto bound_of = [&](std::uint32_t skin) {
    mesh.skin = skin;
    SkinBlends blends;
    EXPECT_TRUE(append_blend(character, bind, 0, 5, blends));
    const auto bounds = certify_blend(*tree, blends);
    EXPECT_TRUE(bounds);
    return (*bounds)[0];
  };
  EXPECT_NEAR(bound_of(0), std::cos(0.15), 1e-6);
  EXPECT_LE(bound_of(1), std::cos(1.55) / std::cos(1.4)) << "turned by 0.3 more, it nearly folds";
}

TEST(BlendBound, faults_of_the_input_are_named) {
  const JointTree tree = test::make_tree(bent_arm(1));
  EXPECT_EQ(certify_blend(tree, row_of({{0, 1}, {0.5, 0.4}})).error().code(),
            StatusCode::weights_not_normalized);
  EXPECT_EQ(certify_blend(tree, row_of({{0, 1}, {1.5, -0.5}})).error().code(),
            StatusCode::weights_not_normalized);
  EXPECT_EQ(find_collapse_pose(tree, row_of({{0}, {1.0}}), 3).error().code(),
            StatusCode::index_out_of_range);
  SkinBlends blends = row_of({{0, 1}, {0.5, 0.5}});
  blends.at_bind = {Mat3d::Identity()};
  EXPECT_EQ(certify_blend(tree, blends).error().code(), StatusCode::size_mismatch);
  blends.at_bind = {Mat3d::Zero(), Mat3d::Zero()};
  EXPECT_EQ((*certify_blend(tree, blends))[0], -1.0);
  EXPECT_EQ(find_collapse_pose(tree, blends, 0).error().code(), StatusCode::unsupported_feature);
}

}  // namespace
}  // namespace sunder
