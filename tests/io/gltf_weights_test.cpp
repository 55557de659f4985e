// load_character() on glTF: skins and weights.

#include <gtest/gtest.h>

#include "support/models/gltf_builder.h"

namespace sunder::test {
namespace {

/// Gives every vertex of the strip the same four joints and weights.
template <class Joint, class Weight>
GltfBuilder strip_with(std::array<Joint, 4> joints, std::array<Weight, 4> weights,
                       const char* set = "0", GltfBuilder builder = skinned_strip()) {
  std::vector<Joint> all_joints;
  std::vector<Weight> all_weights;
  for (std::size_t v = 0; v < kStripVertices; ++v) {
    all_joints.insert(all_joints.end(), joints.begin(), joints.end());
    all_weights.insert(all_weights.end(), weights.begin(), weights.end());
  }
  strip_attributes(builder)[std::string("JOINTS_") + set] = builder.add(all_joints, "VEC4");
  strip_attributes(builder)[std::string("WEIGHTS_") + set] =
      builder.add(all_weights, "VEC4", !std::is_floating_point_v<Weight>);
  return builder;
}

std::vector<Influence> influences_of(const Result<LoadedCharacter>& loaded,
                                     std::uint32_t vertex = 0) {
  const auto of = loaded->character->meshes[0].weights.of(vertex);
  return {of.begin(), of.end()};
}

using Joints = std::array<std::uint8_t, 4>;
using Weights = std::array<float, 4>;
constexpr auto kRepaired = LoadNote::Kind::repaired;

TEST(LoadGltfWeights, floats_keep_their_bits_and_zeros_are_left_out) {
  const auto loaded = skinned_strip().load(strict());
  ASSERT_TRUE(loaded.has_value()) << loaded.error().text();
  EXPECT_EQ(influences_of(loaded, 0), (std::vector<Influence>{{0, 1.0f}}));
  EXPECT_EQ(influences_of(loaded, 2), (std::vector<Influence>{{0, 0.75f}, {1, 0.25f}}));
  EXPECT_TRUE(loaded->report.notes.empty());
}

TEST(LoadGltfWeights, normalised_bytes_are_read_as_fractions) {
  const auto loaded =
      strip_with<std::uint8_t, std::uint8_t>({0, 1, 0, 0}, {204, 51, 0, 0}).load(strict());
  ASSERT_TRUE(loaded.has_value()) << loaded.error().text();
  EXPECT_EQ(influences_of(loaded),
            (std::vector<Influence>{{0, 204.0f / 255.0f}, {1, 51.0f / 255.0f}}));
}

TEST(LoadGltfWeights, normalised_shorts_and_short_joints_are_read) {
  const auto loaded =
      strip_with<std::uint16_t, std::uint16_t>({1, 0, 0, 0}, {65534, 1, 0, 0}).load(strict());
  ASSERT_TRUE(loaded.has_value()) << loaded.error().text();
  EXPECT_EQ(influences_of(loaded),
            (std::vector<Influence>{{1, 65534.0f / 65535.0f}, {0, 1.0f / 65535.0f}}));
}

TEST(LoadGltfWeights, a_second_set_adds_influences) {
  GltfBuilder builder = skinned_strip();
  builder.json["nodes"].push_back({{"name", "third"}});
  builder.json["nodes"][1]["children"].push_back(3);
  builder.json["skins"][0] = {{"joints", {1, 2, 3}}};
  builder = strip_with<std::uint8_t, float>({0, 1, 0, 0}, {0.5f, 0.25f, 0, 0}, "0", builder);
  builder = strip_with<std::uint8_t, float>({2, 0, 0, 0}, {0.25f, 0, 0, 0}, "1", builder);
  const auto loaded = builder.load(strict());
  ASSERT_TRUE(loaded.has_value()) << loaded.error().text();
  EXPECT_EQ(influences_of(loaded), (std::vector<Influence>{{0, 0.5f}, {1, 0.25f}, {2, 0.25f}}));
}

TEST(LoadGltfWeights, sums_off_by_more_than_rounding_are_normalised_and_noted) {
  const GltfBuilder builder = strip_with<std::uint8_t, float>({0, 1, 0, 0}, {0.75f, 0.75f, 0, 0});
  const auto loaded = builder.load();
  ASSERT_TRUE(loaded.has_value()) << loaded.error().text();
  EXPECT_EQ(influences_of(loaded), (std::vector<Influence>{{0, 0.5f}, {1, 0.5f}}));
  ASSERT_EQ(loaded->report.notes.size(), 1u);
  EXPECT_EQ(loaded->report.notes[0].count, kStripVertices);
  EXPECT_TRUE(has_note(loaded->report, kRepaired, "off by up to 0.5"))
      << loaded->report.notes[0].text;
  EXPECT_EQ(builder.load(strict()).error().code(), StatusCode::weights_not_normalized);
}

TEST(LoadGltfWeights, sums_off_by_a_little_are_normalised_in_silence) {
  for (const float off : {4e-6f, 1e-4f}) {  // rounding, and what Draco does
    const auto loaded =
        strip_with<std::uint8_t, float>({0, 1, 0, 0}, {0.5f, 0.5f + off, 0, 0}).load(strict());
    ASSERT_TRUE(loaded.has_value()) << loaded.error().text();
    EXPECT_TRUE(loaded->report.notes.empty());
    const auto influences = influences_of(loaded);
    EXPECT_NEAR(influences[0].weight + influences[1].weight, 1, 1e-7);
  }
}

TEST(LoadGltfWeights, nan_weights_become_zero) {
  const GltfBuilder builder =
      strip_with<std::uint8_t, float>({0, 1, 0, 0}, {std::nanf(""), 0.5f, 0, 0});
  const auto loaded = builder.load();
  ASSERT_TRUE(loaded.has_value()) << loaded.error().text();
  EXPECT_EQ(influences_of(loaded), (std::vector<Influence>{{1, 1.0f}}));
  EXPECT_TRUE(has_note(loaded->report, kRepaired, "not finite"));
  EXPECT_EQ(builder.load(strict()).error().code(), StatusCode::non_finite_value);
}

TEST(LoadGltfWeights, negative_weights_become_zero) {
  const GltfBuilder builder = strip_with<std::uint8_t, float>({0, 1, 0, 0}, {-0.5f, 1.0f, 0, 0});
  const auto loaded = builder.load();
  ASSERT_TRUE(loaded.has_value()) << loaded.error().text();
  EXPECT_EQ(influences_of(loaded), (std::vector<Influence>{{1, 1.0f}}));
  EXPECT_EQ(builder.load(strict()).error().code(), StatusCode::weights_not_normalized);
}

TEST(LoadGltfWeights, huge_weights_are_normalised) {
  const auto loaded =
      strip_with<std::uint8_t, float>({0, 0, 1, 0}, {3e38f, 3e38f, 3e38f, 0}).load();
  ASSERT_TRUE(loaded.has_value()) << loaded.error().text();
  EXPECT_EQ(influences_of(loaded).size(), 2u);
}

TEST(LoadGltfWeights, joints_beyond_the_skin_lose_their_influence) {
  const GltfBuilder builder = strip_with<std::uint8_t, float>({9, 1, 0, 0}, {0.5f, 0.5f, 0, 0});
  const auto loaded = builder.load();
  ASSERT_TRUE(loaded.has_value()) << loaded.error().text();
  EXPECT_EQ(influences_of(loaded), (std::vector<Influence>{{1, 1.0f}}));
  EXPECT_TRUE(has_note(loaded->report, LoadNote::Kind::dropped, "does not have"));
  EXPECT_EQ(builder.load(strict()).error().code(), StatusCode::index_out_of_range);
}

TEST(LoadGltfWeights, a_vertex_without_weight_goes_to_the_skins_root) {
  GltfBuilder builder = strip_with<std::uint8_t, float>({0, 1, 0, 0}, {0, 0, 0, 0});
  auto loaded = builder.load();
  ASSERT_TRUE(loaded.has_value()) << loaded.error().text();
  EXPECT_EQ(influences_of(loaded), (std::vector<Influence>{{0, 1.0f}}));
  EXPECT_EQ(builder.load(strict()).error().code(), StatusCode::weights_not_normalized);
  builder.json["skins"][0]["skeleton"] = 2;
  loaded = builder.load();
  EXPECT_EQ(influences_of(loaded), (std::vector<Influence>{{1, 1.0f}}));
}

TEST(LoadGltfWeights, a_joint_named_twice_by_a_vertex_is_merged) {
  const auto loaded = strip_with<std::uint8_t, float>({1, 1, 0, 0}, {0.5f, 0.25f, 0.25f, 0}).load();
  ASSERT_TRUE(loaded.has_value()) << loaded.error().text();
  EXPECT_EQ(influences_of(loaded), (std::vector<Influence>{{1, 0.75f}, {0, 0.25f}}));
}

TEST(LoadGltfWeights, sets_that_do_not_match_are_refused) {
  GltfBuilder lonely = skinned_strip();
  strip_attributes(lonely).erase("WEIGHTS_0");
  EXPECT_EQ(lonely.load().error().code(), StatusCode::size_mismatch);
  GltfBuilder short_joints = skinned_strip();
  strip_attributes(short_joints)["JOINTS_0"] =
      short_joints.add(std::vector<std::uint8_t>(4 * 3), "VEC4");
  EXPECT_EQ(short_joints.load().error().code(), StatusCode::size_mismatch);
  const GltfBuilder integers = [] {
    GltfBuilder builder = skinned_strip();
    strip_attributes(builder)["WEIGHTS_0"] =
        builder.add(std::vector<std::uint8_t>(4 * kStripVertices, 63), "VEC4", false);
    return builder;
  }();
  EXPECT_EQ(integers.load().error().code(), StatusCode::malformed_file);
}

TEST(LoadGltfSkins, without_inverse_binds_they_are_the_identity) {
  GltfBuilder builder = skinned_strip();
  builder.json["skins"][0].erase("inverseBindMatrices");
  const auto loaded = builder.load(strict());
  ASSERT_TRUE(loaded.has_value()) << loaded.error().text();
  for (const Affine3f& bind : loaded->character->skins[0].bone_from_bind)
    EXPECT_EQ(bind.matrix(), Affine3f::Identity().matrix());
}

TEST(LoadGltfSkins, bones_and_binds_come_in_the_order_of_the_joints) {
  const auto loaded = skinned_strip().load();
  const Skin& skin = loaded->character->skins[0];
  const auto& bones = loaded->character->skeleton.bones;
  ASSERT_EQ(skin.bones.size(), 2u);
  EXPECT_EQ(bones[skin.bones[0]].name, "root");
  EXPECT_EQ(bones[skin.bones[1]].name, "tip");
  EXPECT_EQ(Vec3f(skin.bone_from_bind[1].translation()), Vec3f(0, -1, 0));
}

TEST(LoadGltfSkins, bad_inverse_binds_are_refused) {
  const auto with = [](std::vector<float> binds) {
    GltfBuilder builder = skinned_strip();
    builder.json["skins"][0]["inverseBindMatrices"] = builder.add(binds, "MAT4");
    return builder.load().error().code();
  };
  std::vector<float> identity = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
  EXPECT_EQ(with(identity), StatusCode::size_mismatch);
  std::vector<float> two = identity;
  two.insert(two.end(), identity.begin(), identity.end());
  EXPECT_EQ(with(two), StatusCode::ok);
  auto broken = two;
  broken[20] = std::nanf("");
  EXPECT_EQ(with(broken), StatusCode::non_finite_value);
  broken = two;
  broken[19] = 0.5f;
  EXPECT_EQ(with(broken), StatusCode::malformed_file);
}

TEST(LoadGltfSkins, two_skins_on_the_same_joints_keep_their_own_binds) {
  GltfBuilder builder = skinned_strip();
  builder.json["nodes"].push_back({{"name", "twin"}, {"mesh", 0}, {"skin", 1}});
  builder.json["scenes"][0]["nodes"].push_back(3);
  builder.json["skins"].push_back({{"joints", {1, 2}}});
  const auto loaded = builder.load(strict());
  ASSERT_TRUE(loaded.has_value()) << loaded.error().text();
  const Character& character = *loaded->character;
  ASSERT_EQ(character.skins.size(), 2u);
  ASSERT_EQ(character.meshes.size(), 2u);
  EXPECT_EQ(character.skins[0].bones, character.skins[1].bones);
  EXPECT_NE(character.skins[0].bone_from_bind[1].matrix(),
            character.skins[1].bone_from_bind[1].matrix());
  EXPECT_NE(character.meshes[0].skin, character.meshes[1].skin);
}

TEST(LoadGltfSkins, a_mesh_without_skin_moves_with_its_node) {
  GltfBuilder builder = skinned_strip();
  builder.json["nodes"][0].erase("skin");
  const auto loaded = builder.load(strict());
  ASSERT_TRUE(loaded.has_value()) << loaded.error().text();
  const Skin& skin = loaded->character->skins.at(0);
  ASSERT_EQ(skin.bones.size(), 1u);
  EXPECT_EQ(loaded->character->skeleton.bones[skin.bones[0]].name, "body");
  EXPECT_EQ(influences_of(loaded, 7), (std::vector<Influence>{{0, 1.0f}}));
}

TEST(LoadGltfSkins, a_mesh_without_weights_moves_with_its_node_though_that_has_a_skin) {
  GltfBuilder builder = skinned_strip();
  strip_attributes(builder).erase("JOINTS_0");
  strip_attributes(builder).erase("WEIGHTS_0");
  const auto loaded = builder.load();
  ASSERT_TRUE(loaded.has_value()) << loaded.error().text();
  EXPECT_EQ(loaded->character->skins[loaded->character->meshes[0].skin].bones.size(), 1u);
  EXPECT_TRUE(has_note(loaded->report, LoadNote::Kind::information, "moves with the node"));
}

}  // namespace
}  // namespace sunder::test
