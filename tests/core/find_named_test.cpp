#include "core/internal/find_named.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace sunder {
namespace {

using testing::HasSubstr;

Character with_clips(const std::vector<std::string>& names) {
  Character character;
  for (const std::string& name : names) character.clips.emplace_back().name = name;
  return character;
}

TEST(FindClip, prefers_the_whole_name_and_else_takes_the_only_one_behind_a_namespace) {
  const Character character = with_clips({"Rig|Walk", "Walk", "Rig|Run", "Rig|Jump", "Other|Jump"});
  EXPECT_EQ(find_clip(character, "Walk"), 1u);
  EXPECT_EQ(find_clip(character, "Rig|Walk"), 0u);
  EXPECT_EQ(find_clip(character, "Run"), 2u);
  EXPECT_EQ(find_clip(character, "Jump"), std::nullopt) << "two have it";
  EXPECT_EQ(find_clip(character, "Fly"), std::nullopt);
  EXPECT_EQ(find_named_clip(character, 4u), 4u);
  EXPECT_EQ(find_named_clip(character, 5u), std::nullopt);
  EXPECT_EQ(find_named_clip(character, "Run"), 2u);
}

TEST(FindMaterial, knows_the_materials_of_submeshes) {
  Character character;
  character.meshes.resize(2);
  character.meshes[0].submeshes = {{"Skin", 3}, {"Cloth", 1}, {"Twin", 5}};
  character.meshes[1].submeshes = {{"Skin", 3}, {"Twin", 6}, {"Bare", kNone}};
  EXPECT_EQ(*find_material(character, "Skin"), 3u);
  EXPECT_EQ(*find_material(character, "Cloth"), 1u);
  const auto near = find_material(character, "Clot");
  EXPECT_EQ(near.error().code(), StatusCode::not_found);
  EXPECT_THAT(std::string(near.error().text()), HasSubstr("did you mean 'Cloth'?"));
  EXPECT_THAT(std::string(find_material(character, "Twin").error().text()),
              HasSubstr("the materials 5 and 6 are named 'Twin'; give the index"));
  EXPECT_FALSE(find_material(character, "Bare")) << "the file has no such material";
  EXPECT_THAT(std::string(find_material(character, "zzzzz").error().text()),
              HasSubstr("its materials: 'Cloth', 'Skin' or 'Twin'"));
}

}  // namespace
}  // namespace sunder
