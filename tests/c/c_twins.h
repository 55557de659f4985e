#pragma once

#include <sunder/scene/scene.h>

#include <array>
#include <cstring>
#include <memory>
#include <optional>
#include <string>

#include "c/c_objects.h"
#include "support/models/random_operations.h"

namespace sunder::test {

/// The same instance by C and by C++, soft, with a clip that plays.
class Twins {
 public:
  explicit Twins(const Character& character, bool is_soft = true) {
    CharacterAssetOptions options;
    if (is_soft) options.soft.emplace();
    asset = *CharacterAsset::create(std::make_shared<const Character>(character), options);
    SceneOptions one_thread;
    one_thread.threads = 1;
    scene.emplace(*Scene::create(one_thread));
    id = *scene->spawn(asset);

    c_character = create(character);
    sunder_asset_options c_options = sunder_default_asset_options();
    c_options.is_soft = is_soft ? 1 : 0;
    EXPECT_DONE(sunder_create_asset(c_character, &c_options, &c_asset));
    sunder_scene_options of_scene = sunder_default_scene_options();
    of_scene.threads = 1;
    of_scene.wants_changes = 1;
    EXPECT_DONE(sunder_create_scene(&of_scene, &c_scene));
    EXPECT_DONE(sunder_spawn(c_scene, c_asset, nullptr, &c_id));
    if (character.clips.empty()) return;
    EXPECT_TRUE(scene->play(id, 0));
    EXPECT_DONE(sunder_play(c_scene, c_id, 0, nullptr, nullptr));
  }
  ~Twins() {
    EXPECT_DONE(sunder_destroy_scene(c_scene));
    EXPECT_DONE(sunder_destroy_asset(c_asset));
    EXPECT_DONE(sunder_destroy_character(c_character));
  }

  void update(double seconds = 1.0 / 64) {
    EXPECT_TRUE(scene->update(seconds));
    EXPECT_DONE(sunder_update(c_scene, seconds));
  }

  /// All that is drawn, and the torn model.
  void expect_same() {
    for (std::uint32_t m = 0; m < asset->character()->meshes.size(); ++m) {
      const PosedMesh expected = scene->mesh(id, m);
      const sunder_posed_mesh posed = posed_mesh(c_scene, c_id, m);
      ASSERT_EQ(posed.vertex_count, expected.positions.size());
      EXPECT_EQ(0, std::memcmp(posed.positions, expected.positions.data(),
                               expected.positions.size_bytes()));
      EXPECT_EQ(posed.normals == nullptr, expected.normals.empty());
      if (posed.normals != nullptr) {
        EXPECT_EQ(
            0, std::memcmp(posed.normals, expected.normals.data(), expected.normals.size_bytes()));
      }
      ASSERT_EQ(posed.triangle_write_count, expected.triangle_writes.size());
      for (std::uint32_t i = 0; i < posed.triangle_write_count; ++i) {
        EXPECT_EQ(posed.triangle_writes[i].place, expected.triangle_writes[i].place);
        EXPECT_EQ(0, std::memcmp(posed.triangle_writes[i].vertices,
                                 expected.triangle_writes[i].triangle.data(), 12));
      }
    }
    std::uint64_t digest = 1;
    EXPECT_DONE(sunder_get_digest(c_scene, c_id, &digest));
    const TornModel* const model = scene->find(id)->model();
    EXPECT_EQ(digest, model == nullptr ? 0 : model->digest());
  }

  /// The results of the last update.
  void expect_same_results() {
    const sunder_result* results = nullptr;
    std::uint32_t count = 0;
    EXPECT_DONE(sunder_get_results(c_scene, &results, &count));
    const auto expected = scene->results();
    ASSERT_EQ(count, expected.size());
    for (std::uint32_t i = 0; i < count; ++i) {
      EXPECT_EQ(results[i].command, expected[i].command);
      EXPECT_EQ(results[i].instance, c_id);
      EXPECT_EQ(results[i].status, static_cast<int>(expected[i].status.code()));
      EXPECT_EQ(std::string(results[i].error), expected[i].status.text());
      EXPECT_EQ(results[i].faces_crossed, expected[i].report.faces_crossed);
      EXPECT_EQ(results[i].length, expected[i].report.length_posed);
      EXPECT_EQ(results[i].has_piece, expected[i].piece != nullptr ? 1u : 0u);
    }
  }

