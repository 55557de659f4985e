// load_character() on glTF: nodes to bones, and clips.

#include <set>
#include <string>

#include <gtest/gtest.h>

#include "support/models/gltf_builder.h"

namespace sunder::test {
namespace {

const Bone& bone_named(const Character& character, const std::string& name) {
  for (const Bone& bone : character.skeleton.bones)
    if (bone.name == name) return bone;
  throw std::runtime_error("no bone " + name);
}

Eigen::Matrix4d matrix_of(const BoneTransform& transform) {
  Eigen::Affine3d affine = Eigen::Affine3d::Identity();
  affine.translate(transform.translation.cast<double>());
  affine.rotate(transform.rotation.cast<double>());
  affine.scale(transform.scale.cast<double>());
  return affine.matrix();
}

TEST(LoadGltfSkeleton, every_node_of_the_scene_is_a_bone_after_its_parent) {
  const auto loaded = skinned_strip().load(strict());
  ASSERT_TRUE(loaded.has_value()) << loaded.error().text();
  const auto& bones = loaded->character->skeleton.bones;
  ASSERT_EQ(bones.size(), 3u);
  EXPECT_EQ(bones[0].name, "body");
  EXPECT_EQ(bones[1].name, "root");
  EXPECT_EQ(bones[2].name, "tip");
  EXPECT_EQ(bones[2].parent, 1u);
  EXPECT_EQ(bones[2].rest.translation, Vec3f(0, 1, 0));
}

TEST(LoadGltfSkeleton, names_are_unique_and_not_empty_for_C_too) {
  GltfBuilder builder = skinned_strip();
  for (const char last : {'1', '2', '\0'}) {
    const std::string name = last == '\0' ? std::string(1, '\0') : std::string("a\0", 2) + last;
    builder.json["nodes"][1]["children"].push_back(builder.json["nodes"].size());
    builder.json["nodes"].push_back({{"name", name}});
  }
  const auto loaded = builder.load();
  ASSERT_TRUE(loaded.has_value()) << loaded.error().text();
  std::set<std::string> names;
  for (const Bone& bone : loaded->character->skeleton.bones)
    EXPECT_TRUE(names.insert(bone.name.c_str()).second && *bone.name.c_str() != '\0') << bone.name;
  EXPECT_EQ(names.count(std::string("a\xEF\xBF\xBD") + '2'), 1u);
}

TEST(LoadGltfSkeleton, names_become_unique_and_originals_win) {
  GltfBuilder builder = skinned_strip();
  for (const char* const name : {"tip", "", "tip#2"}) {
    builder.json["nodes"][1]["children"].push_back(builder.json["nodes"].size());
    builder.json["nodes"].push_back({{"name", name}});
  }
  const auto loaded = builder.load(strict());
  ASSERT_TRUE(loaded.has_value()) << loaded.error().text();
  std::vector<std::string> names;
  for (const Bone& bone : loaded->character->skeleton.bones) names.push_back(bone.name);
  EXPECT_EQ(names, (std::vector<std::string>{"body", "root", "tip", "tip#3", "bone 4", "tip#2"}));
  EXPECT_TRUE(has_note(loaded->report, LoadNote::Kind::information, "without a unique name"));
}

TEST(LoadGltfSkeleton, joints_outside_the_scene_come_with_their_tree) {
  GltfBuilder builder = skinned_strip();
  builder.json["scenes"][0]["nodes"] = {0};
  const auto loaded = builder.load(strict());
  ASSERT_TRUE(loaded.has_value()) << loaded.error().text();
  EXPECT_EQ(loaded->character->skeleton.bones.size(), 3u);
  EXPECT_TRUE(has_note(loaded->report, LoadNote::Kind::information, "outside the scene"));
}

TEST(LoadGltfSkeleton, without_scenes_all_roots_are_taken) {
  GltfBuilder builder = skinned_strip();
  builder.json.erase("scenes");
  builder.json.erase("scene");
  const auto loaded = builder.load(strict());
  ASSERT_TRUE(loaded.has_value()) << loaded.error().text();
  EXPECT_EQ(loaded->character->skeleton.bones.size(), 3u);
}

TEST(LoadGltfSkeleton, a_matrix_without_shear_becomes_one_bone) {
  GltfBuilder builder = skinned_strip();
  // Rotated by 90 degrees about z, scale 2 3 4, mirrored in x.
  builder.json["nodes"][1]["matrix"] = {0, -2, 0, 0, -3, 0, 0, 0, 0, 0, 4, 0, 5, 6, 7, 1};
  const auto loaded = builder.load(strict());
  ASSERT_TRUE(loaded.has_value()) << loaded.error().text();
  EXPECT_EQ(loaded->character->skeleton.bones.size(), 3u);
  Eigen::Matrix4d expected;
  expected << 0, -3, 0, 5, -2, 0, 0, 6, 0, 0, 4, 7, 0, 0, 0, 1;
  EXPECT_LT((matrix_of(bone_named(*loaded->character, "root").rest) - expected).norm(), 1e-5);
}

TEST(LoadGltfSkeleton, a_matrix_with_shear_is_split_without_loss) {
  GltfBuilder builder = skinned_strip();
  builder.json["nodes"][1]["matrix"] = {1, 0, 0, 0, 0.5, 1, 0, 0, 0, 0.25, -2, 0, 5, 6, 7, 1};
  const auto loaded = builder.load(strict());
  ASSERT_TRUE(loaded.has_value()) << loaded.error().text();
  const auto& bones = loaded->character->skeleton.bones;
  ASSERT_EQ(bones.size(), 4u);
  EXPECT_EQ(bones[1].name, "root#shear");
  EXPECT_EQ(bones[2].name, "root");
  EXPECT_EQ(bones[2].parent, 1u);
  EXPECT_EQ(bones[3].parent, 2u);
  Eigen::Matrix4d expected;
  expected << 1, 0.5, 0, 5, 0, 1, 0.25, 6, 0, 0, -2, 7, 0, 0, 0, 1;
  EXPECT_LT((matrix_of(bones[1].rest) * matrix_of(bones[2].rest) - expected).norm(), 2e-6);
}

TEST(LoadGltfSkeleton, rotations_are_made_unit) {
  GltfBuilder builder = skinned_strip();
  builder.json["nodes"][2]["rotation"] = {0, 0, 0, 2};
  auto loaded = builder.load();
  ASSERT_TRUE(loaded.has_value()) << loaded.error().text();
  EXPECT_EQ(bone_named(*loaded->character, "tip").rest.rotation.coeffs(),
            Quatf::Identity().coeffs());
  EXPECT_EQ(builder.load(strict()).error().code(), StatusCode::malformed_file);
  builder.json["nodes"][2]["rotation"] = {0, 0, 0, 0};
  loaded = builder.load();
  ASSERT_TRUE(loaded.has_value()) << loaded.error().text();
  EXPECT_EQ(builder.load(strict()).error().code(), StatusCode::malformed_file);
}

TEST(LoadGltfSkeleton, cycles_and_two_parents_are_refused_by_name) {
  GltfBuilder cycle = skinned_strip();
  cycle.json["nodes"][2]["children"] = {1};
  Status error = cycle.load().error();
  EXPECT_EQ(error.code(), StatusCode::not_a_tree);
  EXPECT_NE(error.text().find("own ancestor"), std::string_view::npos);
  GltfBuilder two_parents = skinned_strip();
  two_parents.json["nodes"][0]["children"] = {2};
  error = two_parents.load().error();
  EXPECT_EQ(error.code(), StatusCode::not_a_tree);
  EXPECT_EQ(error.text(), "/nodes/1/children/0: node 2 is already a child of node 0");
}

TEST(LoadGltfSkeleton, deep_trees_are_refused_without_recursion) {
  GltfBuilder builder = skinned_strip();
  const std::size_t first = builder.json["nodes"].size();
  for (std::size_t i = 0; i < 100'000; ++i)
    builder.json["nodes"].push_back({{"children", {first + i + 1}}});
  builder.json["nodes"].push_back(Json::object());
  builder.json["nodes"][2]["children"] = {first};
  EXPECT_EQ(builder.load().error().code(), StatusCode::limit_exceeded);
}

/// The strip with one animation channel on the bone "tip", or on morph targets.
struct Animated {
  GltfBuilder builder = skinned_strip();

  Animated(std::vector<float> times, std::vector<float> values, const char* type, const char* path,
           const char* interpolation = "LINEAR") {
    const std::size_t input = builder.add(times, "SCALAR"), output = builder.add(values, type);
    builder.json["animations"] = {
        {{"channels", {{{"sampler", 0}, {"target", {{"node", 2}, {"path", path}}}}}},
         {"samplers", {{{"input", input}, {"output", output}, {"interpolation", interpolation}}}}}};
  }
};

TEST(LoadGltfClips, keys_are_kept_in_all_interpolations) {
  for (const auto& [name, mode, per_key] : {std::tuple{"LINEAR", Interpolation::linear, 1u},
                                            {"STEP", Interpolation::step, 1u},
                                            {"CUBICSPLINE", Interpolation::cubic_spline, 3u}}) {
    std::vector<float> values(2 * 3 * per_key);
    for (std::size_t i = 0; i < values.size(); ++i) values[i] = static_cast<float>(i);
    const auto loaded =
        Animated({0.5f, 2}, values, "VEC3", "translation", name).builder.load(strict());
    ASSERT_TRUE(loaded.has_value()) << loaded.error().text();
    const Clip& clip = loaded->character->clips.at(0);
    EXPECT_EQ(clip.name, "clip 0");
    EXPECT_EQ(clip.duration, 2.0f);
    ASSERT_EQ(clip.channels.size(), 1u);
    EXPECT_EQ(clip.channels[0].interpolation, mode);
    EXPECT_EQ(clip.channels[0].index, 2u);
    EXPECT_EQ(clip.channels[0].values, values);
  }
}

TEST(LoadGltfClips, integer_rotations_are_decoded) {
  Animated animated({0, 1}, {0, 0, 0, 1, 0, 0, 0, 1}, "VEC4", "rotation");
  animated.builder.json["animations"][0]["samplers"][0]["output"] = animated.builder.add(
      std::vector<std::int16_t>{0, 0, 0, 32767, -32768, 0, 0, 0}, "VEC4", true);
  const auto loaded = animated.builder.load(strict());
  ASSERT_TRUE(loaded.has_value()) << loaded.error().text();
  EXPECT_EQ(loaded->character->clips[0].channels.at(0).values,
            (std::vector<float>{0, 0, 0, 1, -1, 0, 0, 0}));
}

TEST(LoadGltfClips, morph_weights_drive_their_nodes_range) {
  Animated animated({0, 1}, {0, 1, 0.5f, 0.25f}, "SCALAR", "weights");
  GltfBuilder& builder = animated.builder;
  const std::size_t deltas = builder.add(std::vector<float>(kStripVertices * 3, 1.0f), "VEC3");
  builder.json["meshes"][0]["primitives"][0]["targets"] =
      Json::array({{{"POSITION", deltas}}, {{"POSITION", deltas}}});
  builder.json["nodes"].push_back(
      {{"name", "twin"}, {"mesh", 0}, {"skin", 0}, {"weights", {0.25, 0.75}}});
  builder.json["scenes"][0]["nodes"].push_back(3);
  builder.json["animations"][0]["channels"][0]["target"]["node"] = 3;
  const auto loaded = builder.load(strict());
  ASSERT_TRUE(loaded.has_value()) << loaded.error().text();
  EXPECT_EQ(loaded->character->rest_morph_weights, (std::vector<float>{0, 0, 0.25f, 0.75f}));
  EXPECT_EQ(loaded->character->meshes[1].first_morph_weight, 2u);
  const Channel& channel = loaded->character->clips[0].channels.at(0);
  EXPECT_EQ(channel.target, ChannelTarget::morph_weights);
  EXPECT_EQ(channel.index, 2u);
  EXPECT_EQ(channel.width, 2u);
}

TEST(LoadGltfClips, an_unusable_channel_is_dropped_and_the_model_kept) {
  std::vector<Animated> faulty;
  faulty.emplace_back(std::vector<float>{1, 0}, std::vector<float>(6), "VEC3", "translation");
  faulty.emplace_back(std::vector<float>{-1, 0}, std::vector<float>(6), "VEC3", "translation");
  faulty.emplace_back(std::vector<float>{0, std::nanf("")}, std::vector<float>(6), "VEC3",
                      "translation");
  faulty.emplace_back(std::vector<float>{0, 1}, std::vector<float>(9), "VEC3", "translation");
  faulty.emplace_back(std::vector<float>{0, 1}, std::vector<float>(6), "VEC3", "pointer");
  faulty.emplace_back(std::vector<float>{0, 1}, std::vector<float>(6), "VEC3", "translation",
                      "WAVY");
  faulty.emplace_back(std::vector<float>{0, 1}, std::vector<float>(8), "VEC4", "rotation");
  faulty.emplace_back(std::vector<float>{0, 1}, std::vector<float>(2), "SCALAR", "weights");
  faulty.emplace_back(std::vector<float>{0, 1}, std::vector<float>{0, 0, 0, std::nanf(""), 0, 0},
                      "VEC3", "scale");
  for (std::size_t i = 0; i < faulty.size(); ++i) {
    SCOPED_TRACE(i);
    const auto loaded = faulty[i].builder.load();
    ASSERT_TRUE(loaded.has_value()) << loaded.error().text();
    ASSERT_EQ(loaded->character->clips.size(), 1u);
    EXPECT_TRUE(loaded->character->clips[0].channels.empty());
    EXPECT_TRUE(has_note(loaded->report, LoadNote::Kind::dropped, "channel 0"));
    EXPECT_FALSE(faulty[i].builder.load(strict()).has_value());
  }
}

TEST(LoadGltfClips, of_keys_at_one_time_the_last_is_kept) {
  const auto loaded =
      Animated({0, 1, 1, 2}, {0, 0, 0, 1, 1, 1, 2, 2, 2, 3, 3, 3}, "VEC3", "scale").builder.load();
  ASSERT_TRUE(loaded.has_value()) << loaded.error().text();
  const Channel& channel = loaded->character->clips[0].channels.at(0);
  EXPECT_EQ(channel.times, (std::vector<float>{0, 1, 2}));
  EXPECT_EQ(channel.values, (std::vector<float>{0, 0, 0, 2, 2, 2, 3, 3, 3}));
}

}  // namespace
}  // namespace sunder::test
