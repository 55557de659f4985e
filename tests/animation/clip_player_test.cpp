// Contract of ClipPlayer: include/sunder/animation/clip_player.h.

#include <sunder/animation/clip_player.h>
#include <sunder/skinning/pose.h>

#include <cmath>

#include <gtest/gtest.h>

#include "support/machine/allocation_count.h"
#include "support/machine/random.h"
#include "support/models/animated_rig.h"
#include "support/models/rigs.h"

namespace sunder::test {
namespace {

std::shared_ptr<const Character> some_rig(std::uint64_t seed, std::uint32_t clips = 3) {
  Random random(seed);
  AnimatedRig wanted;
  wanted.clips = clips;
  return std::make_shared<const Character>(make_animated_rig(wanted, random));
}

Pose sampled(const Character& character, std::uint32_t clip, double time) {
  Pose pose = *local_rest_pose(character);
  EXPECT_TRUE(sample_clip(character.clips[clip], time, pose));
  return pose;
}

double length_of(const Clip& clip) {
  double length = 0;
  for (const Channel& channel : clip.channels)
    length = std::max(length, static_cast<double>(channel.times.back()));
  return length;
}

double pose_distance(const Pose& a, const Pose& b) {
  double most = 0;
  for (std::size_t i = 0; i < a.parent_from_bone.size(); ++i) {
    const BoneTransform &one = a.parent_from_bone[i], &other = b.parent_from_bone[i];
    const float sign = one.rotation.dot(other.rotation) < 0 ? -1.0f : 1.0f;
    most = std::max(
        {most, static_cast<double>((one.translation - other.translation).norm()),
         static_cast<double>((one.rotation.coeffs() - sign * other.rotation.coeffs()).norm())});
  }
  return most;
}

TEST(ClipPlayer, alone_gives_the_bits_of_sample_clip) {
  for (std::uint64_t seed = 0; seed < 10; ++seed) {
    const auto character = some_rig(seed);
    auto player = ClipPlayer::create(character);
    ASSERT_TRUE(player);
    const double length = length_of(character->clips[0]);
    LayerOptions options;
    options.mode = PlayMode::once;
    const auto layer = player->play(clip_of(character, 0), options);
    ASSERT_TRUE(layer) << layer.error().text();
    Pose pose;
    Random random(seed);
    for (int i = 0; i < 60; ++i) {
      // Forwards, in small and large steps, and anywhere.
      if (i % 7 == 6) {
        ASSERT_TRUE(player->seek(*layer, random.uniform(0, length)));
      } else {
        ASSERT_TRUE(player->advance(random.uniform(0, 0.05)));
      }
      ASSERT_TRUE(player->evaluate(pose));
      const Pose expected = sampled(*character, 0, player->layer(*layer)->time);
      EXPECT_EQ(pose.parent_from_bone, expected.parent_from_bone);
      EXPECT_EQ(pose.morph_weights, expected.morph_weights);
    }
  }
}

TEST(ClipPlayer, nothing_playing_is_the_rest_pose_and_changes_nothing) {
  const auto character = some_rig(1);
  auto player = ClipPlayer::create(character);
  ASSERT_TRUE(player);
  EXPECT_TRUE(player->has_changed());
  Pose pose;
  ASSERT_TRUE(player->evaluate(pose));
  EXPECT_EQ(pose.parent_from_bone, local_rest_pose(*character)->parent_from_bone);
  const std::uint64_t revision = player->revision();
  for (int i = 0; i < 10; ++i) ASSERT_TRUE(player->advance(0.1));
  EXPECT_EQ(player->revision(), revision);
  EXPECT_FALSE(player->has_changed());
}

TEST(ClipPlayer, loops_turns_around_and_ends) {
  const auto character = some_rig(2);
  const double length = length_of(character->clips[0]);
  ASSERT_GT(length, 0.1);
  const auto time_after = [&](PlayMode mode, double speed, double seconds) {
    auto player = ClipPlayer::create(character);
    LayerOptions options;
    options.mode = mode;
    options.speed = speed;
    const auto layer = player->play(clip_of(character, 0), options);
    for (int i = 0; i < 64; ++i) EXPECT_TRUE(player->advance(seconds / 64));
    return player->layer(*layer)->time;
  };
  EXPECT_NEAR(time_after(PlayMode::loop, 1, 2.25 * length), 0.25 * length, 1e-9);
  EXPECT_NEAR(time_after(PlayMode::loop, -1, 2.25 * length), 0.75 * length, 1e-9);
  EXPECT_NEAR(time_after(PlayMode::ping_pong, 1, 1.25 * length), 0.75 * length, 1e-9);
  EXPECT_NEAR(time_after(PlayMode::ping_pong, 2, 1.25 * length), 0.5 * length, 1e-9);
  EXPECT_NEAR(time_after(PlayMode::once, 1, 2.25 * length), length, 1e-9);
  EXPECT_NEAR(time_after(PlayMode::once, 0.5, length), 0.5 * length, 1e-9);
}

TEST(ClipPlayer, the_revision_says_whether_the_pose_may_have_changed) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const auto character = some_rig(seed);
    auto player = ClipPlayer::create(character);
    Random random(seed);
    std::vector<LayerId> layers;
    Pose last;
    ASSERT_TRUE(player->evaluate(last));
    std::uint32_t idle_frames = 0;
    for (int frame = 0; frame < 200; ++frame) {
      const std::uint64_t revision = player->revision();
      if (frame % 20 == 0 && frame < 100) {
        LayerOptions options;
        options.kind = static_cast<LayerKind>(random.index(3));
        options.mode = random.index(3) == 0 ? PlayMode::loop : PlayMode::once;
        options.fade_in = random.uniform(0, 0.3);
        options.fade_out = random.index(2) == 0 ? 0.2 : 0.0;
        options.weight = static_cast<float>(random.uniform(0, 1));
        const auto layer = player->play(clip_of(character, random.index(3)), options);
        ASSERT_TRUE(layer);
        layers.push_back(*layer);
      } else if (frame % 33 == 0) {
        (void)player->stop(layers[random.index(static_cast<std::uint32_t>(layers.size()))], 0.1);
      }
      if (frame == 150) player->stop_all();
      ASSERT_TRUE(player->advance(random.uniform(0, 0.1)));
      const bool has_changed = player->revision() != revision;
      EXPECT_EQ(has_changed, player->has_changed());
      Pose pose;
      ASSERT_TRUE(player->evaluate(pose));
      if (!has_changed) {
        ++idle_frames;
        EXPECT_EQ(pose.parent_from_bone, last.parent_from_bone);
        EXPECT_EQ(pose.morph_weights, last.morph_weights);
      }
      last = pose;
    }
    EXPECT_GE(idle_frames, 45u);
  }
}

