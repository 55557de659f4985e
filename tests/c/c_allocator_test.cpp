// Memory that a C program gives.

#include "c/c_twins.h"
#include "c/counted_memory.h"

namespace sunder::test {
namespace {

/// The digest of a model that was torn by a few commands, of which one in the background.
std::uint64_t torn_digest(const Character& character) {
  sunder_asset_options options = sunder_default_asset_options();
  options.is_soft = 1;
  sunder_scene_options of_scene = sunder_default_scene_options();
  of_scene.threads = 2;
  of_scene.background_updates = 2;
  const sunder_character source = create(character);
  sunder_asset asset = 0;
  sunder_scene scene = 0;
  sunder_instance who = 0;
  EXPECT_DONE(sunder_create_asset(source, &options, &asset));
  EXPECT_DONE(sunder_create_scene(&of_scene, &scene));
  EXPECT_DONE(sunder_spawn(scene, asset, nullptr, &who));
  EXPECT_DONE(sunder_play(scene, who, 0, nullptr, nullptr));
  EXPECT_DONE(sunder_update(scene, 1.0 / 64));
  const sunder_blade stroke[2] = {{{-1, 0.35, 0.05}, {1, 0.35, 0.05}},
                                  {{-1, 0.65, 0.05}, {1, 0.65, 0.05}}};
  sunder_tear_options tear = sunder_default_tear_options();
  tear.width = 0.01;
  tear.wall_depth = 0.02;
  EXPECT_DONE(sunder_submit_tear(scene, who, stroke, 2, &tear, 0, nullptr));
  EXPECT_DONE(sunder_update(scene, 1.0 / 64));
  sunder_cut cut = sunder_default_cut();
  cut.point[1] = 0.8;
  cut.normal[1] = 1;
  cut.has_caps = 1;
  EXPECT_DONE(sunder_submit_cut(scene, who, &cut, SUNDER_IN_BACKGROUND, nullptr));
  for (int frame = 0; frame < 30; ++frame) EXPECT_DONE(sunder_update(scene, 1.0 / 64));
  sunder_bytes glb = 0;
  EXPECT_DONE(sunder_save_instance(scene, who, nullptr, &glb));
  EXPECT_DONE(sunder_destroy_bytes(glb));
  std::uint64_t digest = 0;
  EXPECT_DONE(sunder_get_digest(scene, who, &digest));
  EXPECT_DONE(sunder_destroy_scene(scene));
  EXPECT_DONE(sunder_destroy_asset(asset));
  EXPECT_DONE(sunder_destroy_character(source));
  return digest;
}

TEST(CAllocator, gives_all_memory_and_gets_it_back) {
  if (!has_allocator()) GTEST_SKIP() << "this build has no allocator hook";
  const Character character = make_tube(24, 12, 6);
  const std::uint64_t expected = torn_digest(character);
  CountedMemory memory;
  memory.use();
  EXPECT_EQ(torn_digest(character), expected);
  EXPECT_GT(memory.calls, 500u);
  EXPECT_EQ(memory.live(), 0u);
  EXPECT_EQ(memory.bytes(), 0u);
}

TEST(CAllocator, of_a_scene_is_that_with_which_it_was_created) {
  if (!has_allocator()) GTEST_SKIP() << "this build has no allocator hook";
  CountedMemory first, second;
  first.use();
  {
    Twins twins(make_tube(24, 12, 6));
    twins.update();
    const std::uint64_t before = first.calls;
    second.use();
    Random random(3);
    for (int i = 0; i < 10; ++i) {
      submit_random(twins, random);
      twins.update();
    }
    twins.expect_same();
    EXPECT_GT(first.calls, before);
  }
  EXPECT_EQ(first.live(), 0u) << "blocks go back to where they came from";
}

TEST(CAllocator, without_memory_calls_fail_and_change_nothing) {
  if (!has_allocator()) GTEST_SKIP() << "this build has no allocator hook";
  CountedMemory memory;
  const Character character = make_tube(24, 12, 6);
  const sunder_character source = create(character);
  memory.use();
  std::size_t failed = 0, done = 0;
  for (std::uint64_t left = 0; done == 0; left += 1 + left / 8) {
    memory.left = left;
    sunder_asset asset = 7;
    const sunder_status status = sunder_create_asset(source, nullptr, &asset);
    memory.left = ~std::uint64_t{0};
    if (status == SUNDER_OK) {
      ++done;
      EXPECT_DONE(sunder_destroy_asset(asset));
      continue;
    }
    ++failed;
    EXPECT_EQ(status, SUNDER_LIMIT_EXCEEDED) << sunder_last_error();
    EXPECT_EQ(asset, 7u);
    EXPECT_EQ(memory.live(), 0u);
  }
  EXPECT_GT(failed, 5u);
  EXPECT_DONE(sunder_destroy_character(source));
}

TEST(CAllocator, refuses_half_a_pair) {
  const sunder_allocate allocate = [](void*, std::uint64_t, std::uint64_t) -> void* {
    return nullptr;
  };
  EXPECT_EQ(sunder_set_allocator(allocate, nullptr, nullptr),
            has_allocator() ? SUNDER_NULL_POINTER : SUNDER_UNSUPPORTED_FEATURE);
}

}  // namespace
}  // namespace sunder::test
