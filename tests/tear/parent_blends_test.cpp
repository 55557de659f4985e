// Exact points as a shader poses them: means of posed parents.

#include <sunder/skinning/deform.h>
#include <sunder/skinning/skinned_mesh.h>
#include <sunder/tear/torn_weights.h>

#include <cstring>
#include <map>

#include <gtest/gtest.h>

#include "support/models/make_model.h"
#include "support/models/random_operations.h"
#include "support/models/rigs.h"

namespace sunder {
namespace {

/// The computation of the pass in docs/weights.md.
void blend(const ParentBlends& parents, std::vector<Vec3f>& positions) {
  for (std::size_t level = 0; level + 1 < parents.level_begin.size(); ++level)
    for (std::uint32_t i = parents.level_begin[level]; i < parents.level_begin[level + 1]; ++i) {
      const ParentBlend& of = parents.blends[i];
      Eigen::Vector3f sum = Eigen::Vector3f::Zero();
      for (std::size_t k = 0; k < 3; ++k) sum += of.parts[k] * positions[of.parents[k]];
      positions[of.vertex] = sum;
    }
}

std::vector<Vec3f> skinned(const VertexSource& source, const Skin& skin, const ModelPose& pose) {
  const auto runtime = SkinnedMesh::create(source, skin.bones.size());
  EXPECT_TRUE(runtime);
  BonePalette palette = *BonePalette::create(skin.bones.size(), pose.morph_weights.size());
  EXPECT_TRUE(palette.set(skin, pose));
  std::vector<Vec3f> positions(source.vertex_count);
  VertexTarget target;
  target.vertex_count = source.vertex_count;
  target.positions.data = positions[0].data();
  PosedBuffer buffer(target);
  EXPECT_TRUE(runtime->deform(palette, buffer));
  return positions;
}

TEST(ParentBlends, pose_as_influence_positions_do_in_every_pose) {
  std::size_t levels = 0, blends = 0;
  for (std::uint64_t seed = 1; seed <= 30; ++seed) {
    test::Random random(seed);
    auto model = test::make_model(test::make_tube(14, 18, 5));
    ASSERT_TRUE(model.set_weights({WeightPolicy::exact, 0}));
    for (int i = 0; i < 4; ++i)
      ASSERT_TRUE(test::play(model, test::random_operation(model, random)));
    const Mesh& mesh = model.character().meshes[0];
    const Skin& skin = model.character().skins[0];
    const ParentBlends parents = *parent_blends(model, 0);
    const InfluencePositions& exact = model.influence_positions(0);
    ASSERT_EQ(parents.blends.size(), exact.vertices.size());
    levels = std::max(levels, parents.level_begin.size() - 1);
    blends += parents.blends.size();
    for (const ParentBlend& of : parents.blends) {
      EXPECT_NEAR(of.parts[0] + of.parts[1] + of.parts[2], 1, 2e-7);
      for (const std::uint32_t parent : of.parents) EXPECT_LT(parent, of.vertex);
    }
    for (int i = 0; i < 3; ++i) {
      const ModelPose pose = test::random_pose(model.source(), random, 0.9);
      std::vector<Vec3f> blended = skinned(source_of(mesh), skin, pose);
      blend(parents, blended);
      VertexSource source = source_of(mesh);
      source.per_influence = &exact;
      const std::vector<Vec3f> expected = skinned(source, skin, pose);
      const double diagonal = test::posed_diagonal(model.source(), pose);
      for (std::uint32_t v = 0; v < mesh.vertex_count(); ++v)
        ASSERT_LT((blended[v] - expected[v]).norm(), 2e-6 * diagonal)
            << "vertex " << v << " of seed " << seed;
    }
  }
  EXPECT_GT(blends, 1000u);
  EXPECT_GE(levels, 2u) << "no operation tore the wall or cap of another one";
}

TEST(ParentBlends, lips_stay_closed_bit_for_bit) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    test::Random random(seed);
    auto model = test::make_model(test::make_tube(20, 24, 6));
    ASSERT_TRUE(model.set_weights({WeightPolicy::exact, 0}));
    const ModelPose pose = test::random_pose(model.source(), random, 0.9);
    ChangeRecord change;
    ASSERT_TRUE(
        model.tear(pose, test::random_stroke(model.source(), pose, random, 0.6, 5), {}, &change));
    const Mesh& mesh = model.character().meshes[0];
    const ModelPose other = test::random_pose(model.source(), random, 0.9);
    std::vector<Vec3f> positions = skinned(source_of(mesh), model.character().skins[0], other);
    blend(*parent_blends(model, 0), positions);
    std::map<std::uint32_t, std::vector<std::uint32_t>> vertices_of_point;
    for (std::uint32_t t = 0; t < mesh.triangle_count(); ++t)
      for (std::uint32_t k = 0; k < 3; ++k)
        vertices_of_point[model.point_at(0, t, k)].push_back(mesh.triangles[t][k]);
    const auto is_same = [&](std::uint32_t a, std::uint32_t b) {
      return std::memcmp(&positions[a], &positions[b], sizeof(Vec3f)) == 0;
    };
    for (const auto& [point, vertices] : vertices_of_point)
      for (const std::uint32_t vertex : vertices)
        EXPECT_TRUE(is_same(vertex, vertices[0])) << "point " << point;
    ASSERT_FALSE(change.lips.empty());
    for (const LipPair& lips : change.lips)
      EXPECT_TRUE(is_same(vertices_of_point[lips.left][0], vertices_of_point[lips.right][0]));
  }
}

}  // namespace
}  // namespace sunder
