// Queries meet the soft surface that an instance draws.

#include <sunder/scene/character_instance.h>
#include <sunder/skinning/pose.h>
#include <sunder/tear/contact.h>

#include <gtest/gtest.h>

#include "support/machine/stress.h"
#include "support/models/random_operations.h"
#include "support/models/rigs.h"
#include "support/oracles/contact_oracle.h"

namespace sunder {
namespace {

using test::ContactOracle;
using test::Random;

std::vector<VertexDisplacements> displacements_of(CharacterInstance& instance) {
  std::vector<VertexDisplacements> displacements;
  for (std::uint32_t m = 0; m < instance.character().meshes.size(); ++m)
    displacements.push_back(instance.displacements(m));
  return displacements;
}

ContactOracle oracle_of(CharacterInstance& instance) {
  std::vector<std::vector<Vec3d>> positions;
  const Character& character = instance.character();
  for (std::uint32_t m = 0; m < character.meshes.size(); ++m) {
    positions.emplace_back();
    for (const Vec3f& position : instance.mesh(m).positions)
      positions.back().push_back(position.cast<double>());
  }
  return {character, positions};
}

class DisplacedContact : public testing::TestWithParam<int> {};

TEST_P(DisplacedContact, hits_are_those_of_what_is_drawn) {
  std::size_t hits = 0, moved = 0;
  for (int seed = 0; seed < test::stressed(6, 20); ++seed) {
    Random random(100 * GetParam() + seed);
    const auto character = std::make_shared<const Character>(
        GetParam() == 0 ? test::make_tube(10, 12, 4) : test::make_two_tubes(5, 8));
    CharacterAssetOptions options;
    options.soft.emplace();
    options.soft->decomposition.range = 0.2;
    auto instance = CharacterInstance::create(character, options);
    ASSERT_TRUE(instance) << instance.error().text();
    const ModelPose pose = test::random_pose(*character, random, 0.3, 1.1);
    ASSERT_TRUE(instance->advance(pose, 1.0 / 60));
    ASSERT_TRUE(instance->tear(pose, test::random_stroke(*character, pose, random)));
    for (std::uint32_t p = 0; p < instance->body()->particle_count(); p += 3)
      ASSERT_TRUE(instance->body()->set_force(p, 2 * random.direction()));
    SurfaceQuery query = *SurfaceQuery::create(*instance->model());
    for (int frame = 0; frame < 4; ++frame) {
      for (int step = 0; step < 5; ++step) ASSERT_TRUE(instance->advance(pose, 1.0 / 60));
      ASSERT_TRUE(instance->draw());
      const auto displacements = displacements_of(*instance);
      ContactOptions contact;
      contact.displacements = displacements;
      const Status status = query.set_pose(instance->pose(), contact);
      ASSERT_TRUE(status) << status.text();
      const ContactOracle oracle = oracle_of(*instance);
      const double size = test::posed_diagonal(*character, pose);
      for (const Vec4f& u : instance->body()->displacements())
        if (u.norm() > 1e-3f) ++moved;
      for (int i = 0; i < 20; ++i) {
        const auto& face =
            oracle.faces()[random.index(static_cast<std::uint32_t>(oracle.faces().size()))];
        const Vec3d middle = (face.corners[0] + face.corners[1] + face.corners[2]) / 3;
        const Vec3d from = middle + size * random.direction();
        const auto crossings = oracle.crossings(from, (middle - from).normalized(), 1e-4);
        if (crossings.empty() || std::abs(crossings[0].least) < 1e-4) continue;
        const auto hit = query.cast_ray({from, middle - from});
        ASSERT_TRUE(hit && *hit);
        ++hits;
        // A ray that grazes a face turns rounding in float into a longer way along itself.
        const double steep = std::abs((*hit)->normal.dot((middle - from).normalized()));
        EXPECT_NEAR((*hit)->distance, crossings[0].along, 1e-5 * size / std::max(steep, 1e-3));
        const Vec3d point = middle + 0.05 * size * random.direction();
        EXPECT_NEAR((*query.find_nearest(point))->distance, oracle.distance(point, point),
                    1e-5 * size);
      }
    }
  }
  EXPECT_GT(hits, 100u);
  EXPECT_GT(moved, 100u) << "nothing was displaced";
}

INSTANTIATE_TEST_SUITE_P(Rigs, DisplacedContact, testing::Values(0, 1));

/// Only the vertices listed as moved are displaced, as in SkinnedMesh.
TEST(DisplacedContactOfArrays, unlisted_vertices_stay) {
  const auto sheet = std::make_shared<const Character>(test::make_sheet(4));
  const TornModel model = *TornModel::create(sheet);
  SurfaceQuery query = *SurfaceQuery::create(model);
  const std::uint32_t count = sheet->meshes[0].vertex_count();
  const std::vector<std::uint32_t> rows(count, 0);
  const ParticleInfluences row = {{0, 0, 0, 0}, {1, 0, 0, 0}};
  const Vec4f up(0, 0, 0.5f, 0);
  const IndexRange first_half = {0, count / 2}, all = {0, count};
  VertexDisplacements of_mesh = {rows, {&row, 1}, {&up, 1}, {&all, 1}, {}, {}};
  ContactOptions options;
  options.displacements = {&of_mesh, 1};
  const ModelPose pose = *bind_pose(*sheet);
  ASSERT_TRUE(query.set_pose(pose, options));
  EXPECT_DOUBLE_EQ((*query.cast_ray({{0.9, 0.9, 2}, {0, 0, -1}}))->distance, 1.5);
  of_mesh.moved = {&first_half, 1};
  ASSERT_TRUE(query.set_pose(pose, options));
  EXPECT_DOUBLE_EQ((*query.cast_ray({{0.9, 0.9, 2}, {0, 0, -1}}))->distance, 2);
  EXPECT_DOUBLE_EQ((*query.cast_ray({{0.1, 0.1, 2}, {0, 0, -1}}))->distance, 1.5);
}

}  // namespace
}  // namespace sunder
