// What C programs see of operations, files and snapshots has the bits that C++ programs see.

#include <sunder/io/operation_log.h>
#include <sunder/tear/torn_weights.h>

#include <algorithm>

#include "c/c_twins.h"

namespace sunder::test {
namespace {

TEST(CScene, random_commands_have_the_bits_of_the_library) {
  for (std::uint64_t seed = 0; seed < 12; ++seed) {
    SCOPED_TRACE(seed);
    Random random(seed);
    Twins twins(seed % 3 == 0 ? rich_character() : make_tube(24, 12, 6));
    twins.update();
    for (int frame = 0; frame < 20; ++frame) {
      submit_random(twins, random);
      twins.update();
      twins.expect_same_results();
      twins.expect_same();
    }
  }
}

TEST(CScene, a_stroke_over_frames_has_the_bits_of_the_library) {
  Random random(3);
  Twins twins(make_tube(24, 12, 6));
  twins.update();
  const Stroke stroke =
      random_stroke(*twins.asset->character(), twins.scene->find(twins.id)->pose(), random, 0.4, 8);
  sunder_tear_options options = sunder_default_tear_options();
  options.width = 0.01;
  sunder_stroke_sampling sampling = sunder_default_stroke_sampling();
  sampling.minimum_distance = 1e-4;
  for (std::size_t i = 0; i < stroke.size(); ++i) {
    const sunder_blade blade = blade_of(stroke[i]);
    const double seconds = static_cast<double>(i) / 64;
    if (i == 0) {
      EXPECT_DONE(sunder_submit_begin_stroke(twins.c_scene, twins.c_id, &blade, &options, &sampling,
                                             nullptr));
      ASSERT_TRUE(
          twins.scene->submit(twins.id, BeginStrokeCommand{stroke[i], {.width = 0.01}, {1e-4, 0}}));
    } else {
      EXPECT_DONE(sunder_submit_extend_stroke(twins.c_scene, twins.c_id, &blade, seconds, nullptr));
      ASSERT_TRUE(twins.scene->submit(twins.id, ExtendStrokeCommand{stroke[i], seconds}));
    }
    twins.update();
    twins.expect_same_results();
    twins.expect_same();
  }
  sunder_command number = 0;
  EXPECT_DONE(sunder_submit_end_stroke(twins.c_scene, twins.c_id, &number));
  EXPECT_EQ(*twins.scene->submit(twins.id, EndStrokeCommand()), number);
  twins.update();
  twins.expect_same();
  std::uint32_t undo = 0, redo = 9;
  EXPECT_DONE(sunder_get_undo_counts(twins.c_scene, twins.c_id, &undo, &redo));
  EXPECT_EQ(undo, 1u);
  EXPECT_EQ(redo, 0u);
}

TEST(CScene, a_mirror_of_what_changed_is_the_whole) {
  Random random(5);
  Twins twins(make_tube(24, 12, 6));
  std::vector<float> positions;
  std::vector<std::uint32_t> triangles;
  std::uint64_t seen = 0;
  for (int frame = 0; frame < 30; ++frame) {
    if (frame > 0 && frame % 3 == 0) submit_random(twins, random);
    twins.update();
    const sunder_posed_mesh part = posed_mesh(twins.c_scene, twins.c_id, 0, seen);
    positions.resize(3 * part.vertex_count);
    for (std::uint32_t i = 0; i < part.dirty_vertex_count; ++i)
      std::copy_n(part.positions + 3 * part.dirty_vertices[i].first,
                  3 * part.dirty_vertices[i].count,
                  positions.begin() + 3 * part.dirty_vertices[i].first);
    if (part.initial_triangle_count > 0)
      triangles.assign(part.initial_triangles,
                       part.initial_triangles + 3 * part.initial_triangle_count);
    triangles.resize(3 * part.triangle_capacity);
    for (std::uint32_t i = 0; i < part.triangle_write_count; ++i)
      std::copy_n(part.triangle_writes[i].vertices, 3,
                  triangles.begin() + 3 * part.triangle_writes[i].place);
    seen = part.epoch;
    const sunder_posed_mesh whole = posed_mesh(twins.c_scene, twins.c_id, 0);
    EXPECT_TRUE(std::equal(positions.begin(), positions.end(), whole.positions));
    ASSERT_GT(whole.range_count, 0u);
    // What is drawn are the triangles of the torn mesh.
    sunder_mesh torn = {};
    EXPECT_DONE(sunder_get_instance_mesh(twins.c_scene, twins.c_id, 0, &torn));
    std::vector<std::array<std::uint32_t, 3>> drawn, expected;
    for (std::uint32_t r = 0; r < whole.range_count; ++r)
      for (std::uint32_t i = 0; i < whole.ranges[r].triangle_count; ++i) {
        const std::uint32_t* const at = &triangles[3 * (whole.ranges[r].first_triangle + i)];
        if (at[0] != at[1] || at[1] != at[2]) drawn.push_back({at[0], at[1], at[2]});
      }
    for (std::uint32_t i = 0; i < torn.triangle_count; ++i) {
      const std::uint32_t* const at = torn.triangles + 3 * i;
      if (at[0] != at[1] || at[1] != at[2]) expected.push_back({at[0], at[1], at[2]});
    }
    std::sort(drawn.begin(), drawn.end());
    std::sort(expected.begin(), expected.end());
    EXPECT_EQ(drawn, expected);
  }
}

TEST(CScene, a_log_makes_the_same_model_again) {
  Random random(8);
  Twins twins(make_tube(24, 12, 6));
  twins.update();
  for (int i = 0; i < 8; ++i) {
    submit_random(twins, random);
    twins.update();
  }
  sunder_bytes json = 0;
  EXPECT_DONE(sunder_get_log(twins.c_scene, twins.c_id, &json));
  const std::string log = take_bytes(json);
  sunder_instance second = 0;
  EXPECT_DONE(sunder_spawn(twins.c_scene, twins.c_asset, nullptr, &second));
  std::uint32_t count = 0, undo = 0, redo = 0;
  EXPECT_DONE(sunder_apply_log(twins.c_scene, second, log.data(), log.size(), &count));
  EXPECT_DONE(sunder_get_undo_counts(twins.c_scene, twins.c_id, &undo, &redo));
  EXPECT_EQ(count, undo);
  EXPECT_GT(count, 0u);
  std::uint64_t first_digest = 0, second_digest = 1;
  EXPECT_DONE(sunder_get_digest(twins.c_scene, twins.c_id, &first_digest));
  EXPECT_DONE(sunder_get_digest(twins.c_scene, second, &second_digest));
  EXPECT_EQ(first_digest, second_digest);

  // It stops at the first operation that fails, and says which.
  const std::string bad =
      R"({"sunder_operations": 1, "operations": [{"op": "undo"}, {"op": "redo", "count": 7}]})";
  EXPECT_EQ(sunder_apply_log(twins.c_scene, second, bad.data(), bad.size(), &count),
            SUNDER_NOT_FOUND);
  EXPECT_EQ(count, 1u);
  EXPECT_EQ(sunder_last_error_index(), 1u);
  EXPECT_EQ(sunder_apply_log(twins.c_scene, second, "[]", 2, &count), SUNDER_MALFORMED_FILE);
}

TEST(CScene, a_torn_instance_is_written_as_by_the_library) {
  const Character character = rich_character();
  const auto glb = save_glb(character);
  const auto loaded = load_glb(*glb);
  sunder_character handle = 0;
  sunder_asset asset = 0;
  sunder_scene scene = 0;
  sunder_instance id = 0;
  EXPECT_DONE(sunder_load_glb(glb->data(), glb->size(), nullptr, &handle));
  EXPECT_DONE(sunder_create_asset(handle, nullptr, &asset));
  EXPECT_DONE(sunder_create_scene(nullptr, &scene));
  EXPECT_DONE(sunder_spawn(scene, asset, nullptr, &id));
  auto model = *TornModel::create(loaded->character);
  Random random(2);
  std::vector<Operation> operations = {random_operation(model, random),
                                       random_operation(model, random)};
  for (const Operation& one : operations) ASSERT_TRUE(apply_operation(model, one));
  const std::string log = *format_operations(operations);
  EXPECT_DONE(sunder_apply_log(scene, id, log.data(), log.size(), nullptr));
  sunder_bytes bytes = 0;
  EXPECT_DONE(sunder_save_instance(scene, id, nullptr, &bytes));
  SaveOptions with_origins;
  with_origins.origins = *vertex_origins(model);
  const auto expected = save_glb(model.character(), *loaded, with_origins);
  ASSERT_TRUE(expected);
  EXPECT_NE(*expected, *save_glb(model.character(), *loaded));
  EXPECT_EQ(take_bytes(bytes),
            std::string(reinterpret_cast<const char*>(expected->data()), expected->size()));
  // Objects live on while others need them, whichever is destroyed first.
  EXPECT_DONE(sunder_destroy_character(handle));
  EXPECT_DONE(sunder_destroy_asset(asset));
  EXPECT_DONE(sunder_update(scene, 0.1));
  EXPECT_DONE(sunder_save_instance(scene, id, nullptr, &bytes));
  EXPECT_DONE(sunder_destroy_bytes(bytes));
  EXPECT_DONE(sunder_destroy_scene(scene));
}

TEST(CScene, a_snapshot_goes_on_with_the_same_bits) {
  Random random(4);
  Twins twins(make_tube(24, 12, 6));
  twins.update();
  for (int i = 0; i < 4; ++i) {
    submit_random(twins, random);
    twins.update();
  }
  sunder_bytes snapshot = 0;
  EXPECT_DONE(sunder_save_scene(twins.c_scene, &snapshot));
  const std::string bytes = take_bytes(snapshot);
  sunder_scene other = 0;
  EXPECT_DONE(sunder_create_scene(nullptr, &other));
  EXPECT_EQ(sunder_restore_scene(other, bytes.data(), bytes.size(), nullptr, 0, nullptr),
            SUNDER_NOT_FOUND);
  EXPECT_DONE(sunder_restore_scene(other, bytes.data(), bytes.size(), &twins.c_asset, 1, nullptr));
  for (int i = 0; i < 10; ++i) {
    twins.update();
    EXPECT_DONE(sunder_update(other, 1.0 / 64));
    const sunder_posed_mesh expected = posed_mesh(twins.c_scene, twins.c_id, 0);
    const sunder_posed_mesh posed = posed_mesh(other, twins.c_id, 0);
    ASSERT_EQ(posed.vertex_count, expected.vertex_count);
    EXPECT_EQ(0, std::memcmp(posed.positions, expected.positions, 12u * posed.vertex_count));
  }
  std::string cut_off = bytes.substr(0, bytes.size() - 5);
  EXPECT_NE(sunder_restore_scene(other, cut_off.data(), cut_off.size(), &twins.c_asset, 1, nullptr),
            SUNDER_OK);
  sunder_restore_options limits = sunder_default_restore_options();
  limits.memory = 1000;
  EXPECT_EQ(sunder_restore_scene(other, bytes.data(), bytes.size(), &twins.c_asset, 1, &limits),
            SUNDER_LIMIT_EXCEEDED);
  EXPECT_DONE(sunder_destroy_scene(other));
}

}  // namespace
}  // namespace sunder::test