TEST(ClipPlayer, cross_fade_goes_from_one_pose_to_the_other) {
  const auto character = some_rig(3);
  auto player = ClipPlayer::create(character);
  LayerOptions still;
  still.speed = 0;
  still.time = 0.1;
  ASSERT_TRUE(player->play(clip_of(character, 0), still));
  still.fade_in = 1.0;
  still.easing = Easing::linear;
  ASSERT_TRUE(player->cross_fade(clip_of(character, 1), still));
  const Pose a = sampled(*character, 0, 0.1), b = sampled(*character, 1, 0.1);
  Pose pose;
  ASSERT_TRUE(player->evaluate(pose));
  EXPECT_EQ(pose.parent_from_bone, a.parent_from_bone);
  for (int i = 1; i <= 4; ++i) {
    ASSERT_TRUE(player->advance(0.25));
    ASSERT_TRUE(player->evaluate(pose));
    Pose expected = a;
    ASSERT_TRUE(blend_towards(b, 0.25f * static_cast<float>(i), expected));
    EXPECT_LT(pose_distance(pose, expected), 1e-6) << i;
  }
  EXPECT_EQ(player->layer_count(), 1u);
  EXPECT_EQ(pose.parent_from_bone, b.parent_from_bone);
}

TEST(ClipPlayer, an_interrupted_cross_fade_does_not_jump) {
  const auto character = some_rig(4);
  auto player = ClipPlayer::create(character);
  LayerOptions options;
  ASSERT_TRUE(player->play(clip_of(character, 0), options));
  options.fade_in = 0.5;
  Pose before, pose;
  ASSERT_TRUE(player->evaluate(before));
  double largest_step = 0;
  for (int frame = 0; frame < 600; ++frame) {
    if (frame % 50 == 25) {
      ASSERT_TRUE(player->cross_fade(clip_of(character, static_cast<std::uint32_t>(frame / 50) % 3),
                                     options));
    }
    ASSERT_TRUE(player->advance(0.002));
    ASSERT_TRUE(player->evaluate(pose));
    largest_step = std::max(largest_step, pose_distance(before, pose));
    before = pose;
  }
  EXPECT_LT(largest_step, 0.1);
  EXPECT_LE(player->layer_count(), 6u);
}

