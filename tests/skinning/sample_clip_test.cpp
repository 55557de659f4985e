#include <sunder/skinning/pose.h>

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "support/models/rigs.h"

namespace sunder {
namespace {

Clip one_channel(Channel channel) { return {"clip", channel.times.back(), {std::move(channel)}}; }

Channel translation(Interpolation interpolation, std::vector<float> times,
                    std::vector<float> values) {
  return {ChannelTarget::translation, 1, 3, interpolation, std::move(times), std::move(values)};
}

Vec3f translation_at(const Clip& clip, double time) {
  const Character character = test::make_sheet(1);
  Pose pose = *local_rest_pose(character);
  EXPECT_TRUE(sample_clip(clip, time, pose));
  return pose.parent_from_bone[1].translation;
}

TEST(SampleClip, linear_interpolates_between_keys_and_holds_outside) {
  const Clip clip = one_channel(translation(Interpolation::linear, {1, 3}, {0, 0, 0, 2, 4, 8}));
  EXPECT_EQ(translation_at(clip, -5), Vec3f(0, 0, 0));
  EXPECT_EQ(translation_at(clip, 1.5), Vec3f(0.5, 1, 2));
  EXPECT_EQ(translation_at(clip, 3), Vec3f(2, 4, 8));
  EXPECT_EQ(translation_at(clip, 99), Vec3f(2, 4, 8));
}

TEST(SampleClip, step_holds_the_key_before) {
  const Clip clip =
      one_channel(translation(Interpolation::step, {0, 1, 2}, {1, 0, 0, 2, 0, 0, 3, 0, 0}));
  EXPECT_EQ(translation_at(clip, 0.999).x(), 1);
  EXPECT_EQ(translation_at(clip, 1.0).x(), 2);
  EXPECT_EQ(translation_at(clip, 1.5).x(), 2);
}

TEST(SampleClip, cubic_spline_meets_keys_and_reproduces_a_cubic) {
  // x(t) = t^3 on [0, 2]: tangents 0 and 12.
  const Clip clip =
      one_channel(translation(Interpolation::cubic_spline, {0, 2},
                              {0, 0, 0, 0, 0, 0, 0, 0, 0, 12, 0, 0, 8, 0, 0, 0, 0, 0}));
  for (const double t : {0.0, 0.3, 1.0, 1.7, 2.0})
    EXPECT_NEAR(static_cast<double>(translation_at(clip, t).x()), t * t * t, 1e-5);
}

TEST(SampleClip, rotations_take_the_short_way_at_even_speed) {
  const float h = std::sqrt(0.5f);
  Channel channel{ChannelTarget::rotation,   1, 4, Interpolation::linear, {0, 1},
                  {0, 0, 0, 1, 0, 0, -h, -h}};  // 90 degrees, sign flipped
  Pose pose = *local_rest_pose(test::make_sheet(1));
  ASSERT_TRUE(sample_clip(one_channel(channel), 1.0 / 3, pose));
  const Quatd rotation = pose.parent_from_bone[1].rotation.cast<double>();
  EXPECT_NEAR(2 * std::atan2(std::abs(rotation.z()), std::abs(rotation.w())), M_PI / 6, 1e-6);
  EXPECT_NEAR(rotation.norm(), 1, 1e-6);
}

TEST(SampleClip, drives_morph_weights) {
  const Character character = test::make_tube(2, 4, 2);
  Pose pose = *local_rest_pose(character);
  const Clip clip =
      one_channel({ChannelTarget::morph_weights, 0, 1, Interpolation::linear, {0, 1}, {0, 1}});
  ASSERT_TRUE(sample_clip(clip, 0.25, pose));
  EXPECT_FLOAT_EQ(pose.morph_weights[0], 0.25f);
}

TEST(SampleClip, leaves_undriven_values_unchanged) {
  const Character character = test::make_tube(2, 4, 3);
  Pose pose = *local_rest_pose(character);
  ASSERT_TRUE(sample_clip(character.clips[0], 0.5, pose));
  EXPECT_EQ(pose.parent_from_bone[0], character.skeleton.bones[0].rest);
  EXPECT_EQ(pose.parent_from_bone[1].translation, character.skeleton.bones[1].rest.translation);
  EXPECT_NE(pose.parent_from_bone[1].rotation.coeffs(),
            character.skeleton.bones[1].rest.rotation.coeffs());
}

TEST(SampleClip, refuses_a_pose_of_another_character_and_writes_nothing) {
  const Character character = test::make_tube(2, 4, 3);
  Pose pose = *local_rest_pose(test::make_sheet(1));
  const Pose before = pose;
  EXPECT_EQ(sample_clip(character.clips[0], 0.5, pose).code(), StatusCode::size_mismatch);
  EXPECT_EQ(pose.parent_from_bone, before.parent_from_bone);
  EXPECT_EQ(sample_clip(character.clips[0], std::numeric_limits<double>::infinity(), pose).code(),
            StatusCode::non_finite_value);
}

}  // namespace
}  // namespace sunder
