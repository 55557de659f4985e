#include <cstring>

#include "particles/frequency_of.h"
#include "particles/soft_scene.h"

namespace sunder {
namespace {

using test::SoftScene;

/// Greatest distance between two neighbours, relative to that at rest.
double worst_stretch(const SoftScene& scene) {
  double worst = 0;
  for (std::uint32_t p = 0; p < scene.count(); ++p)
    for (const ParticleNeighbour& neighbour : scene.set->neighbours(p)) {
      const Vec3d at_rest =
          (scene.body->place(p) - scene.body->displacement(p)) -
          (scene.body->place(neighbour.particle) - scene.body->displacement(neighbour.particle));
      worst =
          std::max(worst, (scene.body->place(p) - scene.body->place(neighbour.particle)).norm() /
                              at_rest.norm());
    }
  return worst;
}

SoftMaterial soft_material(double limit) {
  SoftMaterial material;
  material.return_frequency = test::frequency_of(40);
  material.membrane_stiffness = 2;
  material.stretch_limit = limit;
  return material;
}

TEST(stretch_limit, keeps_neighbours_together) {
  double stretch[2];
  for (const bool is_limited : {false, true}) {
    SoftScene scene(test::make_tube(60, 16, 6), soft_material(is_limited ? 1.3 : 0.0), 0.1);
    const std::uint32_t p = scene.nearest({0.5, 3, 0});
    ASSERT_TRUE(scene.body->set_force(p, {150 * scene.body->mass(p), 0, 0}));
    double worst = 0;
    for (int i = 0; i < 240; ++i) {
      scene.step(1.0 / 60);
      worst = std::max(worst, worst_stretch(scene));
    }
    stretch[is_limited ? 1 : 0] = worst;
    ASSERT_TRUE(scene.body->set_force(p, Vec3d::Zero()));
    scene.run(6);
    EXPECT_EQ(scene.farthest(), 0);
  }
  EXPECT_GT(stretch[0], 1.5);
  EXPECT_LT(stretch[1], 1.3 * 1.01);
}

TEST(stretch_limit, tissue_held_at_its_limit_falls_asleep) {
  for (const double limit : {1.1, 1.3, 1.6})
    for (const double range : {0.06, 0.1, 0.15}) {
      SoftScene scene(test::make_tube(60, 16, 6), soft_material(limit), range);
      const std::uint32_t p = scene.nearest({0.5, 3, 0});
      ASSERT_TRUE(scene.body->set_force(p, {150 * scene.body->mass(p), 0, 0}));
      scene.run(16);
      EXPECT_GT(worst_stretch(scene), limit * 0.98);
      EXPECT_EQ(scene.body->awake_count(), 0u) << limit << " " << range;
      ASSERT_TRUE(scene.body->set_force(p, Vec3d::Zero()));
      scene.run(6);
      EXPECT_EQ(scene.farthest(), 0);
    }
}

TEST(stretch_limit, changes_no_bit_if_it_is_not_reached) {
  std::vector<double> found[2];
  for (const bool is_limited : {false, true}) {
    SoftScene scene(test::make_tube(60, 16, 6), soft_material(is_limited ? 3.0 : 0.0), 0.1);
    ASSERT_TRUE(scene.body->add_impulse(8, {0.01, 0.01, 0}));
    for (int i = 0; i < 100; ++i) {
      scene.step(1.0 / 60);
      for (std::uint32_t p = 0; p < scene.count(); ++p)
        for (const double x : {scene.body->displacement(p).x(), scene.body->velocity(p).y()})
          found[is_limited ? 1 : 0].push_back(x);
    }
  }
  EXPECT_EQ(std::memcmp(found[0].data(), found[1].data(), found[0].size() * sizeof(double)), 0);
}

TEST(stretch_limit, adds_no_momentum) {
  SoftMaterial material = soft_material(1.05);
  material.return_frequency = 0;
  SoftScene scene(test::make_bumpy_ball(800), material, 0.15);
  ASSERT_TRUE(scene.body->add_impulse(4, {0.02, 0, 0}));
  for (std::uint32_t p = 0; p < scene.count(); ++p)
    ASSERT_TRUE(scene.body->add_impulse(p, {0, 1e-6, 0}));  // all awake
  const auto momentum = [&] {
    Vec3d sum = Vec3d::Zero();
    for (std::uint32_t p = 0; p < scene.count(); ++p)
      sum += scene.body->mass(p) * scene.body->velocity(p);
    return sum;
  };
  const Vec3d before = momentum();
  for (int i = 0; i < 20; ++i) scene.step(1.0 / 120);
  EXPECT_LT((momentum() - before).norm(), 1e-6 * before.norm());
}

}  // namespace
}  // namespace sunder
