// All memory of assets, scenes and instances comes from their resource, and goes back to it.

#include <sunder/core/memory_operators.h>
#include <sunder/scene/scene.h>
#include <sunder/skinning/pose.h>

#include <gtest/gtest.h>

#include "scene/frames.h"
#include "support/machine/counting_resource.h"
#include "support/models/random_operations.h"
#include "support/models/rigs.h"

namespace sunder {
namespace {

using test::CountingResource;

std::shared_ptr<const CharacterAsset> make_asset(CountingResource& memory,
                                                 std::uint32_t vertices = 3000) {
  auto character = std::make_shared<Character>(test::make_bumpy_ball(vertices));
  test::rig_along(*character, 8);
  CharacterAssetOptions options;
  options.soft.emplace();
  options.soft->tension = {2.0, {}};
  options.memory = &memory;
  auto asset = CharacterAsset::create(std::move(character), options);
  EXPECT_TRUE(asset) << asset.error().text();
  return *asset;
}

PlaneCut capped_cut(const Character& character, double height) {
  Eigen::AlignedBox3d box;
  for (const Vec3f& place : character.meshes[0].positions) box.extend(place.cast<double>());
  PlaneCut cut;
  cut.point = box.center();
  cut.point.y() = box.min().y() + height * box.sizes().y();
  cut.normal = Vec3d(0.1, 1, 0.2);
  cut.caps = true;
  return cut;
}

/// Counted bytes relative to those that a call reports.
void expect_near(std::size_t reported, std::size_t counted, double less, double more) {
  const double ratio = static_cast<double>(reported) / static_cast<double>(counted);
  EXPECT_GT(ratio, 1 - less) << reported << " of " << counted;
  EXPECT_LT(ratio, 1 + more) << reported << " of " << counted;
}

TEST(memory_scope, a_scene_returns_all_of_it) {
  CountingResource of_asset, of_scene;
  {
    const auto asset = make_asset(of_asset);
    EXPECT_GT(of_asset.bytes(), 0u);
    SceneOptions options;
    options.threads = 2;
    options.memory = &of_scene;
    auto scene = Scene::create(options);
    ASSERT_TRUE(scene);
    std::vector<InstanceId> ids;
    for (int i = 0; i < 3; ++i) {
      const auto id = scene->spawn(asset);
      ASSERT_TRUE(id);
      ids.push_back(*id);
    }
    test::Random random(1);
    const Character& source = *asset->character();
    for (int frame = 0; frame < 40; ++frame) {
      const InstanceId id = ids[random.index(3)];
      if (frame % 4 == 0) {
        const PlaneCut cut = capped_cut(source, random.uniform(0.2, 0.8));
        ASSERT_TRUE(scene->submit(id, cut, {.in_background = random.index(2) == 0}));
      }
      if (frame % 4 == 1) {
        TearCommand tear;
        tear.stroke = test::random_stroke(source, *rest_pose(source), random, 0.3, 3);
        ASSERT_TRUE(scene->submit(id, tear, {.wants_changes = true}));
      }
      if (frame % 8 == 6) {
        ASSERT_TRUE(scene->submit(id, UndoCommand{}));
      }
      ASSERT_TRUE(scene->set_pose(id, test::random_pose(source, random, 0.2)));
      ASSERT_TRUE(scene->update(kFrame));
      (void)scene->mesh(id, 0);
    }
    ASSERT_TRUE(scene->destroy(ids[1]));
    ASSERT_TRUE(scene->update(kFrame));
    EXPECT_GT(of_scene.bytes(), 0u);
  }
  EXPECT_EQ(of_scene.bytes(), 0u);
  EXPECT_EQ(of_scene.blocks(), 0u);
  EXPECT_EQ(of_asset.bytes(), 0u);
  EXPECT_EQ(of_asset.blocks(), 0u);
}

TEST(memory_scope, counts_agree_with_memory_bytes) {
  CountingResource of_asset, of_scene;
  const auto asset = make_asset(of_asset, 20'000);
  expect_near(asset->memory_bytes(), of_asset.bytes(), 0.15, 0.05);
  SceneOptions options;
  options.threads = 1;
  options.memory = &of_scene;
  auto scene = Scene::create(options);
  ASSERT_TRUE(scene);
  const auto id = scene->spawn(asset);
  ASSERT_TRUE(id);
  ASSERT_TRUE(scene->update(kFrame));
  expect_near(scene->memory_bytes().instances, of_scene.bytes(), 0.15, 0.05);
  ASSERT_TRUE(scene->find(*id)->prepare_to_tear());
  ASSERT_TRUE(scene->submit(*id, capped_cut(*asset->character(), 0.5)));
  ASSERT_TRUE(scene->update(kFrame));
  ASSERT_TRUE(scene->results()[0].status) << scene->results()[0].status.text();
  expect_near(scene->memory_bytes().instances, of_scene.bytes(), 0.25, 0.05);
}

TEST(memory_scope, a_resource_that_runs_out_fails_the_call_alone) {
  CountingResource of_asset, of_scene;
  const auto asset = make_asset(of_asset);
  SceneOptions options;
  options.threads = 1;
  options.memory = &of_scene;
  auto scene = Scene::create(options);
  ASSERT_TRUE(scene);
  const auto id = scene->spawn(asset);
  ASSERT_TRUE(id);
  ASSERT_TRUE(scene->update(kFrame));
  of_scene.limit(of_scene.bytes() + 20'000);
  ASSERT_TRUE(scene->submit(*id, capped_cut(*asset->character(), 0.5)));
  ASSERT_TRUE(scene->update(kFrame));
  ASSERT_EQ(scene->results().size(), 1u);
  EXPECT_EQ(scene->results()[0].status.code(), StatusCode::limit_exceeded);
  of_scene.limit(~std::size_t{0});
  ASSERT_TRUE(scene->submit(*id, capped_cut(*asset->character(), 0.5)));
  ASSERT_TRUE(scene->update(kFrame));
  EXPECT_TRUE(scene->results()[0].status) << scene->results()[0].status.text();
}

}  // namespace
}  // namespace sunder
