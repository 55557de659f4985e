// The models of tests/data/rigged equal those that our own code generates, and have the features
// for which tests use them.
#include "support/models/own_models.h"

#include <sunder/io/character_file.h>
#include <sunder/tear/topology.h>

#include <algorithm>

#include <gtest/gtest.h>

#include "support/machine/temporary_folder.h"
#include "support/models/shared_models.h"

namespace sunder {
namespace {

Character load_own(const std::string& file) {
  const auto loaded = load_character(test::own_data() / "rigged" / file);
  EXPECT_TRUE(loaded) << file << ": " << loaded.error().text();
  return loaded ? *loaded->character : Character();
}

std::size_t most_influences(const Mesh& mesh) {
  std::size_t most = 0;
  for (std::uint32_t vertex = 0; vertex < mesh.vertex_count(); ++vertex)
    most = std::max(most, mesh.weights.of(vertex).size());
  return most;
}

/// The files were written on another machine, whose sines may differ in the last bit.
void expect_same(const Character& file, const Character& made) {
  ASSERT_EQ(file.meshes.size(), made.meshes.size());
  EXPECT_EQ(file.skins.size(), made.skins.size());
  EXPECT_EQ(file.clips.size(), made.clips.size());
  ASSERT_EQ(file.skeleton.bones.size(), made.skeleton.bones.size());
  for (std::size_t i = 0; i < made.skeleton.bones.size(); ++i) {
    EXPECT_EQ(file.skeleton.bones[i].name, made.skeleton.bones[i].name);
    EXPECT_EQ(file.skeleton.bones[i].parent, made.skeleton.bones[i].parent);
  }
  for (std::size_t m = 0; m < made.meshes.size(); ++m) {
    const Mesh &a = file.meshes[m], &b = made.meshes[m];
    EXPECT_EQ(a.triangles, b.triangles);
    EXPECT_EQ(a.morph_targets.size(), b.morph_targets.size());
    ASSERT_EQ(a.vertex_count(), b.vertex_count());
    for (std::uint32_t v = 0; v < a.vertex_count(); ++v)
      EXPECT_LE((a.positions[v] - b.positions[v]).norm(), 1e-6f * (1.0f + b.positions[v].norm()));
  }
}

TEST(OwnModels, equal_those_generated_by_our_code) {
  const auto models = test::make_own_models();
  ASSERT_GE(models.size(), 8u);
  const test::TemporaryFolder folder;
  for (const test::OwnModel& model : models) {
    SCOPED_TRACE(model.file);
    const auto file = folder.path() / model.file;
    const Status status = save_glb(file, model.character, model.options);
    ASSERT_TRUE(status) << status.text();
    const auto made = load_character(file);
    ASSERT_TRUE(made) << made.error().text();
    expect_same(load_own(model.file), *made->character);
  }
}

TEST(OwnModels, have_different_features) {
  EXPECT_EQ(load_own("two_skins.glb").skins.size(), 2u);
  EXPECT_EQ(load_own("two_skins.glb").meshes.size(), 2u);
  EXPECT_EQ(most_influences(load_own("six_influences.glb").meshes[0]), 6u);
  EXPECT_GE(load_own("many_bones.glb").skeleton.bones.size(), 130u);
  EXPECT_EQ(load_own("scaled_bones.glb").skeleton.bones[0].rest.scale, Vec3f::Constant(0.01f));
  const Character clips = load_own("two_clips.glb");
  ASSERT_EQ(clips.clips.size(), 2u);
  EXPECT_EQ(clips.clips[0].channels[0].interpolation, Interpolation::cubic_spline);
  EXPECT_EQ(clips.clips[1].channels[0].interpolation, Interpolation::step);
  const Character sheet = load_own("seamed_sheet.glb");
  EXPECT_EQ(sheet.meshes[0].morph_targets.size(), 1u);
  EXPECT_EQ(sheet.meshes[0].vertex_count(), 11u * 11u + 11u);
  EXPECT_EQ(count_topology(sheet)->boundary_loops, 1u);  // the seam is no border
}

}  // namespace
}  // namespace sunder
