// Torn models are saved with no more influences per vertex than the source has, or four: readers of
// the first set alone, as three.js is, pose a file of four within what written_influences() says.

#include <sunder/io/character_file.h>
#include <sunder/skinning/deform.h>
#include <sunder/skinning/pose.h>
#include <sunder/tear/torn_model.h>
#include <sunder/weights/influences.h>

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "support/machine/gltf_validator.h"
#include "support/machine/temporary_folder.h"
#include "support/models/rigs.h"
#include "support/models/shared_models.h"

namespace sunder::test {
namespace {

/// The influences per vertex that a file of a torn model has at most.
std::uint32_t most_written(const Character& source) {
  std::uint32_t most = 4;
  for (const Mesh& mesh : source.meshes)
    for (std::uint32_t v = 0; v < mesh.vertex_count(); ++v)
      most = std::max(most, static_cast<std::uint32_t>(mesh.weights.of(v).size()));
  return most;
}

std::string text_of(const std::filesystem::path& glb) {
  const std::vector<std::byte> bytes = read_bytes(glb);
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

/// How far the largest influences alone move the vertices of a mesh in a pose, by the closed form;
/// one per vertex.
std::vector<double> displacements(const Character& character, std::uint32_t mesh_index,
                                  const ModelPose& pose, std::uint32_t most) {
  const Mesh& mesh = character.meshes[mesh_index];
  const Skin& skin = character.skins[mesh.skin];
  std::vector<Affine3d> palette(skin.bones.size());
  EXPECT_TRUE(compute_palette(skin, pose, palette));
  std::vector<double> moved;
  for (std::uint32_t v = 0; v < mesh.vertex_count(); ++v) {
    const auto all = mesh.weights.of(v);
    std::vector<Influence> sorted(all.begin(), all.end());
    EXPECT_TRUE(sort_influences(sorted));
    Vec3d position = mesh.positions[v].cast<double>();
    for (std::size_t i = 0; i < mesh.morph_targets.size(); ++i)
      if (!mesh.morph_targets[i].position_deltas.empty())
        position += static_cast<double>(pose.morph_weights[mesh.first_morph_weight + i]) *
                    mesh.morph_targets[i].position_deltas[v].cast<double>();
    moved.push_back(pruning_displacement(position, sorted, most, palette).norm());
  }
  return moved;
}

void expect_posed_within_bounds(const Character& torn, const Character& file, std::uint32_t most,
                                Random& random) {
  for (int i = 0; i < 6; ++i) {
    const ModelPose pose = random_pose(torn, random, 0.5, 1.1);
    const double rounding = 2e-6 * posed_diagonal(torn, pose);
    for (std::uint32_t m = 0; m < torn.meshes.size(); ++m) {
      const auto in_memory = posed_positions(torn, m, pose),
                 in_file = posed_positions(file, m, pose);
      ASSERT_EQ(in_memory.size(), in_file.size());
      const std::vector<double> bound = displacements(torn, m, pose, most);
      for (std::size_t v = 0; v < in_memory.size(); ++v)
        ASSERT_LE((in_memory[v] - in_file[v]).norm(), bound[v] + rounding) << "vertex " << v;
    }
  }
}

class SourceInfluences : public testing::TestWithParam<std::filesystem::path> {};

TEST_P(SourceInfluences, stay_as_many_when_torn_and_saved) {
  const auto loaded = load_character(GetParam());
  ASSERT_TRUE(loaded.has_value()) << loaded.error().text();
  Random random(std::hash<std::string>()(GetParam().filename().string()));
  auto model = TornModel::create(loaded->character);
  ASSERT_TRUE(model.has_value());
  for (int i = 0; i < 5; ++i) {
    const ModelPose pose = random_pose(model->character(), random);
    ASSERT_TRUE(model->tear(pose, random_stroke(model->character(), pose, random)));
  }
  const Character& torn = model->character();
  const TemporaryFolder folder;
  const auto file = folder.path() / "torn.glb";
  ASSERT_TRUE(save_glb(file, torn, *loaded));
  const auto again = load_character(file);
  ASSERT_TRUE(again.has_value()) << again.error().text();
  const std::uint32_t most = most_written(*loaded->character);
  for (const Mesh& mesh : again->character->meshes)
    for (std::uint32_t v = 0; v < mesh.vertex_count(); ++v) {
      EXPECT_LE(mesh.weights.of(v).size(), most);
      double sum = 0;
      for (const Influence& influence : mesh.weights.of(v))
        sum += static_cast<double>(influence.weight);
      EXPECT_NEAR(sum, 1, 1e-6);
    }
  EXPECT_EQ(text_of(file).find("JOINTS_1") == std::string::npos, most == 4);
  expect_posed_within_bounds(torn, *again->character, most, random);
  if (has_gltf_validator()) {
    EXPECT_LE(validate_glb(file).errors, validate_glb(GetParam()).errors);
  }

  const auto written = written_influences(torn, *loaded);
  ASSERT_TRUE(written.has_value());
  std::uint64_t pruned = 0, counted = 0;
  for (const WrittenInfluences& mesh : *written) pruned += mesh.vertices_pruned;
  for (const Mesh& mesh : torn.meshes)
    for (std::uint32_t v = 0; v < mesh.vertex_count(); ++v)
      counted += mesh.weights.of(v).size() > most;
  EXPECT_EQ(pruned, counted);

  ASSERT_TRUE(save_glb(file, torn, *loaded, {kAllInfluences}));
  EXPECT_EQ(text_of(file).find("JOINTS_1") != std::string::npos, most > 4 || counted > 0);
}

INSTANTIATE_TEST_SUITE_P(all, SourceInfluences, testing::ValuesIn(rigged_gltf_models()),
                         [](const auto& test_case) {
                           std::string name = test_case.param.stem().string();
                           std::replace_if(
                               name.begin(), name.end(),
                               [](unsigned char c) { return std::isalnum(c) == 0; }, '_');
                           return name + "_" + std::to_string(test_case.index);
                         });

}  // namespace
}  // namespace sunder::test
