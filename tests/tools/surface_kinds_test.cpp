// What names and materials tell of surfaces: tools/model/surface_kinds.h.

#include "tools/model/surface_kinds.h"

#include <fstream>

#include <gtest/gtest.h>

#include "support/machine/temporary_folder.h"
#include "support/models/gltf_builder.h"

namespace sunder::tools {
namespace {

TEST(SurfaceKinds, are_told_by_the_words_of_names) {
  for (const char* const name :
       {"Skin", "Witch_Body", "HandL_1", "left-leg", "FACE.001", "Gloves Skin"})
    EXPECT_EQ(kind_of_name(name), SurfaceKind::skin) << name;
  for (const char* const name :
       {"Hat", "Body_Armor", "BodyArmor", "boots.003", "Gold", "Controller_Left", "Hair_Black",
        "Eye_White", "Metallic", "clothing", "headphones"})
    EXPECT_EQ(kind_of_name(name), SurfaceKind::dead) << name;
  // Parts of words tell nothing: an army has an arm, a charm a harm.
  for (const char* const name : {"", "Main", "Material.001", "Army", "hatch", "Charm",
                                 "fox_material", "Legend", "capsule", "\xe4\xb8\xad"})
    EXPECT_EQ(kind_of_name(name), SurfaceKind::unnamed) << name;
}

/// The strip with materials, of which only the names and the metallic factor count.
Result<SurfaceKinds> kinds_of(test::GltfBuilder builder, const char* mesh, test::Json materials) {
  builder.json["meshes"][0]["name"] = mesh;
  builder.json["materials"] = std::move(materials);
  const test::TemporaryFolder folder;
  const auto file = folder.path() / "strip.gltf";
  std::ofstream(file, std::ios::binary) << builder.text();
  const auto loaded = load_character(file);
  if (!loaded) return loaded.error();
  return SurfaceKinds::create(*loaded->character, loaded->source.get());
}

TEST(SurfaceKinds, a_material_decides_before_its_mesh) {
  const test::Json metal = {{"metallicFactor", 1.0}};
  auto kinds = kinds_of(test::skinned_strip(), "Hat",
                        {{{"name", "Skin"}, {"pbrMetallicRoughness", metal}}, {{"name", "Main"}}});
  ASSERT_TRUE(kinds) << kinds.error().text();
  EXPECT_EQ(kinds->material_count(), 2u);
  EXPECT_EQ(kinds->of(0, 0), SurfaceKind::skin);
  EXPECT_EQ(kinds->of(0, 1), SurfaceKind::dead);
  EXPECT_EQ(kinds->of(0, kNone), SurfaceKind::dead);

  kinds = kinds_of(test::skinned_strip(), "Body",
                   {{{"name", "Main"}, {"pbrMetallicRoughness", metal}}, {{"name", "Main"}}});
  ASSERT_TRUE(kinds);
  EXPECT_EQ(kinds->of(0, 0), SurfaceKind::dead);
  EXPECT_EQ(kinds->of(0, 1), SurfaceKind::skin);
}

/// The head of a witch has a hat of the material "Purple".
TEST(SurfaceKinds, materials_named_as_skin_leave_no_other_skin) {
  const auto kinds =
      kinds_of(test::skinned_strip(), "Head", {{{"name", "Skin"}}, {{"name", "Purple"}}});
  ASSERT_TRUE(kinds);
  EXPECT_EQ(kinds->of(0, 0), SurfaceKind::skin);
  EXPECT_EQ(kinds->of(0, 1), SurfaceKind::unnamed);
}

}  // namespace
}  // namespace sunder::tools
