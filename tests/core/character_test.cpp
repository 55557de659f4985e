#include <sunder/core/character.h>

#include <functional>
#include <limits>
#include <set>

#include <gtest/gtest.h>

#include "core/internal/validate_clip.h"
#include "support/machine/starve.h"
#include "support/models/rigs.h"

namespace sunder {
namespace {

struct BadCase {
  const char* name;
  StatusCode code;
  std::function<void(Character&)> spoil;
};

class ValidateCharacter : public testing::TestWithParam<BadCase> {};

TEST_P(ValidateCharacter, refuses) {
  Character character = test::make_tube(4, 6, 3);
  ASSERT_TRUE(validate_character(character)) << validate_character(character).text();
  GetParam().spoil(character);
  const Status status = validate_character(character);
  EXPECT_EQ(status.code(), GetParam().code) << status.text();
  EXPECT_FALSE(status.text().empty());
}

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

INSTANTIATE_TEST_SUITE_P(
    contract, ValidateCharacter,
    testing::Values(
        BadCase{"no_mesh", StatusCode::empty_input, [](Character& c) { c.meshes.clear(); }},
        BadCase{"bone_without_name", StatusCode::invalid_argument,
                [](Character& c) { c.skeleton.bones[1].name.clear(); }},
        BadCase{"two_bones_of_one_name", StatusCode::invalid_argument,
                [](Character& c) { c.skeleton.bones[1].name = "bone0"; }},
        BadCase{"parent_after_child", StatusCode::not_a_tree,
                [](Character& c) { c.skeleton.bones[1].parent = 2; }},
        BadCase{"bone_its_own_parent", StatusCode::not_a_tree,
                [](Character& c) { c.skeleton.bones[1].parent = 1; }},
        BadCase{"nan_in_rest", StatusCode::non_finite_value,
                [](Character& c) { c.skeleton.bones[1].rest.scale.x() = kNan; }},
        BadCase{"rotation_not_unit", StatusCode::invalid_argument,
                [](Character& c) { c.skeleton.bones[1].rest.rotation.coeffs() *= 2.0f; }},
        BadCase{"skin_without_bones", StatusCode::empty_input,
                [](Character& c) { c.skins[0].bones.clear(), c.skins[0].bone_from_bind.clear(); }},
        BadCase{"too_few_binds", StatusCode::size_mismatch,
                [](Character& c) { c.skins[0].bone_from_bind.pop_back(); }},
        BadCase{"skin_names_no_bone", StatusCode::index_out_of_range,
                [](Character& c) { c.skins[0].bones[1] = 99; }},
        BadCase{"nan_bind", StatusCode::non_finite_value,
                [](Character& c) { c.skins[0].bone_from_bind[1].matrix()(0, 3) = kNan; }},
        BadCase{"mesh_names_no_skin", StatusCode::index_out_of_range,
                [](Character& c) { c.meshes[0].skin = 7; }},
        BadCase{"nan_position", StatusCode::non_finite_value,
                [](Character& c) { c.meshes[0].positions[5].y() = kNan; }},
        BadCase{"too_few_normals", StatusCode::size_mismatch,
                [](Character& c) { c.meshes[0].normals.pop_back(); }},
        BadCase{"too_few_uvs", StatusCode::size_mismatch,
                [](Character& c) { c.meshes[0].uv_sets[0].pop_back(); }},
        BadCase{"weights_do_not_sum_to_one", StatusCode::weights_not_normalized,
                [](Character& c) { c.meshes[0].weights.influences[3].weight *= 0.5f; }},
        BadCase{"negative_weight", StatusCode::weights_not_normalized,
                [](Character& c) { c.meshes[0].weights.influences[3].weight = -0.1f; }},
        BadCase{"nan_weight", StatusCode::weights_not_normalized,
                [](Character& c) { c.meshes[0].weights.influences[3].weight = kNan; }},
        BadCase{"slot_beyond_skin", StatusCode::index_out_of_range,
                [](Character& c) { c.meshes[0].weights.influences[3].slot = 3; }},
        BadCase{"vertex_without_influence", StatusCode::size_mismatch,
                [](Character& c) { c.meshes[0].weights.first[4] = c.meshes[0].weights.first[3]; }},
        BadCase{"index_beyond_vertices", StatusCode::index_out_of_range,
                [](Character& c) { c.meshes[0].triangles[2][1] = 100000; }},
        BadCase{"triangle_of_no_submesh", StatusCode::index_out_of_range,
                [](Character& c) { c.meshes[0].triangle_submesh[2] = 9; }},
        BadCase{"morph_of_other_length", StatusCode::size_mismatch,
                [](Character& c) { c.meshes[0].morph_targets[0].position_deltas.pop_back(); }},
        BadCase{"morph_without_weight", StatusCode::index_out_of_range,
                [](Character& c) { c.rest_morph_weights.clear(); }},
        BadCase{"morph_weights_beyond_32_bits", StatusCode::index_out_of_range,
                [](Character& c) { c.meshes[0].first_morph_weight = kNone; }},
        BadCase{"channel_beyond_32_bits", StatusCode::index_out_of_range,
                [](Character& c) { c.clips[0].channels[0].index = kNone; }},
        BadCase{"key_values_beyond_32_bits", StatusCode::size_mismatch,
                [](Character& c) {
                  Channel& channel = c.clips[0].channels[0];
                  channel = Channel();
                  channel.target = ChannelTarget::morph_weights;
                  channel.width = 1u << 16;
                  c.rest_morph_weights.resize(channel.width);
                  for (std::uint32_t i = 0; i < 1u << 16; ++i)
                    channel.times.push_back(static_cast<float>(i));
                }},
        BadCase{"keys_not_increasing", StatusCode::invalid_argument,
                [](Character& c) { c.clips[0].channels[0].times[1] = 0.0f; }},
        BadCase{"too_few_key_values", StatusCode::size_mismatch,
                [](Character& c) { c.clips[0].channels[0].values.pop_back(); }},
        BadCase{"channel_of_no_bone", StatusCode::index_out_of_range,
                [](Character& c) { c.clips[0].channels[0].index = 50; }},
        BadCase{"nan_key", StatusCode::non_finite_value,
                [](Character& c) { c.clips[0].channels[0].values[2] = kNan; }}),
    [](const auto& test) { return test.param.name; });

void add_attribute(Character& character, std::uint32_t components, std::size_t values) {
  CustomAttribute attribute;
  attribute.name = "_HEAT";
  attribute.components = components;
  attribute.values.assign(values, 0.5f);
  character.meshes[0].custom_attributes.push_back(attribute);
}

INSTANTIATE_TEST_SUITE_P(
    streams_and_channels, ValidateCharacter,
    testing::Values(
        BadCase{"nan_normal", StatusCode::non_finite_value,
                [](Character& c) { c.meshes[0].normals[5].x() = kNan; }},
        BadCase{"too_many_tangents", StatusCode::size_mismatch,
                [](Character& c) { c.meshes[0].tangents.emplace_back(1, 0, 0, 1); }},
        BadCase{"nan_uv", StatusCode::non_finite_value,
                [](Character& c) { c.meshes[0].uv_sets[0][7].x() = kNan; }},
        BadCase{"colours_of_no_vertex", StatusCode::size_mismatch,
                [](Character& c) { c.meshes[0].color_sets.emplace_back(); }},
        BadCase{"morph_normals_of_other_length", StatusCode::size_mismatch,
                [](Character& c) { c.meshes[0].morph_targets[0].normal_deltas.resize(3); }},
        BadCase{"morph_tangents_of_other_length", StatusCode::size_mismatch,
                [](Character& c) { c.meshes[0].morph_targets[0].tangent_deltas.resize(3); }},
        BadCase{"attribute_without_components", StatusCode::size_mismatch,
                [](Character& c) { add_attribute(c, 0, 0); }},
        BadCase{"attribute_of_five_components", StatusCode::size_mismatch,
                [](Character& c) { add_attribute(c, 5, 5 * c.meshes[0].vertex_count()); }},
        BadCase{"attribute_of_other_length", StatusCode::size_mismatch,
                [](Character& c) { add_attribute(c, 2, c.meshes[0].vertex_count()); }},
        BadCase{"nan_attribute", StatusCode::non_finite_value,
                [](Character& c) {
                  add_attribute(c, 2, 2 * c.meshes[0].vertex_count());
                  c.meshes[0].custom_attributes[0].values[9] = kNan;
                }},
        BadCase{"nan_rest_morph_weight", StatusCode::non_finite_value,
                [](Character& c) { c.rest_morph_weights[0] = kNan; }},
        BadCase{"too_few_submeshes_of_triangles", StatusCode::size_mismatch,
                [](Character& c) { c.meshes[0].triangle_submesh.pop_back(); }},
        BadCase{"slot_twice", StatusCode::invalid_argument,
                [](Character& c) {
                  SkinWeights& weights = c.meshes[0].weights;
                  std::uint32_t v = 0;
                  while (weights.of(v).size() < 2) ++v;
                  Influence* const influences = &weights.influences[weights.first[v]];
                  influences[1].slot = influences[0].slot;
                }},
        BadCase{"influences_that_no_vertex_has", StatusCode::size_mismatch,
                [](Character& c) {
                  c.meshes[0].weights.influences.push_back({0, 1});
                }},
        BadCase{"influences_from_behind_the_first", StatusCode::size_mismatch,
                [](Character& c) { c.meshes[0].weights.first[0] = 1; }},
        BadCase{"influences_beyond_the_last", StatusCode::size_mismatch,
                [](Character& c) { c.meshes[0].weights.first[4] = 100000; }},
        BadCase{"too_few_offsets", StatusCode::size_mismatch,
                [](Character& c) { c.meshes[0].weights.first.pop_back(); }},
        BadCase{"infinite_weight", StatusCode::weights_not_normalized,
                [](Character& c) {
                  c.meshes[0].weights.influences[3].weight = std::numeric_limits<float>::infinity();
                }},
        BadCase{"channel_without_width", StatusCode::index_out_of_range,
                [](Character& c) { c.clips[0].channels[0].width = 0; }},
        BadCase{"rotation_of_three_floats", StatusCode::size_mismatch,
                [](Character& c) { c.clips[0].channels[0].width = 3; }},
        BadCase{"scale_of_four_floats", StatusCode::size_mismatch,
                [](Character& c) { c.clips[0].channels[0].target = ChannelTarget::scale; }},
        BadCase{"channel_of_no_morph_weight", StatusCode::index_out_of_range,
                [](Character& c) {
                  c.clips[0].channels[0].target = ChannelTarget::morph_weights;
                  c.clips[0].channels[0].index = 0;
                }},
        BadCase{"channel_without_keys", StatusCode::empty_input,
                [](Character& c) {
                  c.clips[0].channels[0].times.clear();
                  c.clips[0].channels[0].values.clear();
                }},
        BadCase{"spline_without_tangents", StatusCode::size_mismatch,
                [](Character& c) {
                  c.clips[0].channels[0].interpolation = Interpolation::cubic_spline;
                }},
        BadCase{"key_before_the_begin", StatusCode::invalid_argument,
                [](Character& c) { c.clips[0].channels[0].times[0] = -1.0f; }},
        BadCase{"infinite_key_time", StatusCode::invalid_argument,
                [](Character& c) {
                  c.clips[0].channels[0].times[2] = std::numeric_limits<float>::infinity();
                }}),
    [](const auto& test) { return test.param.name; });

TEST(ValidateCharacterTriangles, may_be_retired) {
  Character character = test::make_tube(4, 6, 3);
  for (Triangle& triangle : character.meshes[0].triangles) triangle.fill(triangle[2]);
  EXPECT_TRUE(validate_character(character)) << validate_character(character).text();
}

TEST(ValidateCharacterIndex, names_the_first_offender) {
  Character character = test::make_tube(4, 6, 3);
  character.meshes[0].positions[17].x() = kNan;
  character.meshes[0].positions[30].x() = kNan;
  const Status status = validate_character(character);
  EXPECT_EQ(status.index(), 17u);
  EXPECT_NE(status.text().find("vertex 17"), std::string_view::npos) << status.text();
}

TEST(ValidateCharacterAttributes, may_have_up_to_four_components) {
  Character character = test::make_tube(4, 6, 3);
  const std::uint32_t vertices = character.meshes[0].vertex_count();
  for (std::uint32_t components = 1; components <= 4; ++components)
    add_attribute(character, components, components * vertices);
  character.meshes[0].color_sets.emplace_back(vertices, Vec4f(1, 0, 0, 1));
  EXPECT_TRUE(validate_character(character)) << validate_character(character).text();
}

TEST(ValidateClip, names_the_clip_and_the_channel) {
  const Character character = test::make_tube(4, 6, 3);
  Clip clip = character.clips[0];
  EXPECT_TRUE(validate_clip(character, clip));
  clip.channels[1].index = 50;
  const Status status = validate_clip(character, clip);
  EXPECT_EQ(status.code(), StatusCode::index_out_of_range);
  EXPECT_EQ(status.index(), 1u);
  EXPECT_NE(status.text().find("'Bend'"), std::string_view::npos) << status.text();
}

TEST(ValidateCharacter, says_where_memory_runs_out) {
  test::starve([] { return std::make_unique<Character>(test::make_tube(4, 6, 3)); },
               [](const Character& character) { return validate_character(character); },
               [](const Character&, const Status&) {});
}

TEST(Status, every_code_has_a_name_of_its_own) {
  std::set<std::string_view> names;
  const int codes = static_cast<int>(StatusCode::internal_error) + 1;
  for (int code = 0; code < codes; ++code) names.insert(status_name(static_cast<StatusCode>(code)));
  EXPECT_EQ(names.size(), static_cast<std::size_t>(codes));
  EXPECT_FALSE(names.contains("unknown"));
  EXPECT_EQ(status_name(static_cast<StatusCode>(codes)), "unknown");
}

TEST(Status, cuts_long_texts_and_keeps_the_cause) {
  const Status status =
      Status::failure(StatusCode::not_found, 4, "%s", std::string(1000, 'x').c_str());
  EXPECT_EQ(status.text().size(), 255u);
  EXPECT_EQ(status.code(), StatusCode::not_found);
  EXPECT_EQ(status_name(status.code()), "not_found");
}

}  // namespace
}  // namespace sunder
