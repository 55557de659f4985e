// Tissue follows welds: what a tear separated moves together again.

#include "particles/soft_scene.h"
#include "support/models/random_operations.h"
#include "support/oracles/particle_laws.h"

namespace sunder {
namespace {

using test::Random;
using test::SoftScene;

void follow(SoftScene& scene, const ChangeRecord& change) {
  ASSERT_TRUE(scene.set->follow(*scene.model, {&change, 1}));
}

void expect_laws(const SoftScene& scene) {
  for (const auto& faults : {test::broken_particles(*scene.model, *scene.set),
                             test::broken_pieces(*scene.model, *scene.set),
                             test::broken_lip_edges(*scene.model, *scene.set)})
    EXPECT_TRUE(faults.empty()) << faults.size() << " faults: " << faults.front();
}

TEST(WeldedTissue, KeepsTheLawsOfParticles) {
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    SCOPED_TRACE(seed);
    Random random(seed);
    SoftScene scene(test::random_character(random));
    for (int i = 0; i < 4; ++i) {
      ChangeRecord change;
      const bool is_weld = i % 2 == 1;
      const auto report =
          is_weld
              ? scene.model->weld(test::random_pose(*scene.character, random), {}, &change)
              : test::play(*scene.model, test::random_tear(*scene.model, random, false), &change);
      ASSERT_TRUE(report) << report.error().text();
      if (report->runs == 0) continue;
      follow(scene, change);
      expect_laws(scene);
      const auto before = test::state_of(*scene.model, *scene.set, scene.pose);
      ChangeRecord back, again;
      ASSERT_TRUE(scene.model->undo(&back));
      follow(scene, back);
      expect_laws(scene);
      ASSERT_TRUE(scene.model->redo(&again));
      follow(scene, again);
      EXPECT_EQ(test::difference(before, test::state_of(*scene.model, *scene.set, scene.pose)), "");
      scene.run(0.1);
      while (scene.set->settle(*scene.model, 200)) {
      }
      expect_laws(scene);
    }
  }
}

TEST(WeldedTissue, NoLongerGapes) {
  SoftScene scene(test::make_sheet(20), *find_material("skin"), 0.06);
  ASSERT_TRUE(scene.body->set_tension({50, {}, false, {}}));
  ChangeRecord change;
  ASSERT_TRUE(scene.model->tear(
      scene.pose, Stroke{test::down_at(0.2, 0.51), test::down_at(0.8, 0.51)}, {}, &change));
  follow(scene, change);
  scene.run(2);
  const double open = scene.farthest();
  EXPECT_GT(open, 1e-3);
  ChangeRecord closed;
  ASSERT_TRUE(scene.model->weld(scene.pose, {}, &closed));
  follow(scene, closed);
  scene.run(2);
  EXPECT_LT(scene.farthest(), 0.02 * open);
}

}  // namespace
}  // namespace sunder
