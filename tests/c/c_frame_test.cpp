// A frame in C: layers and poses, the hooks and the memory of the program.

#include <array>

#include "c/c_twins.h"
#include "c/counted_memory.h"

namespace sunder::test {
namespace {

TEST(CFrame, layers_and_poses_are_those_of_the_library) {
  Twins twins(make_tube(24, 12, 6), false);
  sunder_layer_options options = sunder_default_layer_options();
  options.kind = SUNDER_LAYER_ADDITIVE;
  options.weight = 0.5f;
  options.speed = 2.0;
  options.mask_bone = 2;
  sunder_layer layer = 0;
  EXPECT_DONE(sunder_play(twins.c_scene, twins.c_id, 0, &options, &layer));
  LayerOptions expected;
  expected.kind = LayerKind::additive;
  expected.weight = 0.5f;
  expected.speed = 2.0;
  expected.mask =
      std::make_shared<const BoneMask>(*subtree_mask(twins.asset->character()->skeleton, 2));
  const auto id = twins.scene->play(twins.id, 0, expected);
  ASSERT_TRUE(id);
  for (int i = 0; i < 5; ++i) twins.update();
  twins.expect_same();
  EXPECT_DONE(sunder_fade_layer(twins.c_scene, twins.c_id, layer, 1.0f, 0.1));
  EXPECT_TRUE(twins.scene->player(twins.id)->fade(*id, 1.0f, 0.1));
  EXPECT_DONE(sunder_seek_layer(twins.c_scene, twins.c_id, layer, 0.7));
  EXPECT_TRUE(twins.scene->player(twins.id)->seek(*id, 0.7));
  for (int i = 0; i < 5; ++i) twins.update();
  twins.expect_same();
  sunder_layer_state state = {};
  state.struct_size = sizeof state;
  EXPECT_DONE(sunder_get_layer(twins.c_scene, twins.c_id, layer, &state));
  EXPECT_EQ(state.time, twins.scene->player(twins.id)->layer(*id)->time);
  EXPECT_DONE(sunder_stop_layer(twins.c_scene, twins.c_id, layer, 0.0));
  twins.update();
  EXPECT_EQ(sunder_get_layer(twins.c_scene, twins.c_id, layer, &state), SUNDER_NOT_FOUND);
  EXPECT_TRUE(twins.scene->player(twins.id)->stop(*id));

  Random random(1);
  const ModelPose pose = random_pose(*twins.asset->character(), random);
  EXPECT_DONE(sunder_set_matrices(twins.c_scene, twins.c_id, pose.model_from_bone[0].data(), 6,
                                  pose.morph_weights.data()));
  EXPECT_TRUE(twins.scene->set_pose(twins.id, pose));
  twins.update();
  twins.expect_same();
  const double* matrices = nullptr;
  std::uint32_t count = 0;
  EXPECT_DONE(sunder_get_pose(twins.c_scene, twins.c_id, &matrices, &count));
  EXPECT_EQ(count, 6u);
  EXPECT_EQ(0, std::memcmp(matrices, pose.model_from_bone[0].data(), 6 * 96));
  EXPECT_EQ(sunder_set_matrices(twins.c_scene, twins.c_id, matrices, 5, nullptr),
            SUNDER_SIZE_MISMATCH);
}

void run_backwards(void* context, std::uint32_t count, sunder_task task, const void* work) {
  ++*static_cast<int*>(context);
  for (std::uint32_t i = count; i-- > 0;) task(work, i);
}
void run_now(void* context, void (*task)(void*), void* data) {
  ++*static_cast<int*>(context);
  task(data);
}

TEST(CFrame, hooks_are_called) {
  int parallel = 0, background = 0;
  sunder_scene_options options = sunder_default_scene_options();
  options.parallel_for = run_backwards;
  options.parallel_context = &parallel;
  options.parallel_threads = 4;
  options.background = run_now;
  options.background_context = &background;
  options.background_updates = 1;
  const sunder_character character = create(make_tube(40, 30, 6));
  sunder_asset asset = 0;
  sunder_scene scene = 0;
  sunder_instance id = 0;
  EXPECT_DONE(sunder_create_asset(character, nullptr, &asset));
  EXPECT_DONE(sunder_create_scene(&options, &scene));
  for (int i = 0; i < 40; ++i) {
    EXPECT_DONE(sunder_spawn(scene, asset, nullptr, &id));
    EXPECT_DONE(sunder_play(scene, id, 0, nullptr, nullptr));
  }
  EXPECT_DONE(sunder_update(scene, 0.1));
  sunder_cut cut = sunder_default_cut();
  EXPECT_DONE(sunder_submit_cut(scene, id, &cut, SUNDER_IN_BACKGROUND, nullptr));
  for (int i = 0; i < 4; ++i) EXPECT_DONE(sunder_update(scene, 0.1));
  EXPECT_GT(parallel, 0);
  EXPECT_GT(background, 0);
  std::uint64_t digest = 0;
  EXPECT_DONE(sunder_get_digest(scene, id, &digest));
  EXPECT_NE(digest, 0u);
  EXPECT_DONE(sunder_destroy_scene(scene));
  EXPECT_DONE(sunder_destroy_asset(asset));
  EXPECT_DONE(sunder_destroy_character(character));
}

TEST(CFrame, a_full_model_of_fixed_capacity_says_so) {
  const sunder_character character = create(make_tube(24, 12, 6));
  sunder_asset asset = 0;
  sunder_scene scene = 0;
  sunder_instance id = 0;
  EXPECT_DONE(sunder_create_asset(character, nullptr, &asset));
  EXPECT_DONE(sunder_create_scene(nullptr, &scene));
  sunder_spawn_options options = sunder_default_spawn_options();
  options.vertices = 2;
  options.triangles = 2;
  options.operations = 1;
  EXPECT_DONE(sunder_spawn(scene, asset, &options, &id));
  sunder_cut cut = sunder_default_cut();
  EXPECT_DONE(sunder_submit_cut(scene, id, &cut, 0, nullptr));
  EXPECT_DONE(sunder_update(scene, 0.1));
  const sunder_result* results = nullptr;
  std::uint32_t count = 0;
  EXPECT_DONE(sunder_get_results(scene, &results, &count));
  ASSERT_EQ(count, 1u);
  EXPECT_EQ(results[0].status, SUNDER_CAPACITY_EXCEEDED);
  EXPECT_DONE(sunder_destroy_scene(scene));
  EXPECT_DONE(sunder_destroy_asset(asset));
  EXPECT_DONE(sunder_destroy_character(character));
}

TEST(CFrame, a_warm_frame_does_not_allocate) {
  if (!has_allocator()) GTEST_SKIP() << "this build has no allocator hook";
  CountedMemory memory;
  memory.use();
  Random random(1);
  Twins twins(make_tube(24, 12, 6));
  for (int i = 0; i < 4; ++i) {
    twins.update();
    submit_random(twins, random);
  }
  const auto frame = [&] {
    EXPECT_EQ(sunder_update(twins.c_scene, 1.0 / 64), SUNDER_OK);
    const sunder_result* results = nullptr;
    std::uint32_t count = 0;
    EXPECT_EQ(sunder_get_results(twins.c_scene, &results, &count), SUNDER_OK);
    sunder_posed_mesh mesh = {};
    mesh.struct_size = sizeof mesh;
    EXPECT_EQ(sunder_get_posed_mesh(twins.c_scene, twins.c_id, 0, 0, &mesh), SUNDER_OK);
    sunder_mesh torn = {};
    EXPECT_EQ(sunder_get_instance_mesh(twins.c_scene, twins.c_id, 0, &torn), SUNDER_OK);
    const sunder_instance* drawn = nullptr;
    EXPECT_EQ(sunder_get_drawn(twins.c_scene, &drawn, &count), SUNDER_OK);
    EXPECT_EQ(count, 1u);
  };
  for (int i = 0; i < 120; ++i) frame();
  const std::uint64_t before = memory.calls;
  EXPECT_GT(before, 100u);
  for (int i = 0; i < 20; ++i) frame();
  EXPECT_EQ(memory.calls, before);
}

TEST(CFrame, without_memory_calls_fail_and_change_nothing) {
  if (!has_allocator()) GTEST_SKIP() << "this build has no allocator hook";
  CountedMemory memory;
  memory.use();
  const Character character = rich_character();
  const CArrays arrays(character);
  int failed = 0;
  const auto starve = [&](const auto& call) {
    for (std::uint64_t count = 0;; count = count < 40 ? count + 1 : count * 5 / 4) {
      memory.left = count;
      const sunder_status status = call();
      memory.left = ~std::uint64_t{0};
      if (status == SUNDER_OK) return;
      EXPECT_EQ(status, SUNDER_LIMIT_EXCEEDED) << sunder_last_error();
      ++failed;
    }
  };
  sunder_character handle = 0;
  sunder_asset asset = 0;
  sunder_scene scene = 0;
  sunder_instance id = 0;
  sunder_bytes bytes = 0;
  starve([&] { return sunder_create_character(&arrays.data, &handle); });
  starve([&] { return sunder_create_asset(handle, nullptr, &asset); });
  sunder_scene_options options = sunder_default_scene_options();
  options.threads = 1;
  starve([&] { return sunder_create_scene(&options, &scene); });
  starve([&] { return sunder_spawn(scene, asset, nullptr, &id); });
  sunder_cut cut = sunder_default_cut();
  starve([&] { return sunder_submit_cut(scene, id, &cut, 0, nullptr); });
  starve([&] { return sunder_update(scene, 0.1); });
  starve([&] { return sunder_save_scene(scene, &bytes); });
  EXPECT_GT(failed, 50);
  EXPECT_DONE(sunder_destroy_scene(scene));
}

TEST(CFrame, vertices_are_posed_into_memory_of_the_program) {
  Twins twins(make_tube(24, 12, 6), false);
  twins.update();
  const std::uint32_t vertices = posed_mesh(twins.c_scene, twins.c_id, 0).vertex_count;
  std::vector<float> buffer(8 * vertices, -1.0f);
  sunder_vertex_target target = sunder_default_vertex_target();
  target.vertex_count = vertices;
  target.positions = buffer.data();
  target.normals = buffer.data() + 4;
  target.position_stride = target.normal_stride = 32;
  EXPECT_DONE(sunder_set_vertex_target(twins.c_scene, twins.c_id, 0, &target));
  twins.update();
  const PosedMesh expected = twins.scene->mesh(twins.id, 0);
  for (std::uint32_t v = 0; v < vertices; ++v) {
    EXPECT_EQ(0, std::memcmp(&buffer[8 * v], expected.positions[v].data(), 12));
    EXPECT_EQ(0, std::memcmp(&buffer[8 * v + 4], expected.normals[v].data(), 12));
    EXPECT_EQ(buffer[8 * v + 3], -1.0f);
  }
}

}  // namespace
}  // namespace sunder::test
