// Writing a character without a source document, with a character that has all features.

#include <sunder/io/character_file.h>
#include <sunder/skinning/deform.h>
#include <sunder/skinning/pose.h>

#include <algorithm>
#include <filesystem>

#include <gtest/gtest.h>

#include "support/machine/gltf_validator.h"
#include "support/machine/temporary_folder.h"
#include "tools/demo/demo_rig.h"

namespace sunder {
namespace {

const Mesh& mesh_named(const Character& character, const std::string& name) {
  return *std::find_if(character.meshes.begin(), character.meshes.end(),
                       [&](const Mesh& mesh) { return mesh.name == name; });
}

std::vector<Vec3f> posed_positions(const Character& character, const Mesh& mesh, double time) {
  Pose pose = *local_rest_pose(character);
  EXPECT_TRUE(sample_clip(character.clips.at(0), time, pose));
  ModelPose model_pose;
  EXPECT_TRUE(compute_model_pose(character.skeleton, pose, model_pose));
  const Skin& skin = character.skins[mesh.skin];
  std::vector<Affine3f> palette(skin.bones.size());
  EXPECT_TRUE(compute_palette(skin, model_pose, palette));
  DeformedMesh deformed;
  EXPECT_TRUE(deform_mesh(mesh, palette, model_pose.morph_weights, deformed));
  return deformed.positions;
}

class NewDocument : public testing::Test {
 protected:
  LoadedCharacter save_and_load(const Character& character, const SaveOptions& options = {}) {
    const Status status = save_glb(file_, character, options);
    EXPECT_TRUE(status) << status.text();
    Result<LoadedCharacter> loaded = load_character(file_);
    EXPECT_TRUE(loaded) << loaded.error().text();
    return *loaded;
  }

  const test::TemporaryFolder folder_;
  const std::filesystem::path file_ = folder_.path() / "new.glb";
  const Character cactus_ = tools::make_cactus();
};

/// Checked by our own reader and, if it is installed, by the Khronos validator.
TEST_F(NewDocument, is_valid) {
  for (const std::uint32_t influences : {0u, 4u, 8u}) {
    SaveOptions options;
    options.maximum_influences = influences;
    ASSERT_TRUE(save_glb(file_, cactus_, options));
    EXPECT_TRUE(load_character(file_));
    if (!test::has_gltf_validator()) continue;
    const test::ValidatorReport report = test::validate_glb(file_);
    EXPECT_EQ(report.errors, 0) << report.output;
  }
}

TEST_F(NewDocument, keeps_every_attribute) {
  const LoadedCharacter loaded = save_and_load(cactus_);
  for (const Mesh& before : cactus_.meshes) {
    const Mesh& after = mesh_named(*loaded.character, before.name);
    EXPECT_EQ(after.positions, before.positions);
    EXPECT_EQ(after.normals, before.normals);
    EXPECT_EQ(after.uv_sets, before.uv_sets);
    EXPECT_EQ(after.triangle_count(), before.triangle_count());
    EXPECT_EQ(after.submeshes.size(), before.submeshes.size());
    ASSERT_EQ(after.morph_targets.size(), before.morph_targets.size());
    for (std::size_t i = 0; i < before.morph_targets.size(); ++i) {
      EXPECT_EQ(after.morph_targets[i].name, before.morph_targets[i].name);
      EXPECT_EQ(after.morph_targets[i].position_deltas, before.morph_targets[i].position_deltas);
    }
  }
}

TEST_F(NewDocument, moves_as_before) {
  const LoadedCharacter loaded = save_and_load(cactus_);
  ASSERT_EQ(loaded.character->clips.size(), 1u);
  EXPECT_EQ(loaded.character->clips[0].name, "Sway");
  for (const double time : {0.0, 0.37, 1.0, 1.61})
    for (const Mesh& before : cactus_.meshes) {
      const auto expected = posed_positions(cactus_, before, time);
      const auto found =
          posed_positions(*loaded.character, mesh_named(*loaded.character, before.name), time);
      ASSERT_EQ(found.size(), expected.size());
      float worst = 0;
      for (std::size_t v = 0; v < found.size(); ++v)
        worst = std::max(worst, (found[v] - expected[v]).norm());
      EXPECT_LT(worst, 2e-6f) << before.name << " at " << time;
    }
}

TEST_F(NewDocument, keeps_the_largest_influences_that_are_asked_for) {
  SaveOptions options;
  options.maximum_influences = 4;
  const LoadedCharacter loaded = save_and_load(cactus_, options);
  const Mesh& flesh = mesh_named(*loaded.character, "Cactus");
  for (std::uint32_t v = 0; v < flesh.vertex_count(); ++v)
    ASSERT_LE(flesh.weights.of(v).size(), 4u);
}

TEST_F(NewDocument, refuses_invalid_characters_and_leaves_no_file) {
  Character broken = cactus_;
  broken.meshes[0].triangles[7][1] = 1'000'000;
  EXPECT_EQ(save_glb(file_, broken).code(), StatusCode::index_out_of_range);
  SaveOptions options;
  options.maximum_influences = 5;
  EXPECT_EQ(save_glb(file_, cactus_, options).code(), StatusCode::invalid_argument);
  EXPECT_EQ(save_glb(folder_.path() / "no such folder" / "a.glb", cactus_).code(),
            StatusCode::file_unreadable);
  EXPECT_TRUE(std::filesystem::is_empty(folder_.path()));
}

}  // namespace
}  // namespace sunder
