// Contract of ClipEditor: include/sunder/animation/clip_editor.h.

#include <sunder/animation/clip_editor.h>
#include <sunder/animation/clip_player.h>
#include <sunder/animation/edit_pose.h>
#include <sunder/skinning/pose.h>

#include <algorithm>
#include <cmath>
#include <map>

#include <gtest/gtest.h>

#include "support/machine/allocation_count.h"
#include "support/machine/random.h"
#include "support/models/animated_rig.h"
#include "support/models/rigs.h"

namespace sunder::test {
namespace {

std::shared_ptr<const Character> tube() {
  return std::make_shared<const Character>(make_tube(4, 6, 6));
}

/// Some bones and morph weights away from rest.
Pose random_edit(const Character& character, Random& random) {
  Pose pose = *local_rest_pose(character);
  for (std::uint32_t bone = 0; bone < pose.parent_from_bone.size(); ++bone) {
    if (random.index(2) == 0) {
      EXPECT_TRUE(rotate_bone(
          character.skeleton, bone,
          Quatd(Eigen::AngleAxisd(random.uniform(-2, 2), Eigen::Vector3d(random.direction()))),
          EditSpace::bone, pose));
    }
    if (random.index(4) == 0) {
      EXPECT_TRUE(move_bone(character.skeleton, bone, random.direction(), EditSpace::parent, pose));
    }
    if (random.index(5) == 0)
      pose.parent_from_bone[bone].scale.setConstant(static_cast<float>(random.uniform(0.5, 2)));
  }
  for (float& weight : pose.morph_weights)
    if (random.index(2) == 0) weight = static_cast<float>(random.uniform(0, 1));
  return pose;
}

Pose pose_of(const Character& character, const ClipEditor& editor, double time) {
  Pose pose = *local_rest_pose(character);
  const auto clip = editor.snapshot();
  if (!clip) return pose;
  EXPECT_TRUE(sample_clip(**clip, time, pose));
  Character with = character;
  with.clips.push_back(**clip);
  const Status status = validate_character(with);
  EXPECT_TRUE(status) << status.text();
  float last = 0;
  for (const Channel& channel : (*clip)->channels) last = std::max(last, channel.times.back());
  EXPECT_EQ((*clip)->duration, last);
  return pose;
}

void expect_same(const Pose& a, const Pose& b, const std::string& what) {
  for (std::size_t i = 0; i < a.parent_from_bone.size(); ++i) {
    const BoneTransform &one = a.parent_from_bone[i], &other = b.parent_from_bone[i];
    const float sign = one.rotation.dot(other.rotation) < 0 ? -1.0f : 1.0f;
    EXPECT_EQ(one.translation, other.translation) << what << ", bone " << i;
    EXPECT_EQ(one.scale, other.scale) << what << ", bone " << i;
    EXPECT_LT((one.rotation.coeffs() - sign * other.rotation.coeffs()).norm(), 1e-6f)
        << what << ", bone " << i;
  }
  EXPECT_EQ(a.morph_weights, b.morph_weights) << what;
}

TEST(ClipEditor, a_new_clip_passes_through_its_keys) {
  for (const Interpolation interpolation :
       {Interpolation::linear, Interpolation::step, Interpolation::cubic_spline})
    for (const KeyedTracks tracks : {KeyedTracks::tracked, KeyedTracks::all}) {
      for (std::uint64_t seed = 0; seed < 20; ++seed) {
        Random random(seed);
        const auto character = tube();
        ClipEditorOptions options;
        options.interpolation = interpolation;
        auto editor = ClipEditor::create(character, "edit", options);
        ASSERT_TRUE(editor);
        std::map<double, Pose> keys;
        for (int i = 0; i < 8; ++i) {
          const double time = 0.25 * random.index(12);
          keys[time] = random_edit(*character, random);
          ASSERT_TRUE(editor->insert(time, keys[time], tracks));
          for (const auto& [at, pose] : keys)
            expect_same(pose_of(*character, *editor, at), pose, "at " + std::to_string(at));
        }
        EXPECT_EQ(editor->key_times().size(), keys.size());
      }
    }
}

TEST(ClipEditor, an_existing_clip_gets_the_pose_of_the_moment) {
  for (std::uint64_t seed = 0; seed < 30; ++seed) {
    Random random(seed);
    const auto character =
        std::make_shared<const Character>(make_animated_rig(any_animated_rig(random), random));
    const Clip& clip = character->clips[0];
    for (const KeyedTracks tracks :
         {KeyedTracks::tracked, KeyedTracks::changed, KeyedTracks::all}) {
      auto editor = ClipEditor::create(character, clip);
      ASSERT_TRUE(editor);
      EXPECT_EQ(**editor->snapshot(), [&] {
        Clip same = clip;
        same.duration = (*editor->snapshot())->duration;
        return same;
      }());
      const double time = random.uniform(0, static_cast<double>(clip.duration));
      Pose pose = *local_rest_pose(*character);
      ASSERT_TRUE(sample_clip(clip, time, pose));
      const std::uint32_t bone =
          random.index(static_cast<std::uint32_t>(pose.parent_from_bone.size()));
      ASSERT_TRUE(rotate_bone(character->skeleton, bone,
                              Quatd(Eigen::AngleAxisd(0.5, Eigen::Vector3d(random.direction()))),
                              EditSpace::bone, pose));
      ASSERT_TRUE(editor->insert(time, pose, tracks));
      // The time may have snapped to a key.
      const auto times = editor->key_times();
      const float at = *std::min_element(times.begin(), times.end(), [&](float a, float b) {
        return std::abs(static_cast<double>(a) - time) < std::abs(static_cast<double>(b) - time);
      });
      expect_same(pose_of(*character, *editor, static_cast<double>(at)), pose,
                  "seed " + std::to_string(seed));
    }
  }
}

TEST(ClipEditor, changed_keys_leave_other_tracks_alone) {
  const auto character = tube();
  const Clip& clip = character->clips[0];
  auto editor = ClipEditor::create(character, clip);
  Pose pose = *local_rest_pose(*character);
  ASSERT_TRUE(sample_clip(clip, 0.37, pose));
  ASSERT_TRUE(editor->insert(0.37, pose, KeyedTracks::changed));
  EXPECT_EQ((*editor->snapshot())->channels, clip.channels);
  pose.parent_from_bone[2].translation += Vec3f(0, 1, 0);
  ASSERT_TRUE(editor->insert(0.37, pose, KeyedTracks::changed));
  const auto edited = *editor->snapshot();
  ASSERT_EQ(edited->channels.size(), clip.channels.size() + 1);
  EXPECT_TRUE(std::equal(clip.channels.begin(), clip.channels.end(), edited->channels.begin()));
  const Channel& added = edited->channels.back();
  EXPECT_EQ(added.target, ChannelTarget::translation);
  EXPECT_EQ(added.index, 2u);
  EXPECT_EQ(added.times.size(), 3u);  // rest at the keys around it
}

TEST(ClipEditor, snaps_moves_and_removes) {
  const auto character = tube();
  Random random(1);
  auto editor = ClipEditor::create(character, "edit");
  const Pose a = random_edit(*character, random), b = random_edit(*character, random);
  ASSERT_TRUE(editor->insert(1.0, a, KeyedTracks::all));
  ASSERT_TRUE(editor->insert(1.0005, b, KeyedTracks::all));
  EXPECT_EQ(editor->key_times(), std::vector<float>{1.0f});
  expect_same(pose_of(*character, *editor, 1.0), b, "snapped");
  ASSERT_TRUE(editor->insert(2.0, a, KeyedTracks::all));
  ASSERT_TRUE(editor->move(1.0, 3.0));
  EXPECT_EQ(editor->key_times(), (std::vector<float>{2.0f, 3.0f}));
  expect_same(pose_of(*character, *editor, 3.0), b, "moved");
  expect_same(pose_of(*character, *editor, 2.0), a, "left");
  ASSERT_TRUE(editor->move(3.0, 2.0002));  // over the key at 2
  EXPECT_EQ(editor->key_times(), std::vector<float>{2.0f});
  expect_same(pose_of(*character, *editor, 2.0), b, "moved over");
  ASSERT_TRUE(editor->move(2.0, 2.0005));
  EXPECT_EQ(editor->key_times(), std::vector<float>{2.0005f});
  EXPECT_EQ(editor->remove(5.0).code(), StatusCode::not_found);
  EXPECT_EQ(editor->move(5.0, 1.0).code(), StatusCode::not_found);
  ASSERT_TRUE(editor->remove(2.0005));
  EXPECT_EQ(editor->snapshot().error().code(), StatusCode::empty_input);
  ASSERT_TRUE(editor->insert(0.0, a));
}

TEST(ClipEditor, a_first_key_at_rest_is_kept) {
  const auto character = tube();
  Random random(4);
  auto editor = ClipEditor::create(character, "edit");
  const Pose rest = *local_rest_pose(*character), edited = random_edit(*character, random);
  ASSERT_TRUE(editor->insert(0.0, rest));
  ASSERT_TRUE(editor->insert(1.0, edited));
  ASSERT_TRUE(editor->insert(2.0, rest));
  expect_same(pose_of(*character, *editor, 0.0), rest, "first");
  expect_same(pose_of(*character, *editor, 1.0), edited, "second");
  expect_same(pose_of(*character, *editor, 2.0), rest, "third");
}

TEST(ClipEditor, a_snapshot_plays_while_editing_goes_on) {
  const auto character = tube();
  Random random(2);
  auto editor = ClipEditor::create(character, "edit");
  const Pose a = random_edit(*character, random), b = random_edit(*character, random);
  ASSERT_TRUE(editor->insert(0.0, a));
  auto player = ClipPlayer::create(character);
  const auto first = *editor->snapshot();
  const auto layer = player->play(first);
  ASSERT_TRUE(layer);
  Pose pose;
  ASSERT_TRUE(player->evaluate(pose));
  expect_same(pose, a, "at once");
  ASSERT_TRUE(editor->insert(1.0, b));
  EXPECT_EQ(first->duration, 0.0f);
  ASSERT_TRUE(player->replace_clip(*layer, *editor->snapshot()));
  ASSERT_TRUE(player->seek(*layer, 1.0));
  ASSERT_TRUE(player->evaluate(pose));
  expect_same(pose, b, "the new key");
}

TEST(ClipEditor, reduces_keys_within_the_tolerances) {
  const auto character = tube();
  auto editor = ClipEditor::create(character, "recorded");
  std::vector<Pose> frames;
  for (int frame = 0; frame <= 120; ++frame) {
    Pose pose = *local_rest_pose(*character);
    ASSERT_TRUE(sample_clip(character->clips[0], frame / 60.0, pose));
    frames.push_back(pose);
    ASSERT_TRUE(editor->insert(frame / 60.0, pose));
  }
  const auto full = *editor->snapshot();
  ReduceOptions options;
  options.radians = 2e-3;
  ASSERT_TRUE(editor->reduce(options));
  const auto reduced = *editor->snapshot();
  std::size_t before = 0, after = 0;
  for (const Channel& channel : full->channels) before += channel.times.size();
  for (const Channel& channel : reduced->channels) after += channel.times.size();
  EXPECT_LT(after, before / 3);
  for (int frame = 0; frame <= 120; ++frame) {
    const Pose pose =
        pose_of(*character, *editor, static_cast<double>(static_cast<float>(frame / 60.0)));
    for (std::size_t bone = 0; bone < pose.parent_from_bone.size(); ++bone)
      EXPECT_LT(pose.parent_from_bone[bone].rotation.cast<double>().angularDistance(
                    frames[static_cast<std::size_t>(frame)]
                        .parent_from_bone[bone]
                        .rotation.cast<double>()),
                2.1e-3);
  }
}

TEST(ClipEditor, a_lack_of_memory_changes_nothing) {
  if (!FailingAllocations::are_possible()) GTEST_SKIP() << "the sanitizer has its own operator new";
  const auto character = tube();
  Random random(3);
  auto editor = ClipEditor::create(character, "edit");
  ASSERT_TRUE(editor->insert(0.0, random_edit(*character, random)));
  ASSERT_TRUE(editor->insert(1.0, random_edit(*character, random)));
  const auto before = *editor->snapshot();
  const Pose pose = random_edit(*character, random);
  for (std::uint64_t count = 0;; ++count) {
    Status status;
    {
      const FailingAllocations failing(count);
      status = editor->insert(0.5, pose, KeyedTracks::all);
      if (!status) status = editor->move(0.0, 2.0);
    }
    if (status) break;
    EXPECT_EQ(status.code(), StatusCode::limit_exceeded);
    ASSERT_EQ(**editor->snapshot(), *before) << count;
    ASSERT_LT(count, 1000u);
  }
}

TEST(ClipEditor, refuses_bad_arguments) {
  const auto character = tube();
  auto editor = ClipEditor::create(character, "edit");
  Pose pose = *local_rest_pose(*character);
  EXPECT_EQ(editor->insert(-1, pose).code(), StatusCode::invalid_argument);
  EXPECT_EQ(editor->insert(NAN, pose).code(), StatusCode::non_finite_value);
  EXPECT_EQ(editor->insert(0, Pose()).code(), StatusCode::size_mismatch);
  pose.parent_from_bone[1].translation.x() = NAN;
  EXPECT_EQ(editor->insert(0, pose).code(), StatusCode::non_finite_value);
  EXPECT_EQ(editor->snapshot().error().code(), StatusCode::empty_input);
  EXPECT_TRUE(editor->key_times().empty());
  EXPECT_EQ(ClipEditor::create(nullptr, "x").error().code(), StatusCode::empty_input);
  ClipEditorOptions options;
  options.snap = -1;
  EXPECT_EQ(ClipEditor::create(character, "x", options).error().code(),
            StatusCode::invalid_argument);
  Clip wrong = character->clips[0];
  wrong.channels[0].values.pop_back();
  EXPECT_EQ(ClipEditor::create(character, wrong).error().code(), StatusCode::size_mismatch);
}

}  // namespace
}  // namespace sunder::test