TEST(ClipPlayer, layers_of_parts_and_additive_layers) {
  const auto character = std::make_shared<const Character>(make_tube(4, 6, 5));
  auto player = ClipPlayer::create(character);
  // A clip that turns bone 3 only.
  const float h = std::sqrt(0.5f);
  const auto clip = std::make_shared<const Clip>(Clip{
      "turn", 0.0f, {{ChannelTarget::rotation, 3, 4, Interpolation::linear, {0}, {0, 0, h, h}}}});
  LayerOptions still;
  still.speed = 0;
  still.time = 0.7;
  ASSERT_TRUE(player->play(clip_of(character, 0), still));
  const Pose below = sampled(*character, 0, 0.7);
  LayerOptions parts;
  parts.kind = LayerKind::animated;
  const auto layer = player->play(clip, parts);
  ASSERT_TRUE(layer);
  Pose pose;
  ASSERT_TRUE(player->evaluate(pose));
  for (std::uint32_t bone = 0; bone < 5; ++bone)
    EXPECT_EQ(pose.parent_from_bone[bone] == below.parent_from_bone[bone], bone != 3) << bone;
  EXPECT_LT((pose.parent_from_bone[3].rotation.coeffs() - Vec4f(0, 0, h, h)).norm(), 1e-6f);
  EXPECT_EQ(pose.parent_from_bone[3].translation, below.parent_from_bone[3].translation);
  ASSERT_TRUE(player->stop(*layer));
  EXPECT_EQ(player->stop(*layer).code(), StatusCode::not_found);
  parts.kind = LayerKind::additive;
  ASSERT_TRUE(player->play(clip, parts));
  ASSERT_TRUE(player->evaluate(pose));
  const Quatf rest = character->skeleton.bones[3].rest.rotation;
  const Quatf expected = below.parent_from_bone[3].rotation * rest.conjugate() * Quatf(h, 0, 0, h);
  EXPECT_LT(pose.parent_from_bone[3].rotation.angularDistance(expected), 2e-3f);
  for (std::uint32_t bone = 0; bone < 3; ++bone)
    EXPECT_LT((pose.parent_from_bone[bone].rotation.coeffs() -
               below.parent_from_bone[bone].rotation.coeffs())
                  .norm(),
              1e-6f);
}

TEST(ClipPlayer, a_mask_keeps_a_layer_to_its_bones) {
  const auto character = some_rig(5);
  auto player = ClipPlayer::create(character);
  LayerOptions options;
  options.mask = std::make_shared<const BoneMask>(*subtree_mask(character->skeleton, 2));
  options.time = 0.2;
  ASSERT_TRUE(player->play(clip_of(character, 0), options));
  Pose pose;
  ASSERT_TRUE(player->evaluate(pose));
  const Pose rest = *local_rest_pose(*character), whole = sampled(*character, 0, 0.2);
  for (std::size_t bone = 0; bone < pose.parent_from_bone.size(); ++bone)
    EXPECT_EQ(pose.parent_from_bone[bone],
              (options.mask->bones[bone] > 0 ? whole : rest).parent_from_bone[bone]);
}

TEST(ClipPlayer, fades_out_at_the_end_of_a_clip_and_ends) {
  const auto character = some_rig(6);
  const double length = length_of(character->clips[0]);
  auto player = ClipPlayer::create(character);
  LayerOptions options;
  options.mode = PlayMode::once;
  options.fade_out = 0.25 * length;
  options.easing = Easing::linear;
  const auto layer = player->play(clip_of(character, 0), options);
  for (int i = 0; i < 7; ++i) ASSERT_TRUE(player->advance(0.125 * length));
  EXPECT_NEAR(player->layer(*layer)->weight, 0.5f, 1e-4f);
  for (int i = 0; i < 2; ++i) ASSERT_TRUE(player->advance(0.125 * length));
  EXPECT_EQ(player->layer_count(), 0u);
  EXPECT_EQ(player->layer(*layer).error().code(), StatusCode::not_found);
}

TEST(ClipPlayer, a_clip_is_replaced_while_it_plays) {
  const auto character = some_rig(7);
  auto player = ClipPlayer::create(character);
  const auto layer = player->play(clip_of(character, 0), {});
  ASSERT_TRUE(player->advance(0.05));
  const double time = player->layer(*layer)->time;
  const std::uint64_t revision = player->revision();
  ASSERT_TRUE(player->replace_clip(*layer, clip_of(character, 1)));
  EXPECT_GT(player->revision(), revision);
  EXPECT_EQ(player->layer(*layer)->time, time);
  Pose pose;
  ASSERT_TRUE(player->evaluate(pose));
  EXPECT_EQ(pose.parent_from_bone, sampled(*character, 1, time).parent_from_bone);
}

