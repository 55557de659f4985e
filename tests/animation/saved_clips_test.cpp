// Clips that were made or edited while a character played, written with the torn model: save_glb().

#include <sunder/animation/clip_editor.h>
#include <sunder/animation/clip_player.h>
#include <sunder/animation/edit_pose.h>
#include <sunder/io/character_file.h>
#include <sunder/skinning/pose.h>
#include <sunder/tear/torn_model.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <optional>

#include <gtest/gtest.h>

#include "support/machine/gltf_validator.h"
#include "support/machine/random.h"
#include "support/machine/temporary_folder.h"
#include "support/models/gltf_builder.h"
#include "support/models/rigs.h"
#include "support/models/shared_models.h"

namespace sunder::test {
namespace {

/// Poses of some bones that a file can animate, kept as keys.
std::shared_ptr<const Clip> clip_on_the_fly(std::shared_ptr<const Character> character,
                                            Random& random) {
  ClipEditorOptions options;
  options.interpolation = static_cast<Interpolation>(random.index(3));
  auto editor = ClipEditor::create(character, "kept on the fly", options);
  EXPECT_TRUE(editor);
  for (int key = 0; key < 4; ++key) {
    Pose pose = *local_rest_pose(*character);
    for (std::uint32_t bone = 0; bone < pose.parent_from_bone.size(); ++bone) {
      if (random.index(3) != 0) continue;
      if (character->skeleton.bones[bone].name.find("#shear") != std::string::npos) continue;
      const Quatd turn(
          Eigen::AngleAxisd(random.uniform(-1, 1), Eigen::Vector3d(random.direction())));
      EXPECT_TRUE(rotate_bone(character->skeleton, bone, turn, EditSpace::bone, pose));
      if (random.index(3) == 0) {
        EXPECT_TRUE(move_bone(character->skeleton, bone, 0.1 * random.direction(),
                              EditSpace::parent, pose));
      }
    }
    for (float& weight : pose.morph_weights) weight = static_cast<float>(random.uniform(0, 1));
    EXPECT_TRUE(editor->insert(0.4 * key, pose));
  }
  const auto clip = editor->snapshot();
  EXPECT_TRUE(clip) << clip.error().text();
  return clip ? *clip : nullptr;
}

/// The torn character with another clip.
std::optional<Character> torn_with(std::shared_ptr<const Character> source, const Clip& clip,
                                   Random& random) {
  auto torn = TornModel::create(source);
  if (!torn) return std::nullopt;
  const auto pose = rest_pose(*source);
  for (int stroke = 0; stroke < 3; ++stroke)
    (void)torn->tear(*pose, random_stroke(*source, *pose, random));
  Character with = torn->character();
  with.clips.push_back(clip);
  return with;
}

std::uint32_t bone_named(const Character& character, const std::string& name) {
  for (std::uint32_t bone = 0; bone < character.skeleton.bones.size(); ++bone)
    if (character.skeleton.bones[bone].name == name) return bone;
  ADD_FAILURE() << name;
  return 0;
}

void expect_same_poses(const Character& a, const Clip& first, const Character& b,
                       const Clip& second, const std::string& what) {
  for (double time = -0.1; time < static_cast<double>(first.duration) + 0.2; time += 0.0371) {
    Pose one = *local_rest_pose(a), other = *local_rest_pose(b);
    ASSERT_TRUE(sample_clip(first, time, one));
    ASSERT_TRUE(sample_clip(second, time, other));
    for (std::size_t bone = 0; bone < one.parent_from_bone.size(); ++bone) {
      const BoneTransform& x = one.parent_from_bone[bone];
      const BoneTransform& y = other.parent_from_bone[bone_named(b, a.skeleton.bones[bone].name)];
      EXPECT_LT((x.translation - y.translation).norm(), 1e-6f) << what;
      EXPECT_LT((x.rotation.coeffs() - y.rotation.coeffs()).norm(), 1e-6f) << what;
      EXPECT_LT((x.scale - y.scale).norm(), 1e-6f) << what;
    }
    for (std::size_t i = 0; i < one.morph_weights.size(); ++i)
      EXPECT_NEAR(one.morph_weights[i], other.morph_weights[i], 1e-6f) << what;
  }
}

/// All files of a folder, by one run of the validator.
void expect_all_valid(const std::filesystem::path& folder) {
  if (!has_gltf_validator()) return;
  for (const ValidatorReport& report : validate_glbs_of(folder))
    EXPECT_EQ(report.errors, 0) << report.output;
}

void expect_valid(const std::filesystem::path& file) {
  if (!has_gltf_validator()) return;
  const ValidatorReport report = validate_glb(file);
  EXPECT_EQ(report.errors, 0) << report.output;
}

TEST(SavedClips, a_new_clip_is_written_with_the_torn_model) {
  std::uint64_t seed = 0;
  const TemporaryFolder folder;
  for (const auto& model : rigged_gltf_models()) {
    Random random(++seed);
    const std::string what = model.filename().string();
    const auto loaded = load_character(model);
    ASSERT_TRUE(loaded) << what;
    const auto clip = clip_on_the_fly(loaded->character, random);
    ASSERT_NE(clip, nullptr) << what;
    const auto torn = torn_with(loaded->character, *clip, random);
    if (!torn) continue;  // a model that cannot be torn
    const auto file = folder.path() / (model.stem().string() + ".glb");
    const Status saved = save_glb(file, *torn, *loaded);
    ASSERT_TRUE(saved) << what << ": " << saved.text();
    const auto again = load_character(file);
    ASSERT_TRUE(again) << what;
    const Character& read = *again->character;
    ASSERT_EQ(read.clips.size(), torn->clips.size()) << what;
    for (std::size_t i = 0; i + 1 < read.clips.size(); ++i)
      EXPECT_EQ(read.clips[i], torn->clips[i]) << what;
    EXPECT_EQ(read.clips.back().name, clip->name) << what;
    EXPECT_EQ(read.clips.back().duration, clip->duration) << what;
    EXPECT_EQ(read.skeleton, torn->skeleton) << what;
    expect_same_poses(*torn, *clip, read, read.clips.back(), what);
  }
  expect_all_valid(folder.path());
}

TEST(SavedClips, an_edited_clip_takes_the_place_of_the_one_of_the_file) {
  std::uint32_t edited_files = 0;
  const TemporaryFolder folder;
  for (const auto& model : rigged_gltf_models()) {
    const auto loaded = load_character(model);
    ASSERT_TRUE(loaded);
    const Character& source = *loaded->character;
    if (source.clips.empty() || source.clips[0].channels.empty()) continue;
    const std::string what = model.filename().string();
    auto editor = ClipEditor::create(loaded->character, source.clips[0]);
    ASSERT_TRUE(editor);
    Pose pose = *local_rest_pose(source);
    const double time = 0.41 * static_cast<double>(source.clips[0].duration);
    ASSERT_TRUE(sample_clip(source.clips[0], time, pose));
    const std::uint32_t bone = source.clips[0].channels[0].index %
                               static_cast<std::uint32_t>(pose.parent_from_bone.size());
    ASSERT_TRUE(rotate_bone(source.skeleton, bone,
                            Quatd(Eigen::AngleAxisd(0.7, Eigen::Vector3d::UnitX())),
                            EditSpace::bone, pose));
    ASSERT_TRUE(editor->insert(time, pose, KeyedTracks::changed));
    Character edited = source;
    edited.clips[0] = **editor->snapshot();
    const auto file = folder.path() / (model.stem().string() + ".glb");
    const Status saved = save_glb(file, edited, *loaded);
    ASSERT_TRUE(saved) << what << ": " << saved.text();
    const auto again = load_character(file);
    ASSERT_TRUE(again) << what;
    ASSERT_EQ(again->character->clips.size(), edited.clips.size());
    EXPECT_EQ(again->character->meshes, source.meshes) << what;
    EXPECT_EQ(again->character->clips[0].name, source.clips[0].name);
    for (std::size_t i = 1; i < edited.clips.size(); ++i)
      EXPECT_EQ(again->character->clips[i], source.clips[i]) << what;
    expect_same_poses(edited, edited.clips[0], *again->character, again->character->clips[0], what);
    ++edited_files;
  }
  EXPECT_GT(edited_files, 0u);
  expect_all_valid(folder.path());
}

TEST(SavedClips, a_character_without_a_file_is_written_with_its_new_clip) {
  Random random(7);
  const auto character = std::make_shared<const Character>(make_tube(8, 8, 5));
  const auto clip = clip_on_the_fly(character, random);
  ASSERT_NE(clip, nullptr);
  const auto torn = torn_with(character, *clip, random);
  ASSERT_TRUE(torn);
  const TemporaryFolder folder;
  const auto file = folder.path() / "torn.glb";
  ASSERT_TRUE(save_glb(file, *torn));
  expect_valid(file);
  const auto again = load_character(file);
  ASSERT_TRUE(again);
  ASSERT_EQ(again->character->clips.size(), 2u);
  EXPECT_EQ(again->character->clips[0], torn->clips[0]);
  expect_same_poses(*torn, *clip, *again->character, again->character->clips[1], "tube");
}

/// A clip that turns a bone.
Clip turning(std::uint32_t bone) {
  const float h = std::sqrt(0.5f);
  return {"turn",
          1.0f,
          {{ChannelTarget::rotation,
            bone,
            4,
            Interpolation::linear,
            {0, 1},
            {0, 0, 0, 1, h, 0, 0, h}}}};
}

TEST(SavedClips, a_node_with_a_matrix_gets_parts_that_can_be_animated) {
  GltfBuilder builder = skinned_strip();
  builder.json["nodes"][1]["matrix"] = {0, -2, 0, 0, -3, 0, 0, 0, 0, 0, 4, 0, 5, 6, 7, 1};
  const auto loaded = builder.load();
  ASSERT_TRUE(loaded) << loaded.error().text();
  Character with = *loaded->character;
  const Clip clip = turning(bone_named(with, "root"));
  with.clips.push_back(clip);
  const TemporaryFolder folder;
  const auto file = folder.path() / "matrix.glb";
  const Status saved = save_glb(file, with, *loaded);
  ASSERT_TRUE(saved) << saved.text();
  expect_valid(file);
  const auto again = load_character(file);
  ASSERT_TRUE(again);
  EXPECT_EQ(again->character->skeleton, with.skeleton);
  ASSERT_EQ(again->character->clips.size(), with.clips.size());
  expect_same_poses(with, clip, *again->character, again->character->clips.back(), "matrix");
}

TEST(SavedClips, a_sheared_node_is_refused) {
  GltfBuilder builder = skinned_strip();
  builder.json["nodes"][1]["matrix"] = {1, 0, 0, 0, 0.5, 1, 0, 0, 0, 0.25, -2, 0, 5, 6, 7, 1};
  const auto loaded = builder.load();
  ASSERT_TRUE(loaded) << loaded.error().text();
  const TemporaryFolder folder;
  const auto file = folder.path() / "sheared.glb";
  for (const char* const name : {"root", "root#shear"}) {
    Character with = *loaded->character;
    with.clips.push_back(turning(bone_named(with, name)));
    const Status saved = save_glb(file, with, *loaded);
    EXPECT_EQ(saved.code(), StatusCode::invalid_argument) << name;
    EXPECT_FALSE(std::filesystem::exists(file));
  }
}

TEST(SavedClips, refuses_what_gltf_cannot_express) {
  const auto models = rigged_gltf_models();
  ASSERT_FALSE(models.empty());
  const auto loaded = load_character(models[0]);
  ASSERT_TRUE(loaded);
  const TemporaryFolder folder;
  const auto file = folder.path() / "bad.glb";
  Character fewer = *loaded->character;
  if (!fewer.clips.empty()) {
    fewer.clips.pop_back();
    EXPECT_EQ(save_glb(file, fewer, *loaded).code(), StatusCode::invalid_argument);
  }
  Character wrong = *loaded->character;
  Clip clip;
  clip.name = "wrong";
  clip.channels.push_back(
      {ChannelTarget::translation, 100000, 3, Interpolation::linear, {0}, {0, 0, 0}});
  wrong.clips.push_back(clip);
  EXPECT_EQ(save_glb(file, wrong, *loaded).code(), StatusCode::index_out_of_range);
  EXPECT_FALSE(std::filesystem::exists(file));
}

}  // namespace
}  // namespace sunder::test
