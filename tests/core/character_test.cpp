#include <sunder/core/character.h>

#include <functional>
#include <limits>

#include <gtest/gtest.h>

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
        BadCase{"keys_not_increasing", StatusCode::invalid_argument,
                [](Character& c) { c.clips[0].channels[0].times[1] = 0.0f; }},
        BadCase{"too_few_key_values", StatusCode::size_mismatch,
                [](Character& c) { c.clips[0].channels[0].values.pop_back(); }},
        BadCase{"channel_of_no_bone", StatusCode::index_out_of_range,
                [](Character& c) { c.clips[0].channels[0].index = 50; }},
        BadCase{"nan_key", StatusCode::non_finite_value,
                [](Character& c) { c.clips[0].channels[0].values[2] = kNan; }}),
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

TEST(ValidateCharacter, says_where_memory_runs_out) {
  test::starve([] { return std::make_unique<Character>(test::make_tube(4, 6, 3)); },
               [](const Character& character) { return validate_character(character); },
               [](const Character&, const Status&) {});
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
