// The vertices that displaced particles move are those that a scan of all triangles finds.

#include <sunder/particles/soft_body.h>

#include <vector>

#include "particles/soft_scene.h"
#include "support/models/random_operations.h"
#include "tear/internal/surface.h"

namespace sunder {
namespace {

using test::Random;
using test::SoftScene;

bool is_displaced(const SoftScene& scene, std::uint32_t point) {
  const ParticleInfluences& of = scene.set->influences()[point];
  for (std::size_t k = 0; k < 4 && of.weights[k] > 0; ++k)
    if (scene.body->displacement(of.particles[k]) != Vec3d::Zero()) return true;
  return false;
}

/// Per vertex of a mesh, by its definition.
std::vector<bool> scan(const SoftScene& scene, std::uint32_t mesh) {
  const tear::Surface& surface = scene.model->surface();
  const Mesh& of = scene.model->character().meshes[mesh];
  std::vector<bool> moved(of.vertex_count(), false);
  for (std::uint32_t t = 0; t < surface.triangle_count(); ++t) {
    const tear::TriangleRef ref = surface.triangle(t);
    if (ref.mesh != mesh || surface.has_repeated_point(t)) continue;
    for (std::uint32_t k = 0; k < 3; ++k)
      if (is_displaced(scene, surface.corner_point[3 * t + k]))
        moved[of.triangles[ref.triangle][k]] = true;
  }
  return moved;
}

void expect_moved_as_scanned(SoftScene& scene) {
  (void)scene.body->displacements();  // follows the set
  for (std::uint32_t mesh = 0; mesh < scene.character->meshes.size(); ++mesh) {
    std::vector<IndexRange> wanted;
    const std::vector<bool> moved = scan(scene, mesh);
    for (std::uint32_t v = 0; v < moved.size(); ++v) {
      if (!moved[v]) continue;
      if (v > 0 && moved[v - 1])
        ++wanted.back().count;
      else
        wanted.push_back({v, 1});
    }
    const auto found = scene.body->moved_vertices(*scene.model, mesh);
    ASSERT_EQ(std::vector<IndexRange>(found.begin(), found.end()), wanted) << "mesh " << mesh;
  }
}

/// One random call: an operation, undo, redo, a push, or steps.
void act_and_move(SoftScene& scene, Random& random) {
  ChangeRecord change;
  bool is_changed = false;
  switch (random.index(6)) {
    case 0:
      if (scene.model->undo_count() < 6)
        is_changed =
            bool(test::play(*scene.model, test::random_operation(*scene.model, random), &change));
      break;
    case 1: is_changed = bool(scene.model->undo(&change)); break;
    case 2: is_changed = bool(scene.model->redo(&change)); break;
    case 3:
      ASSERT_TRUE(scene.body->add_impulse(random.index(scene.set->particle_count()),
                                          0.01 * random.direction()));
      break;
    case 4: scene.run(random.index(4) == 0 ? 4.0 : 0.05); break;  // the long one puts to sleep
    default: (void)scene.set->settle(*scene.model, 20); break;
  }
  if (is_changed) {
    ASSERT_TRUE(scene.set->follow(*scene.model, {&change, 1}));
  }
}

void play_random_calls(SoftScene& scene, Random& random, int calls) {
  for (int i = 0; i < calls; ++i) {
    ASSERT_NO_FATAL_FAILURE(act_and_move(scene, random));
    if (random.index(3) == 0) continue;
    ASSERT_NO_FATAL_FAILURE(expect_moved_as_scanned(scene));
  }
  ASSERT_NO_FATAL_FAILURE(expect_moved_as_scanned(scene));
}

TEST(moved_vertices, are_those_of_a_scan_after_random_calls) {
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    SCOPED_TRACE(seed);
    Random random(seed);
    SoftScene scene(test::random_character(random), {}, seed % 2 == 0 ? 0.1 : 0.03);
    ASSERT_NO_FATAL_FAILURE(play_random_calls(scene, random, 30));
  }
}

TEST(moved_vertices, are_those_of_a_scan_on_several_meshes) {
  for (std::uint64_t seed = 0; seed < 8; ++seed) {
    SCOPED_TRACE(seed);
    Random random(seed);
    SoftScene scene(test::make_two_tubes(8, 9), {}, 0.08);
    ASSERT_NO_FATAL_FAILURE(play_random_calls(scene, random, 40));
  }
}

/// A renderer that asks rarely reads a long journal, or misses a part of it.
TEST(moved_vertices, are_those_of_a_scan_after_many_unseen_calls) {
  Random random(7);
  SoftScene scene(test::make_sheet(12), {}, 0.2);
  ASSERT_TRUE(scene.body->add_impulse(0, {0, 0, 0.1}));
  scene.step(0.01);
  ASSERT_NO_FATAL_FAILURE(expect_moved_as_scanned(scene));
  for (int round = 0; round < 5; ++round) {
    for (int i = 0; i < 150; ++i) {
      ChangeRecord change;
      if (!test::play(*scene.model, test::random_operation(*scene.model, random), &change))
        continue;
      ASSERT_TRUE(scene.set->follow(*scene.model, {&change, 1}));
      if (!scene.model->undo(&change)) continue;
      ASSERT_TRUE(scene.set->follow(*scene.model, {&change, 1}));
    }
    ASSERT_NO_FATAL_FAILURE(expect_moved_as_scanned(scene));
  }
}

}  // namespace
}  // namespace sunder