TEST(ClipPlayer, a_warm_frame_allocates_nothing) {
  const auto character = some_rig(8);
  auto player = ClipPlayer::create(character);
  LayerOptions options;
  ASSERT_TRUE(player->play(clip_of(character, 0), options));
  options.kind = LayerKind::additive;
  ASSERT_TRUE(player->play(clip_of(character, 1), options));
  options.kind = LayerKind::animated;
  options.weight = 0.5f;
  const auto last = player->play(clip_of(character, 2), options);
  Pose pose;
  ASSERT_TRUE(player->evaluate(pose));
  const std::uint64_t before = allocation_count();
  for (int frame = 0; frame < 100; ++frame) {
    if (frame == 50) {
      ASSERT_TRUE(player->stop(*last, 0.1));
    }
    ASSERT_TRUE(player->advance(0.01));
    ASSERT_TRUE(player->evaluate(pose));
  }
  EXPECT_EQ(allocation_count(), before);
  EXPECT_EQ(player->layer_count(), 2u);
}

TEST(ClipPlayer, survives_a_lack_of_memory) {
  if (!FailingAllocations::are_possible()) GTEST_SKIP() << "the sanitizer has its own operator new";
  const auto character = some_rig(9);
  auto player = ClipPlayer::create(character);
  const auto clip = clip_of(character, 0);
  std::uint64_t count = 0;
  for (;; ++count) {
    const std::uint32_t layers = player->layer_count();
    bool has_worked = false;
    {
      const FailingAllocations failing(count);
      has_worked = player->play(clip, {}).has_value();
    }
    EXPECT_EQ(player->layer_count(), layers + (has_worked ? 1 : 0));
    if (has_worked) break;
    ASSERT_LT(count, 100u);
  }
  EXPECT_GT(count, 0u);
  Pose pose;
  ASSERT_TRUE(player->evaluate(pose));
  EXPECT_EQ(pose.parent_from_bone, sampled(*character, 0, 0).parent_from_bone);
}

TEST(ClipPlayer, refuses_bad_arguments) {
  const auto character = some_rig(10);
  auto player = ClipPlayer::create(character);
  EXPECT_EQ(ClipPlayer::create(nullptr).error().code(), StatusCode::empty_input);
  EXPECT_EQ(player->play(nullptr).error().code(), StatusCode::empty_input);
  EXPECT_EQ(clip_of(character, 99), nullptr);
  auto wrong = std::make_shared<Clip>(character->clips[0]);
  wrong->channels[0].index = 1000;
  EXPECT_EQ(player->play(wrong).error().code(), StatusCode::index_out_of_range);
  const auto clip = clip_of(character, 0);
  const auto code = [&](const auto& change) {
    LayerOptions options;
    change(options);
    return player->play(clip, options).error().code();
  };
  EXPECT_EQ(code([](LayerOptions& o) { o.speed = NAN; }), StatusCode::non_finite_value);
  EXPECT_EQ(code([](LayerOptions& o) { o.time = INFINITY; }), StatusCode::non_finite_value);
  EXPECT_EQ(code([](LayerOptions& o) { o.weight = 1.5f; }), StatusCode::invalid_argument);
  EXPECT_EQ(code([](LayerOptions& o) { o.fade_in = -1; }), StatusCode::invalid_argument);
  EXPECT_EQ(code([](LayerOptions& o) { o.fade_out = NAN; }), StatusCode::invalid_argument);
  EXPECT_EQ(code([](LayerOptions& o) { o.mask = std::make_shared<const BoneMask>(); }),
            StatusCode::size_mismatch);
  EXPECT_EQ(code([](LayerOptions& o) { o.reference = std::make_shared<const Pose>(); }),
            StatusCode::size_mismatch);
  LayerOptions additive;
  additive.kind = LayerKind::additive;
  EXPECT_EQ(player->cross_fade(clip, additive).error().code(), StatusCode::invalid_argument);
  EXPECT_EQ(player->advance(-1).code(), StatusCode::invalid_argument);
  EXPECT_EQ(player->advance(NAN).code(), StatusCode::non_finite_value);
  EXPECT_EQ(player->fade({5, 0}, 1, 1).code(), StatusCode::not_found);
  EXPECT_EQ(player->layer_count(), 0u);
}

}  // namespace
}  // namespace sunder::test