  std::shared_ptr<const CharacterAsset> asset;
  std::optional<Scene> scene;
  InstanceId id;
  sunder_character c_character = 0;
  sunder_asset c_asset = 0;
  sunder_scene c_scene = 0;
  sunder_instance c_id = 0;
};

/// Submits one command of a random kind to both.
inline void submit_random(Twins& twins, Random& random) {
  const Character& character = twins.scene->find(twins.id)->character();
  const ModelPose& pose = twins.scene->find(twins.id)->pose();
  const Stroke stroke = random_stroke(character, pose, random, 0.3, 2 + random.index(4));
  SceneCommand command;
  switch (random.index(7)) {
    case 0: {
      PlaneCut cut;
      cut.point = stroke[0].tip;
      cut.normal = random.direction();
      cut.caps = random.index(2) == 0;
      if (random.index(2) == 0) cut.sections = {stroke[1].tip};
      if (random.index(2) == 0) cut.first_hit = SectionRay{stroke[0].base, {1, 0, 0}};
      sunder_cut c_cut = sunder_default_cut();
      for (int i = 0; i < 3; ++i) {
        c_cut.point[i] = cut.point[i];
        c_cut.normal[i] = cut.normal[i];
        c_cut.ray_origin[i] = stroke[0].base[i];
      }
      c_cut.has_caps = cut.caps ? 1 : 0;
      c_cut.sections = stroke[1].tip.data();
      c_cut.section_count = static_cast<std::uint32_t>(cut.sections.size());
      c_cut.has_first_hit = cut.first_hit ? 1 : 0;
      EXPECT_DONE(sunder_submit_cut(twins.c_scene, twins.c_id, &c_cut, 0, nullptr));
      command = cut;
      break;
    }
    case 1: {
      Bore bore;
      bore.origin = stroke[0].base;
      bore.direction = stroke[0].tip - stroke[0].base;
      bore.radius = 0.02;
      bore.depth = 0.1;
      bore.wall = random.index(2) == 0;
      sunder_bore c_bore = sunder_default_bore();
      for (int i = 0; i < 3; ++i) {
        c_bore.origin[i] = bore.origin[i];
        c_bore.direction[i] = bore.direction[i];
      }
      c_bore.radius = bore.radius;
      c_bore.depth = bore.depth;
      c_bore.has_wall = bore.wall ? 1 : 0;
      EXPECT_DONE(sunder_submit_drill(twins.c_scene, twins.c_id, &c_bore, 0, nullptr));
      command = bore;
      break;
    }
    case 4: {
      Weld weld;
      if (random.index(2) == 0) weld.places = {stroke[0].tip, stroke[1].tip};
      if (random.index(2) == 0) weld.reach = 0.05;
      const std::array numbers = {stroke[0].tip.x(), stroke[0].tip.y(), stroke[0].tip.z(),
                                  stroke[1].tip.x(), stroke[1].tip.y(), stroke[1].tip.z()};
      sunder_weld c_weld = sunder_default_weld();
      c_weld.places = weld.places.empty() ? nullptr : numbers.data();
      c_weld.place_count = static_cast<std::uint32_t>(weld.places.size());
      c_weld.reach = weld.reach;
      if (random.index(3) > 0) {
        EXPECT_DONE(sunder_submit_weld(twins.c_scene, twins.c_id, &c_weld, 0, nullptr));
        command = weld;
        break;
      }
      Suture suture{weld.places, weld.reach};
      suture.spacing = random.uniform(0.01, 0.1);
      sunder_suture c_suture = sunder_default_suture();
      c_suture.places = c_weld.places;
      c_suture.place_count = c_weld.place_count;
      c_suture.reach = suture.reach;
      c_suture.spacing = suture.spacing;
      EXPECT_DONE(sunder_submit_suture(twins.c_scene, twins.c_id, &c_suture, 0, nullptr));
      command = suture;
      break;
    }
    case 2:
      EXPECT_DONE(sunder_submit_undo(twins.c_scene, twins.c_id, nullptr));
      command = UndoCommand();
      break;
    case 3:
      EXPECT_DONE(sunder_submit_redo(twins.c_scene, twins.c_id, nullptr));
      command = RedoCommand();
      break;
    default: {
      TearCommand tear{stroke, {}};
      tear.options.width = random.index(2) == 0 ? 0.01 : 0.0;
      tear.options.wall_depth = random.index(2) == 0 ? 0.02 : 0.0;
      if (random.index(3) == 0) tear.options.weights = {WeightPolicy::pose_exact, 3};
      sunder_tear_options options = sunder_default_tear_options();
      options.width = tear.options.width;
      options.wall_depth = tear.options.wall_depth;
      if (tear.options.weights) {
        options.weight_policy = SUNDER_WEIGHTS_POSE_EXACT;
        options.maximum_influences = 3;
      }
      const auto blades = blades_of(stroke);
      EXPECT_DONE(sunder_submit_tear(twins.c_scene, twins.c_id, blades.data(),
                                     static_cast<std::uint32_t>(blades.size()), &options, 0,
                                     nullptr));
      command = tear;
    }
  }
  CommandOptions options;
  options.wants_changes = true;
  ASSERT_TRUE(twins.scene->submit(twins.id, command, options));
}

}  // namespace sunder::test
