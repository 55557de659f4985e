// Joint limits taken from clips: every pose of a clip, between keys too, stays within them.

#include <sunder/certificate/certificate.h>
#include <sunder/skinning/pose.h>

#include <algorithm>
#include <cmath>
#include <string>

#include <Eigen/LU>
#include <Eigen/SVD>
#include <gtest/gtest.h>

#include "support/machine/stress.h"
#include "validation/random_rig.h"

namespace sunder {
namespace {

using test::Random;

Quatf random_rotation(Random& random, double angle) {
  return Quatd(Eigen::AngleAxisd(random.uniform(0, angle), random.direction())).cast<float>();
}

Vec3f in_float(const Vec3d& v) { return v.cast<float>(); }

/// The bones' scales in a random character.
enum class Scales { none, even, uneven_leaves, uneven };

Vec3f random_scale(Random& random, Scales scales, bool is_leaf) {
  const double even = scales == Scales::none ? 1.0 : random.uniform(0.5, 2);
  Vec3f scale = Vec3f::Constant(static_cast<float>(even));
  if (scales == Scales::uneven || (scales == Scales::uneven_leaves && is_leaf))
    for (int i = 0; i < 3; ++i) scale[i] = static_cast<float>(random.uniform(0.5, 2));
  return scale;
}

/// One of a bone's channels, with random keys.
Channel random_channel(Random& random, std::uint32_t bone, ChannelTarget target, double angle) {
  Channel channel;
  channel.target = target;
  channel.index = bone;
  channel.width = target == ChannelTarget::rotation ? 4 : 3;
  channel.interpolation = static_cast<Interpolation>(random.index(3));
  const std::uint32_t keys = 1 + random.index(4);
  for (std::uint32_t key = 0; key < keys; ++key)
    channel.times.push_back(0.25f * static_cast<float>(key));
  const auto add = [&](const Eigen::VectorXf& value) {
    channel.values.insert(channel.values.end(), value.data(), value.data() + value.size());
  };
  const bool is_spline = channel.interpolation == Interpolation::cubic_spline;
  const auto tangent = [&] {
    const Vec3d direction = random.direction();
    Vec4f value = Vec4f::Zero();
    value.head<3>() = (random.uniform(0, 2) * direction).cast<float>();
    if (target == ChannelTarget::scale) value *= 0.5f;
    return Eigen::VectorXf(value.head(channel.width));
  };
  for (std::uint32_t key = 0; key < keys; ++key) {
    if (is_spline) add(tangent());
    if (target == ChannelTarget::rotation) add(random_rotation(random, angle).coeffs());
    if (target == ChannelTarget::translation) add(in_float(0.5 * random.direction()));
    if (target == ChannelTarget::scale) add(random_scale(random, Scales::even, true));
    if (is_spline) add(tangent());
  }
  return channel;
}

struct AnimatedRig {
  Character character;
  ModelPose bind;
};

AnimatedRig random_animated_rig(Random& random, Scales scales, double angle, bool scales_move) {
  AnimatedRig rig;
  const std::uint32_t count = 2 + random.index(5);
  Pose at_bind;
  for (std::uint32_t i = 0; i < count; ++i) {
    Bone bone;
    bone.name = std::to_string(i);
    if (i > 0) bone.parent = random.index(4) == 0 ? 0 : i - 1;
    bone.rest.translation = in_float(0.3 * random.direction());
    bone.rest.rotation = random_rotation(random, std::numbers::pi);
    bone.rest.scale = random_scale(random, scales, i + 1 == count);
    BoneTransform local = bone.rest;  // bind differs from rest
    local.rotation = local.rotation * random_rotation(random, angle);
    local.translation += in_float(0.1 * random.direction());
    at_bind.parent_from_bone.push_back(local);
    rig.character.skeleton.bones.push_back(bone);
  }
  EXPECT_TRUE(compute_model_pose(rig.character.skeleton, at_bind, rig.bind));
  for (int k = 0; k < 2; ++k) {
    Clip clip;
    for (std::uint32_t bone = 0; bone < count; ++bone)
      for (const auto target :
           {ChannelTarget::rotation, ChannelTarget::translation, ChannelTarget::scale})
        if (random.index(2) == 0 && (scales_move || target != ChannelTarget::scale))
          clip.channels.push_back(random_channel(random, bone, target, angle));
    clip.duration = 1;
    rig.character.clips.push_back(clip);
  }
  return rig;
}

ModelPose pose_at(const Character& character, const Clip& clip, double time) {
  Pose local = *local_rest_pose(character);
  EXPECT_TRUE(sample_clip(clip, time, local));
  ModelPose pose;
  EXPECT_TRUE(compute_model_pose(character.skeleton, local, pose));
  return pose;
}

/// A joint's motion in model space of bind: M_parent^-1 M_bone.
Affine3d motion_of(const AnimatedRig& rig, const ModelPose& pose, std::size_t bone) {
  const auto model_from_bind = [&](std::size_t of) {
    return pose.model_from_bone[of] * rig.bind.model_from_bone[of].inverse();
  };
  const std::uint32_t parent = rig.character.skeleton.bones[bone].parent;
  return parent == kNone ? model_from_bind(bone)
                         : model_from_bind(parent).inverse() * model_from_bind(bone);
}

double angle_of(const Mat3d& rotation) {
  const double cosine = 0.5 * (rotation.trace() - 1);
  const Vec3d twice_sine(rotation(2, 1) - rotation(1, 2), rotation(0, 2) - rotation(2, 0),
                         rotation(1, 0) - rotation(0, 1));
  return std::atan2(0.5 * twice_sine.norm(), cosine);
}

/// Expects a motion within a range. @return its angle.
double expect_within(const Affine3d& motion, const Affine3d& bone, const JointRange& range,
                     double rounding = 1e-7) {
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(Eigen::MatrixXd(motion.linear()),
                                              Eigen::ComputeThinU | Eigen::ComputeThinV);
  EXPECT_LE(svd.singularValues()[0], range.scale_upper);
  EXPECT_GE(svd.singularValues()[2], range.scale_lower);
  const Mat3d rotation = svd.matrixU() * svd.matrixV().transpose();
  const double angle = rotation.determinant() > 0 ? angle_of(rotation) : std::numbers::pi;
  EXPECT_LE(angle, range.angle);
  Mat3d axes = bone.linear();
  for (int i = 0; i < 3; ++i) axes.col(i).normalize();
  const Vec3d slide = motion * bone.translation() - bone.translation();
  EXPECT_LE((slide - axes * range.slide_from).norm(), range.slide_radius + rounding);
  EXPECT_EQ(range.slide_from, range.slide_to);
  return angle;
}

void expect_clips_within(const AnimatedRig& rig, const JointLimits& limits, int samples,
                         std::vector<double>& largest) {
  largest.assign(limits.of_bone.size(), 0.0);
  for (const Clip& clip : rig.character.clips)
    for (int i = 0; i <= samples; ++i) {
      const ModelPose pose = pose_at(rig.character, clip, static_cast<double>(i) / samples);
      for (std::size_t bone = 0; bone < limits.of_bone.size(); ++bone)
        largest[bone] = std::max(
            largest[bone], expect_within(motion_of(rig, pose, bone), rig.bind.model_from_bone[bone],
                                         limits.of_bone[bone]));
    }
}

TEST(JointLimitsOfClips, hold_every_pose_between_keys_too) {
  Random random(21);
  int wide = 0, tight = 0;
  for (int i = 0; i < test::stressed(60, 20); ++i) {
    const auto scales = static_cast<Scales>(i % 3);
    const AnimatedRig rig =
        random_animated_rig(random, scales, i % 2 == 0 ? 0.6 : std::numbers::pi, i % 4 == 3);
    const auto limits = joint_limits_of_clips(rig.character, rig.bind, 0);
    ASSERT_TRUE(limits) << limits.error().text();
    std::vector<double> largest;
    expect_clips_within(rig, *limits, 500, largest);
    if (HasFailure()) return;
    for (std::size_t bone = 0; bone < largest.size(); ++bone)
      (limits->of_bone[bone].angle > largest[bone] + 0.03 ? wide : tight) += 1;
  }
  EXPECT_LT(wide, 0.05 * tight) << "wider than needed, but for turns that samples miss";
}

TEST(JointLimitsOfClips, hold_every_pose_of_bones_below_uneven_scales) {
  Random random(22);
  for (int i = 0; i < test::stressed(40, 20); ++i) {
    const AnimatedRig rig = random_animated_rig(random, Scales::uneven, 1.0, i % 2 == 0);
    const auto limits = joint_limits_of_clips(rig.character, rig.bind, 0);
    ASSERT_TRUE(limits) << limits.error().text();
    std::vector<double> largest;
    expect_clips_within(rig, *limits, 100, largest);
    if (HasFailure()) return;
  }
}

/// Mixed as layers do: rotations the shorter way, normalised.
BoneTransform mixed(const BoneTransform& a, const BoneTransform& b, float part) {
  BoneTransform result;
  result.translation = (1 - part) * a.translation + part * b.translation;
  result.scale = (1 - part) * a.scale + part * b.scale;
  const float side = a.rotation.coeffs().dot(b.rotation.coeffs()) < 0 ? -1.0f : 1.0f;
  result.rotation.coeffs() =
      ((1 - part) * a.rotation.coeffs() + side * part * b.rotation.coeffs()).normalized();
  return result;
}

TEST(JointLimitsOfClips, hold_in_cross_fades_where_angles_are_below_90_degrees) {
  Random random(25);
  int narrow = 0;
  for (int i = 0; i < test::stressed(40, 20); ++i) {
    const AnimatedRig rig =
        random_animated_rig(random, static_cast<Scales>(i % 3), i % 2 == 0 ? 0.2 : 0.6, i % 4 == 3);
    const auto limits = joint_limits_of_clips(rig.character, rig.bind, 0);
    ASSERT_TRUE(limits);
    for (int k = 0; k < 50; ++k) {
      Pose faded = *local_rest_pose(rig.character);
      for (const Clip& clip : rig.character.clips) {  // the second over the first, over rest
        Pose local = *local_rest_pose(rig.character);
        ASSERT_TRUE(sample_clip(clip, random.uniform(0, 1), local));
        const auto part = static_cast<float>(random.uniform(0, 1));
        for (std::size_t bone = 0; bone < limits->of_bone.size(); ++bone)
          faded.parent_from_bone[bone] =
              mixed(faded.parent_from_bone[bone], local.parent_from_bone[bone], part);
      }
      ModelPose pose;
      ASSERT_TRUE(compute_model_pose(rig.character.skeleton, faded, pose));
      for (std::size_t bone = 0; bone < limits->of_bone.size(); ++bone) {
        if (limits->of_bone[bone].angle >= std::numbers::pi / 2) continue;
        ++narrow;
        const std::uint32_t parent = rig.character.skeleton.bones[bone].parent;
        const double scale =
            parent == kNone ? 1.0 : rig.bind.model_from_bone[parent].linear().norm();
        expect_within(motion_of(rig, pose, bone), rig.bind.model_from_bone[bone],
                      limits->of_bone[bone], 1e-6 * scale);  // mixed in float
      }
      if (HasFailure()) return;
    }
  }
  EXPECT_GT(narrow, 1000);
}

TEST(JointLimitsOfClips, certify_the_clips) {
  Random random(23);
  for (int i = 0; i < test::stressed(60, 20); ++i) {
    const AnimatedRig rig =
        random_animated_rig(random, static_cast<Scales>(i % 4), i % 2 == 0 ? 0.5 : 2.0, i % 3 == 0);
    const auto limits = joint_limits_of_clips(rig.character, rig.bind, 0);
    ASSERT_TRUE(limits);
    const auto bones = static_cast<std::uint32_t>(limits->of_bone.size());
    const auto tree = JointTree::create(rig.character.skeleton, rig.bind, *limits);
    ASSERT_TRUE(tree) << tree.error().text();
    const test::RandomRig points{rig.character.skeleton, rig.bind, *limits};
    for (int k = 0; k < 5; ++k) {
      const test::RandomWeights a = test::random_weights(random, bones),
                                b = test::random_weights(random, bones);
      const Vec3d p = 0.5 * random.direction();
      std::vector<SkinTerm> terms;
      test::add_terms(a, p, 1, terms);
      test::add_terms(b, p, -1, terms);
      SkinDifferences rows;
      test::append_row(terms, rows);
      const auto certificate = certify_deviation(*tree, rows);
      ASSERT_TRUE(certificate);
      ASSERT_TRUE(certificate->gaps.empty());
      for (const Clip& clip : rig.character.clips)
        for (int s = 0; s <= 40; ++s) {
          const auto pose = pose_at(rig.character, clip, s / 40.0).model_from_bone;
          const double deviation =
              (test::posed_point(points, pose, a, p) - test::posed_point(points, pose, b, p))
                  .norm();
          ASSERT_LE(deviation, certificate->bound[0] + 1e-12) << "rig " << i;
        }
    }
  }
}

/// A bone whose bind is its rest, turned by a clip from one angle to another about z.
Character turned_bone(double from, double to) {
  Character character;
  character.skeleton.bones.resize(1);
  Clip clip;
  clip.duration = 1;
  Channel channel;
  channel.target = ChannelTarget::rotation;
  channel.width = 4;
  channel.times = {0, 1};
  for (const double angle : {from, to}) {
    const Quatf q = Quatd(Eigen::AngleAxisd(angle, Vec3d::UnitZ())).cast<float>();
    channel.values.insert(channel.values.end(), q.coeffs().data(), q.coeffs().data() + 4);
  }
  clip.channels = {channel};
  character.clips = {clip};
  return character;
}

double limit_of(const Character& character, double margin) {
  ModelPose bind;
  bind.model_from_bone.assign(1, Affine3d::Identity());
  const auto limits = joint_limits_of_clips(character, bind, margin);
  EXPECT_TRUE(limits);
  return limits->of_bone[0].angle;
}

TEST(JointLimitsOfClips, slerp_that_passes_half_a_turn_reaches_it) {
  EXPECT_NEAR(limit_of(turned_bone(-0.3, 0.7), 0), 0.7, 1e-5);
  EXPECT_NEAR(limit_of(turned_bone(2.0, 2.5), 0), 2.5, 1e-5);
  EXPECT_NEAR(limit_of(turned_bone(2.5, 3.8), 0), std::numbers::pi, 1e-5)
      << "both keys are below it";
  EXPECT_NEAR(limit_of(turned_bone(-0.3, 0.7), 0.25), 0.95, 1e-5);
}

TEST(JointLimitsOfClips, a_bone_that_no_clip_turns_gets_no_margin) {
  Character character = turned_bone(0, 0.5);
  character.clips.clear();
  EXPECT_LT(limit_of(character, 0.25), 1e-5);
}

TEST(JointLimits, free_joints_turn_without_limit_and_roots_slide) {
  Random random(24);
  const AnimatedRig rig = random_animated_rig(random, Scales::even, 1.0, true);
  const auto limits = free_joint_limits(rig.character, rig.bind);
  ASSERT_TRUE(limits);
  for (std::size_t bone = 0; bone < limits->of_bone.size(); ++bone) {
    const JointRange& range = limits->of_bone[bone];
    EXPECT_EQ(range.angle, std::numbers::pi);
    EXPECT_EQ(std::isinf(range.slide_radius), rig.character.skeleton.bones[bone].parent == kNone);
    if (std::isinf(range.slide_radius)) continue;
    for (const Clip& clip : rig.character.clips)
      for (int s = 0; s <= 20; ++s)
        expect_within(motion_of(rig, pose_at(rig.character, clip, s / 20.0), bone),
                      rig.bind.model_from_bone[bone], range);
  }
}

TEST(JointLimits, faults_of_the_input_are_named) {
  const Character character = turned_bone(0, 1);
  ModelPose bind;
  EXPECT_EQ(free_joint_limits(character, bind).error().code(), StatusCode::size_mismatch);
  bind.model_from_bone.assign(1, Affine3d::Identity());
  EXPECT_EQ(joint_limits_of_clips(character, bind, -1).error().code(),
            StatusCode::invalid_argument);
  bind.model_from_bone[0].linear().col(1).setZero();
  EXPECT_EQ(free_joint_limits(character, bind).error().code(), StatusCode::invalid_argument);
  bind.model_from_bone[0].linear().col(1).setConstant(std::nan(""));
  EXPECT_EQ(free_joint_limits(character, bind).error().code(), StatusCode::non_finite_value);
}

}  // namespace
}  // namespace sunder
