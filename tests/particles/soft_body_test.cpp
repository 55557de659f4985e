#include <sunder/particles/soft_body.h>

#include <chrono>
#include <cstring>
#include <limits>

#include "particles/frequency_of.h"
#include "particles/soft_scene.h"
#include "support/machine/allocation_count.h"

namespace sunder {
namespace {

using test::SoftScene;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
const Vec3d kDown(0, -9.81, 0);

SoftScene make_tube_scene(const SoftMaterial& material = {}, const SoftBodyOptions& options = {}) {
  return SoftScene(test::make_tube(60, 16, 6), material, 0.1, options);
}

/// All results of a body, as bits.
std::vector<double> bits_of(const SoftScene& scene) {
  std::vector<double> bits;
  for (std::uint32_t p = 0; p < scene.count(); ++p) {
    for (const Vec3d& v :
         {scene.body->displacement(p), scene.body->velocity(p), scene.body->place(p)})
      bits.insert(bits.end(), {v.x(), v.y(), v.z()});
    bits.push_back(scene.body->is_awake(p) ? 1 : 0);
  }
  for (const Vec4f& d : scene.body->displacements())
    bits.insert(bits.end(), {double{d.x()}, double{d.y()}, double{d.z()}, double{d.w()}});
  return bits;
}

Quatd random_body_turn(test::Random& random) {
  return Quatd(Eigen::AngleAxisd{random.uniform(-3, 3), random.direction()});
}

Vec3d momentum(const SoftScene& scene) {
  Vec3d sum = Vec3d::Zero();
  for (std::uint32_t p = 0; p < scene.count(); ++p)
    sum += scene.body->mass(p) * scene.body->velocity(p);
  return sum;
}

TEST(soft_body, begins_at_rest_and_stays_there) {
  SoftScene scene = make_tube_scene();
  ASSERT_GT(scene.count(), 20u);
  EXPECT_EQ(scene.body->awake_count(), 0u);
  scene.run(1);
  EXPECT_EQ(scene.farthest(), 0);
  EXPECT_EQ(scene.body->displacements().size(), scene.count());
  EXPECT_TRUE(scene.body->moved_vertices(*scene.model, 0).empty());
}

TEST(soft_body, the_largest_impulse_leaves_a_state_that_can_be_saved_and_restored) {
  SoftScene scene = make_tube_scene();
  const Vec3d largest(0, 0, 0.99e9 * scene.body->mass(3));
  ASSERT_TRUE(scene.body->add_impulse(3, largest));
  EXPECT_EQ(scene.body->add_impulse(3, largest).code(), StatusCode::invalid_argument);
  scene.run(0.5);
  for (std::uint32_t p = 0; p < scene.count(); ++p)
    EXPECT_TRUE(scene.body->displacement(p).allFinite()) << p;
  const auto saved = scene.body->save();
  ASSERT_TRUE(saved) << saved.error().text();
  const Status status = scene.body->restore(*saved);
  EXPECT_TRUE(status) << status.text();
}

TEST(soft_body, an_impulse_is_its_momentum) {
  for (const double seconds : {0.0, 1e-9}) {
    SoftScene scene = make_tube_scene();
    const Vec3d impulse(0.01, -0.02, 0.005), other(-0.003, 0, 0.001);
    EXPECT_TRUE(scene.body->add_impulse(3, impulse));
    EXPECT_TRUE(scene.body->add_point_impulse(40, other));
    scene.step(seconds);
    EXPECT_LT((momentum(scene) - impulse - other).norm(), 1e-6 * impulse.norm());
  }
}

TEST(soft_body, rings_down_to_exactly_nothing) {
  SoftScene scene = make_tube_scene();
  ASSERT_TRUE(scene.body->add_point_impulse(100, {0.02, 0, 0.01}));
  scene.run(0.1);
  EXPECT_GT(scene.farthest(), 1e-3);
  EXPECT_FALSE(scene.body->moved_vertices(*scene.model, 0).empty());
  scene.run(6);
  EXPECT_EQ(scene.body->awake_count(), 0u);
  EXPECT_EQ(scene.farthest(), 0);
  for (const Vec4f& d : scene.body->displacements()) EXPECT_EQ(d, Vec4f::Zero());
  EXPECT_TRUE(scene.body->moved_vertices(*scene.model, 0).empty());
}

TEST(soft_body, a_slow_pull_never_falls_asleep) {
  SoftScene scene(test::make_tube(60, 16, 6), {}, 0.1);
  const std::uint32_t p = scene.nearest({0.5, 3, 0});
  const Vec3d from = scene.body->place(p);
  const auto hold = scene.body->hold(p, from);
  ASSERT_TRUE(hold);
  scene.run(3);  // long enough to be patient no more
  for (int i = 1; i <= 1200; ++i) {
    // Half of what particles in contact may tremble in half a second.
    const Vec3d target = from + Vec3d(1e-4 * scene.set->range(p) * i, 0, 0);
    ASSERT_TRUE(scene.body->move_hold(*hold, target));
    scene.step(1.0 / 60);
    ASSERT_LT((scene.body->place(p) - target).norm(), 1e-3 * scene.set->range(p)) << i;
  }
}

TEST(soft_body, sags_by_gravity_over_stiffness) {
  SoftMaterial material;
  material.return_frequency = test::frequency_of(500);
  SoftScene scene = make_tube_scene(material);
  ASSERT_TRUE(scene.body->set_gravity(kDown));
  scene.run(4);
  for (std::uint32_t p = 0; p < scene.count(); ++p)
    EXPECT_LT((scene.body->displacement(p) - kDown / 500).norm(), 1e-3 * 9.81 / 500);
  EXPECT_EQ(scene.body->awake_count(), 0u);
  ASSERT_TRUE(scene.body->set_gravity(Vec3d::Zero()));
  EXPECT_EQ(scene.body->awake_count(), scene.count());
  scene.run(4);
  EXPECT_EQ(scene.farthest(), 0);
}

TEST(soft_body, a_uniform_body_moves_the_same_by_any_step) {
  // Neighbours that move alike do not pull: every particle follows the closed form.
  for (const double ratio : {0.05, 1.0, 3.0}) {
    SoftMaterial material;
    material.return_frequency = test::frequency_of(100);
    material.damping_ratio = ratio;
    std::vector<Vec3d> found;
    for (const double seconds : {1e-4, 1e-3, 1e-2, 0.1, 1.0}) {
      SoftScene scene(test::make_sheet(6), material, 0.3);
      ASSERT_TRUE(scene.body->set_gravity(kDown));
      scene.run(1, seconds);
      found.push_back(scene.body->displacement(0));
    }
    for (const Vec3d& u : found) EXPECT_LT((u - found[0]).norm(), 1e-4 * 9.81 / 100) << ratio;
  }
}

TEST(soft_body, is_stable_at_any_step_and_stiffness) {
  test::Random random(11);
  for (int trial = 0; trial < 60; ++trial) {
    std::vector<SoftMaterial> materials(3);
    for (SoftMaterial& m : materials) {
      m.return_frequency = test::frequency_of(std::pow(10, random.uniform(-3, 12)));
      m.membrane_stiffness = std::pow(10, random.uniform(-3, 12));
      m.membrane_damping = std::pow(10, random.uniform(-3, 6));
      m.damping_ratio = random.uniform(0.1, 2);
      m.areal_density = std::pow(10, random.uniform(-3, 0));
    }
    SoftScene scene(test::make_bumpy_ball(600), materials, 0.15, {});
    for (std::uint32_t p = 0; p < scene.count(); ++p)
      ASSERT_TRUE(scene.body->set_material(p, random.index(3)));
    const double h = std::pow(10, random.uniform(-5, 0));
    const auto held = scene.body->hold_point(5, {1, 2, 3}, {std::pow(10, random.uniform(-2, 12))});
    ASSERT_TRUE(held);
    for (int i = 0; i < 60; ++i) {
      scene.step(h);
      ASSERT_LT(scene.farthest(), 400)
          << trial;  // a soft particle with a small weight moves far for a point
    }
    ASSERT_TRUE(scene.body->release(*held));
    for (int i = 0; i < 60; ++i) {
      scene.step(h);
      ASSERT_LT(scene.farthest(), 400)
          << trial;  // a soft particle with a small weight moves far for a point
    }
  }
}

TEST(soft_body, undamped_tissue_survives_steps_of_whole_periods) {
  for (const double frequency : {1.0, 3.2, 60.0})
    for (const double periods : {1.0, 3.0, 16.0, 600.0}) {
      SoftMaterial material;
      material.return_frequency = frequency;
      material.damping_ratio = 0;
      SoftScene scene(test::make_tube(8, 6, 2), material, 0.3);
      ASSERT_TRUE(scene.body->add_impulse(0, {1e-3, 0, 0}));
      ASSERT_TRUE(scene.body->hold_point(5, {0.3, 0, 0}));
      for (int i = 0; i < 4; ++i) scene.step(periods / frequency);
      EXPECT_LT(scene.farthest(), 10) << frequency << " Hz, " << periods << " periods";
    }
}

TEST(soft_body, a_hold_brings_a_point_to_its_target) {
  for (const double seconds : {1e-3, 1.0 / 60, 0.5}) {
    SoftScene scene = make_tube_scene();
    const std::uint32_t point = 200;
    const Vec3d start = scene.set->positions()[point].cast<double>(),
                target = start + Vec3d(0.2, 0.05, 0);
    const auto hold = scene.body->hold_point(point, target);
    ASSERT_TRUE(hold);
    const auto place = [&] { return Vec3d(start + scene.body->point_displacement(point)); };
    for (int i = 0; i < 400; ++i) scene.step(seconds);
    EXPECT_LT((place() - target).norm(), 2e-3) << seconds;
    EXPECT_EQ(scene.body->awake_count() == 0, seconds > 0.01);  // it sleeps while it is held
    ASSERT_TRUE(scene.body->move_hold(*hold, start + Vec3d(0, 0, 0.1)));
    for (int i = 0; i < 400; ++i) scene.step(seconds);
    EXPECT_LT((place() - start - Vec3d(0, 0, 0.1)).norm(), 2e-3);
    ASSERT_TRUE(scene.body->release(*hold));
    EXPECT_EQ(scene.body->release(*hold).code(), StatusCode::not_found);
    EXPECT_EQ(scene.body->move_hold(*hold, target).code(), StatusCode::not_found);
    for (int i = 0; i < 400 || seconds * i < 8; ++i) scene.step(seconds);
    EXPECT_EQ(scene.farthest(), 0);
  }
}

TEST(soft_body, a_hold_of_a_particle_stays_in_the_room) {
  SoftScene scene = make_tube_scene();
  const std::uint32_t particle = scene.nearest({0.5, 3, 0});
  const Vec3d target = scene.body->place(particle) + Vec3d(0.1, 0, 0);
  ASSERT_TRUE(scene.body->hold(particle, target));
  scene.run(1);
  EXPECT_LT((scene.body->place(particle) - target).norm(), 1e-3);
  scene.pose = test::moved(scene.pose, test::shift_by({0, 0.05, 0}));
  scene.run(1);
  EXPECT_LT((scene.body->place(particle) - target).norm(), 1e-3);
}

TEST(soft_body, wind_pushes_where_it_blows) {
  SoftScene scene = make_tube_scene();
  ASSERT_TRUE(scene.body->set_wind(
      [](const Vec3d& place, double) { return place.y() > 4 ? Vec3d(20, 0, 0) : Vec3d::Zero(); }));
  scene.run(2);
  EXPECT_GT(scene.body->displacement(scene.nearest({0, 5.5, 0})).x(), 0.03);
  EXPECT_EQ(scene.body->displacement(scene.nearest({0, 0.5, 0})), Vec3d::Zero());
  ASSERT_TRUE(scene.body->set_wind({}));
  scene.run(5);
  EXPECT_EQ(scene.farthest(), 0);
}

TEST(soft_body, a_gust_wakes_sleeping_particles_and_invalid_wind_counts_as_none) {
  SoftScene scene = make_tube_scene();
  ASSERT_TRUE(scene.body->set_wind([](const Vec3d&, double seconds) {
    return seconds > 1 ? Vec3d(0, 0, 5) : Vec3d(kNaN, 0, 0);
  }));
  scene.run(0.9);
  EXPECT_EQ(scene.body->awake_count(), 0u);
  scene.run(0.5);
  EXPECT_EQ(scene.body->awake_count(), scene.count());
}

TEST(soft_body, rides_with_the_pose) {
  SoftScene scene = make_tube_scene();
  const ModelPose start = scene.pose;
  SoftMaterial none;
  none.return_frequency = none.membrane_stiffness = 0;
  none.damping_ratio = 0;
  ASSERT_TRUE(scene.body->change_material(0, none));
  ASSERT_TRUE(scene.body->add_impulse(5, {0.1 * scene.body->mass(5), 0, 0}));
  scene.run(0.5);
  const Vec3d before = scene.body->displacement(5);
  ASSERT_NEAR(before.x(), 0.05, 1e-6);
  const Affine3d turn = test::turn_by(0.7, Vec3d(1, 2, 3).normalized());
  scene.pose = test::moved(start, turn);
  scene.step(1e-9);
  EXPECT_LT((scene.body->displacement(5) - turn.linear() * before).norm(), 1e-6);
  EXPECT_LT((scene.body->rotations()[5].cast<double>() - turn.linear()).norm(), 1e-5);
}

TEST(soft_body, lags_behind_the_pose) {
  SoftBodyOptions options;
  options.follow = Follow::lag;
  SoftScene scene = make_tube_scene({}, options);
  scene.step(0.01);
  const Vec3d before = scene.body->place(7);
  scene.pose = test::moved(scene.pose, test::shift_by({0.5, 0, 0}));
  scene.step(0);
  // in a step of zero seconds it does not move
  EXPECT_LT((scene.body->place(7) - before).norm(), 1e-7);
  EXPECT_NEAR(scene.body->displacement(7).x(), -0.5, 1e-7);
  scene.run(6);
  EXPECT_EQ(scene.farthest(), 0);
  EXPECT_EQ(scene.body->awake_count(), 0u);
}

TEST(soft_body, lag_does_not_depend_on_the_step) {
  // The rest moves at constant speed, then stops: an oscillator in a frame that moves with it, and
  // one in a fixed frame.
  SoftBodyOptions options;
  options.follow = Follow::lag;
  SoftMaterial material;
  material.return_frequency = test::frequency_of(60);
  material.damping_ratio = 0.2;
  std::vector<Vec3d> moving, after;
  for (const int steps : {2, 20, 400}) {
    SoftScene scene(test::make_sheet(6), material, 0.3, options);
    const ModelPose start = scene.pose;
    scene.step(0.1);
    for (int i = 1; i <= steps; ++i) {
      scene.pose = test::moved(start, test::shift_by({0.4 * i / steps, 0, 0}));
      scene.step(0.5 / steps);
    }
    moving.push_back(scene.body->displacement(0));
    for (int i = 0; i < steps; ++i) scene.step(0.3 / steps);
    after.push_back(scene.body->displacement(0));
  }
  EXPECT_GT(moving[0].norm(), 1e-3);
  for (std::size_t i = 1; i < moving.size(); ++i) {
    EXPECT_LT((moving[i] - moving[0]).norm(), 1e-9);
    EXPECT_LT((after[i] - after[0]).norm(), 1e-9);
  }
}

TEST(soft_body, velocities_inherit_the_motion_of_the_pose) {
  for (const Follow follow : {Follow::ride, Follow::lag}) {
    SoftBodyOptions options;
    options.follow = follow;
    options.tracks_rest = true;
    SoftMaterial stiff;
    stiff.return_frequency = test::frequency_of(1e8);
    stiff.damping_ratio = 1;
    SoftScene scene = make_tube_scene(stiff, options);
    const ModelPose start = scene.pose;
    scene.step(0.01);
    EXPECT_EQ(scene.body->velocity(4), Vec3d::Zero());
    for (int i = 1; i <= 20; ++i) {
      scene.pose = test::moved(start, test::shift_by({0.03 * i, 0.01 * i, 0}));
      scene.step(0.01);
    }
    EXPECT_LT((scene.body->velocity(4) - Vec3d(3, 1, 0)).norm(), 1e-2);
    scene.step(0.01);
    scene.run(0.2);
    EXPECT_LT(scene.body->velocity(4).norm(), 1e-2);
  }
}

TEST(soft_body, distant_particles_stay_asleep) {
  SoftScene scene(test::make_tube(160, 16, 16), find_material("fat").value(), 0.05);
  const std::uint32_t near = scene.nearest({0.5, 8, 0}), far = scene.nearest({0.5, 15, 0}),
                      farthest = scene.nearest({0.5, 1, 0});
  ASSERT_TRUE(scene.body->add_impulse(near, {0.004, 0, 0}));
  std::uint32_t most = 0;
  for (int i = 0; i < 400; ++i) {
    scene.step(1.0 / 60);
    most = std::max(most, scene.body->awake_count());
    EXPECT_FALSE(scene.body->is_awake(far));
    EXPECT_FALSE(scene.body->is_awake(farthest));
  }
  EXPECT_GT(most, 5u);
  EXPECT_LT(most, scene.count() / 2);
  EXPECT_EQ(scene.body->awake_count(), 0u);
  EXPECT_EQ(scene.farthest(), 0);
}

TEST(soft_body, a_front_wakes_neighbour_after_neighbour) {
  SoftMaterial material;
  material.return_frequency = test::frequency_of(20);
  material.membrane_stiffness = 300;
  SoftScene scene(test::make_tube(60, 16, 6), material, 0.08);
  const std::uint32_t held = scene.nearest({0.5, 1, 0});
  ASSERT_TRUE(scene.body->hold(held, scene.body->place(held) + Vec3d(0.5, 0, 0)));
  scene.step(1.0 / 60);
  const std::uint32_t first = scene.body->awake_count();
  scene.run(2);
  EXPECT_GT(scene.body->awake_count() + 0u, 0u);
  EXPECT_GT(scene.body->displacement(scene.nearest({0.5, 2.5, 0})).x(), 1e-3);
  EXPECT_LT(first, scene.count());
}

TEST(soft_body, a_sleeping_body_costs_nothing) {
  SoftScene scene = make_tube_scene();
  scene.run(0.1);
  double best = 1e9;
  for (int round = 0; round < 20; ++round) {
    const auto begin = std::chrono::steady_clock::now();
    for (int i = 0; i < 1000; ++i) (void)scene.body->step(*scene.model, scene.pose, 1.0 / 60);
    best = std::min(
        best,
        std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count() / 1000);
  }
  EXPECT_LT(best, 1e-6);
}

TEST(soft_body, the_same_calls_give_the_same_bits) {
  const auto play = [] {
    SoftScene scene(test::make_tube(40, 12, 4),
                    {find_material("skin").value(), find_material("jelly").value()}, 0.1, {});
    test::Random random(3);
    EXPECT_TRUE(scene.body->set_gravity(kDown));
    for (std::uint32_t p = 0; p < scene.count(); ++p)
      EXPECT_TRUE(scene.body->set_material(p, random.index(2)));
    EXPECT_TRUE(scene.body->hold_point(50, {1, 1, 1}));
    const Collider ball{Collider::Sphere{0.4}, {0.7, 2, 0}, Quatd::Identity(), 0.3};
    EXPECT_TRUE(scene.body->set_colliders({&ball, 1}));
    std::vector<double> bits;
    for (int i = 0; i < 60; ++i) {
      if (i % 7 == 0) scene.pose = test::random_pose(*scene.character, random, 0.1, 1.05);
      scene.step(random.uniform(0, 0.03));
    }
    return bits_of(scene);
  };
  const std::vector<double> once = play(), again = play();
  ASSERT_EQ(once.size(), again.size());
  EXPECT_EQ(std::memcmp(once.data(), again.data(), once.size() * sizeof(double)), 0);
}

TEST(soft_body, other_materials_move_otherwise) {
  SoftMaterial soft, hard;
  soft.return_frequency = test::frequency_of(100);
  hard.return_frequency = test::frequency_of(10000);
  soft.membrane_stiffness = hard.membrane_stiffness = 0;
  SoftScene scene(test::make_tube(40, 12, 4), {soft, hard}, 0.1, {});
  ASSERT_TRUE(scene.body->set_material(3, 1));
  EXPECT_EQ(scene.body->material_of(3), 1u);
  ASSERT_TRUE(scene.body->set_gravity(kDown));
  scene.run(4);
  EXPECT_NEAR(scene.body->displacement(2).y(), -9.81 / 100, 1e-3);
  EXPECT_NEAR(scene.body->displacement(3).y(), -9.81 / 10000, 1e-3);
  hard.return_frequency = test::frequency_of(1000);
  ASSERT_TRUE(scene.body->change_material(1, hard));
  EXPECT_TRUE(scene.body->is_awake(3));
  scene.run(4);
  EXPECT_NEAR(scene.body->displacement(3).y(), -9.81 / 1000, 1e-3);
}

TEST(soft_body, tension_without_lips_does_nothing) {
  SoftScene scene = make_tube_scene();
  ASSERT_TRUE(scene.body->set_tension({50.0, {}}));
  scene.run(0.5);
  EXPECT_EQ(scene.body->awake_count(), 0u);
  EXPECT_EQ(scene.farthest(), 0);
}

TEST(soft_body, moved_vertices_are_those_of_displaced_particles) {
  SoftScene scene = make_tube_scene();
  ASSERT_TRUE(scene.body->add_impulse(9, {0.01, 0, 0}));
  scene.run(0.1);
  const Mesh& mesh = scene.character->meshes[0];
  std::vector<bool> wanted(mesh.vertex_count(), false), found(mesh.vertex_count(), false);
  for (std::uint32_t v = 0; v < mesh.vertex_count(); ++v) {
    const std::uint32_t point = scene.set->vertex_points(0)[v];
    if (point == kNone) continue;
    const ParticleInfluences& of = scene.set->influences()[point];
    for (std::size_t k = 0; k < 4 && of.weights[k] > 0; ++k)
      if (scene.body->displacement(of.particles[k]) != Vec3d::Zero()) wanted[v] = true;
  }
  std::uint32_t end = 0;
  for (const IndexRange& range : scene.body->moved_vertices(*scene.model, 0)) {
    EXPECT_TRUE(end == 0 || range.first > end);
    end = range.first + range.count;
    for (std::uint32_t v = range.first; v < end; ++v) found[v] = true;
  }
  EXPECT_EQ(found, wanted);
}

TEST(soft_body, does_not_allocate_once_warm) {
  SoftMaterial material;
  material.stretch_limit = 1.2;
  SoftScene scene = make_tube_scene(material);
  const Collider ball{Collider::Sphere{0.5}, {0.8, 3, 0}, Quatd::Identity(), 0.5};
  ASSERT_TRUE(scene.body->set_colliders({&ball, 1}));
  ASSERT_TRUE(scene.body->set_gravity(kDown));
  ASSERT_TRUE(scene.body->hold_point(30, {1, 1, 1}));
  test::Random random(1);
  std::vector<ModelPose> poses;
  for (int i = 0; i < 8; ++i)
    poses.push_back(test::random_pose(*scene.character, random, 0.05, 1.0));
  const auto play = [&](int steps) {
    for (int i = 0; i < steps; ++i) {
      scene.pose = poses[static_cast<std::size_t>(i) % poses.size()];
      (void)scene.body->move_collider(0, {0.8 + 0.02 * (i % 5), 3, 0}, Quatd::Identity());
      (void)scene.body->add_impulse(static_cast<std::uint32_t>(i) % scene.count(), {0.001, 0, 0});
      scene.step(1.0 / 60);
    }
  };
  play(60);
  const std::uint64_t before = test::allocation_count();
  for (int i = 0; i < 40; ++i) {
    (void)scene.body->move_collider(0, {0.8 + 0.02 * (i % 5), 3, 0}, Quatd::Identity());
    (void)scene.body->step(*scene.model, poses[static_cast<std::size_t>(i) % poses.size()],
                           1.0 / 60);
  }
  EXPECT_EQ(test::allocation_count(), before);
}

TEST(soft_body, nothing_breaks_it) {
  test::Random random(21);
  for (int trial = 0; trial < 24; ++trial) {
    SoftBodyOptions options;
    options.follow = trial % 2 == 0 ? Follow::ride : Follow::lag;
    std::vector<SoftMaterial> materials(material_presets().begin(), material_presets().end());
    SoftScene scene(trial % 3 == 0 ? test::make_bumpy_ball(700) : test::make_tube(40, 12, 4),
                    materials, 0.12, options);
    SoftBody& body = *scene.body;
    const ModelPose rest = scene.pose;
    std::vector<HoldId> holds;
    std::uint32_t colliders = 0;
    for (int i = 0; i < 150; ++i) {
      const std::uint32_t particle = random.index(scene.count()),
                          point = random.index(scene.set->point_count());
      switch (random.index(12)) {
        case 0: ASSERT_TRUE(body.add_impulse(particle, 0.02 * random.direction())); break;
        case 1: ASSERT_TRUE(body.add_point_impulse(point, 0.02 * random.direction())); break;
        case 2: ASSERT_TRUE(body.set_force(particle, 0.2 * random.direction())); break;
        case 3: ASSERT_TRUE(body.set_gravity(random.uniform(0, 10) * random.direction())); break;
        case 4: holds.push_back(body.hold_point(point, 2 * random.direction()).value()); break;
        case 5: holds.push_back(body.hold(particle, 2 * random.direction()).value()); break;
        case 6:
          for (const HoldId hold : holds) ASSERT_TRUE(body.release(hold));
          holds.clear();
          break;
        case 7: {
          const Collider some[] = {
              {Collider::Sphere{0.4}, random.direction(), random_body_turn(random), 0.5},
              {Collider::Box{{0.2, 0.4, 0.3}}, random.direction(), random_body_turn(random), 0.1}};
          colliders = random.index(3);
          ASSERT_TRUE(body.set_colliders({some, colliders}));
          break;
        }
        case 8:
          if (colliders > 0) {
            ASSERT_TRUE(body.move_collider(0, random.direction(), random_body_turn(random)));
          }
          break;
        case 9:
          ASSERT_TRUE(body.set_material(
              particle, random.index(static_cast<std::uint32_t>(materials.size()))));
          break;
        case 10:
          ASSERT_TRUE(
              body.set_wind(random.index(2) == 0 ? WindField() : [](const Vec3d& p, double t) {
                return Vec3d(std::sin(t), p.x(), 0);
              }));
          break;
        default:
          // Also poses that mirror, flatten, and collapse everything to a point.
          scene.pose =
              random.index(3) == 0 ? rest : test::random_pose(*scene.character, random, 0.5, 1.3);
          if (random.index(3) == 0)
            scene.pose.model_from_bone[0].linear() *= Vec3d(1, -1, 1).asDiagonal();
          if (random.index(4) == 0)
            scene.pose.model_from_bone[1].linear() *= Vec3d(1, 0, 1).asDiagonal();
          if (random.index(8) == 0)
            for (Affine3d& bone : scene.pose.model_from_bone) bone.linear().setZero();
      }
      scene.step(random.index(9) == 0 ? 0.0 : std::pow(10, random.uniform(-5, 0)));
      for (std::uint32_t p = 0; p < scene.count(); ++p) {
        ASSERT_TRUE(body.displacement(p).allFinite() && body.velocity(p).allFinite() &&
                    body.place(p).allFinite())
            << trial << ' ' << i;
        ASSERT_LT(body.displacement(p).norm(), 1e3) << trial << ' ' << i;
        ASSERT_LT(
            (body.rotations()[p].transpose() * body.rotations()[p] - Mat3f::Identity()).norm(),
            1e-4f);
        ASSERT_EQ(body.displacements()[p].head<3>(), body.displacement(p).cast<float>());
      }
    }
    for (const HoldId hold : holds) ASSERT_TRUE(body.release(hold));
    for (std::uint32_t p = 0; p < scene.count(); ++p) ASSERT_TRUE(body.set_force(p, Vec3d::Zero()));
    ASSERT_TRUE(body.set_wind({}));
    ASSERT_TRUE(body.set_gravity(Vec3d::Zero()));
    ASSERT_TRUE(body.set_colliders({}));
    scene.pose = rest;
    scene.run(30);
    EXPECT_EQ(scene.farthest(), 0) << trial;
    EXPECT_EQ(body.awake_count(), 0u) << trial;
  }
}

TEST(soft_body, invalid_input_is_named_and_changes_nothing) {
  SoftScene scene = make_tube_scene();
  ASSERT_TRUE(scene.body->add_impulse(3, {0.01, 0, 0}));
  const auto hold = scene.body->hold_point(30, {1, 1, 1});
  ASSERT_TRUE(hold);
  scene.run(0.1);
  const std::vector<double> before = bits_of(scene);
  SoftBody& body = *scene.body;
  const std::uint32_t count = scene.count(), points = scene.set->point_count();
  const auto expect = [&](const Status& status, StatusCode code, std::uint32_t index,
                          std::string_view said) {
    EXPECT_EQ(status.code(), code) << status.text();
    EXPECT_EQ(status.index(), index) << status.text();
    EXPECT_NE(status.text().find(said), std::string_view::npos) << status.text();
  };
  const Vec3d nan(0, kNaN, 0);
  expect(body.add_impulse(count, {1, 0, 0}), StatusCode::index_out_of_range, count, "particle");
  expect(body.add_impulse(0, nan), StatusCode::non_finite_value, kNone, "impulse");
  expect(body.add_point_impulse(points, {1, 0, 0}), StatusCode::index_out_of_range, points,
         "point");
  expect(body.add_point_impulse(1, nan), StatusCode::non_finite_value, kNone, "impulse");
  expect(body.set_force(count, {1, 0, 0}), StatusCode::index_out_of_range, count, "particle");
  expect(body.set_force(0, nan), StatusCode::non_finite_value, kNone, "force");
  expect(body.set_gravity(nan), StatusCode::non_finite_value, kNone, "gravity");
  expect(body.set_tension({-1.0, {}}), StatusCode::invalid_argument, kNone, "tension");
  const Vec3d huge(0, 1e60, 0);
  expect(body.add_impulse(0, huge), StatusCode::invalid_argument, kNone, "impulse");
  expect(body.add_impulse(0, {1e12, 0, 0}), StatusCode::invalid_argument, 0, "velocity");
  expect(body.add_point_impulse(1, huge), StatusCode::invalid_argument, kNone, "impulse");
  EXPECT_EQ(body.add_point_impulse(1, {0, 0, -1e12}).code(), StatusCode::invalid_argument);
  expect(body.set_force(0, huge), StatusCode::invalid_argument, kNone, "force");
  expect(body.set_gravity(huge), StatusCode::invalid_argument, kNone, "gravity");
  expect(body.set_tension({1e13, {}}), StatusCode::invalid_argument, kNone, "tension");
  for (const float share : {-0.1f, 1.1f, std::numeric_limits<float>::quiet_NaN()})
    expect(body.set_tension({1.0, {}, false, {0.5f, share}}), StatusCode::invalid_argument, 1,
           "share");
  expect(body.hold(0, huge).error(), StatusCode::invalid_argument, kNone, "target");
  expect(body.move_hold(*hold, huge), StatusCode::invalid_argument, kNone, "target");
  expect(body.set_material(count, 0), StatusCode::index_out_of_range, count, "particle");
  expect(body.set_material(0, 1), StatusCode::index_out_of_range, 1, "material");
  SoftMaterial bad;
  bad.name = "bad";
  bad.damping_ratio = -1;
  expect(body.change_material(0, bad), StatusCode::invalid_argument, 0,
         "'bad': damping_ratio is -1");
  expect(body.change_material(1, {}), StatusCode::index_out_of_range, 1, "material");
  expect(body.hold(count, {0, 0, 0}).error(), StatusCode::index_out_of_range, count, "particle");
  expect(body.hold(0, nan).error(), StatusCode::non_finite_value, kNone, "target");
  expect(body.hold_point(points, {0, 0, 0}).error(), StatusCode::index_out_of_range, points,
         "point");
  expect(body.hold_point(0, {0, 0, 0}, {0.0}).error(), StatusCode::invalid_argument, kNone,
         "stiffness");
  expect(body.move_hold(*hold, nan), StatusCode::non_finite_value, kNone, "target");
  expect(body.move_hold(99, {0, 0, 0}), StatusCode::not_found, kNone, "99");
  expect(body.release(99), StatusCode::not_found, kNone, "99");
  const Collider bad_ball{Collider::Sphere{-1}, Vec3d::Zero(), Quatd::Identity(), 0},
      ball{Collider::Sphere{1}, {9, 9, 9}, Quatd::Identity(), 0};
  const Collider both[] = {ball, bad_ball};
  expect(body.set_colliders(both), StatusCode::invalid_argument, 1, "radius is -1");
  expect(body.move_collider(0, {0, 0, 0}, Quatd::Identity()), StatusCode::index_out_of_range, 0,
         "collider");
  expect(body.step(*scene.model, scene.pose, -0.1), StatusCode::invalid_argument, kNone, "-0.1");
  expect(body.step(*scene.model, scene.pose, kNaN), StatusCode::non_finite_value, kNone,
         "time step");
  ModelPose wrong = scene.pose;
  wrong.model_from_bone.pop_back();
  expect(body.step(*scene.model, wrong, 0.1), StatusCode::size_mismatch, kNone, "bones");
  wrong = scene.pose;
  wrong.model_from_bone[2].translation().x() = kNaN;
  expect(body.step(*scene.model, wrong, 0.1), StatusCode::non_finite_value, 2, "bone 2");
  const SoftScene other(test::make_sheet(3));
  expect(body.step(*other.model, scene.pose, 0.1), StatusCode::invalid_argument, kNone, "points");
  const std::vector<double> after = bits_of(scene);
  ASSERT_EQ(before.size(), after.size());
  EXPECT_EQ(std::memcmp(before.data(), after.data(), before.size() * sizeof(double)), 0);
  EXPECT_EQ(SoftBody::create(*scene.set, scene.pose, {}).error().code(), StatusCode::empty_input);
  const SoftMaterial two[] = {SoftMaterial(), bad};
  EXPECT_EQ(SoftBody::create(*scene.set, scene.pose, two).error().index(), 1u);
  EXPECT_EQ(SoftBody::create(*scene.set, wrong, {two, 1}).error().index(), 2u);
}

TEST(material, is_checked_and_found) {
  for (const SoftMaterial& material : material_presets()) {
    EXPECT_TRUE(validate_material(material)) << validate_material(material).text();
    const auto found = find_material(material.name);
    ASSERT_TRUE(found);
    EXPECT_EQ(*found, material);
  }
  EXPECT_EQ(find_material("granite").error().code(), StatusCode::not_found);
  const auto fault = [](auto change) {
    SoftMaterial material;
    change(material);
    return validate_material(material);
  };
  EXPECT_EQ(fault([](SoftMaterial& m) { m.return_frequency = kNaN; }).code(),
            StatusCode::non_finite_value);
  EXPECT_EQ(fault([](SoftMaterial& m) { m.return_frequency = 2e5; }).code(),
            StatusCode::invalid_argument);
  EXPECT_EQ(fault([](SoftMaterial& m) { m.areal_density = 0; }).code(),
            StatusCode::invalid_argument);
  EXPECT_EQ(fault([](SoftMaterial& m) { m.range = 0; }).code(), StatusCode::invalid_argument);
  EXPECT_EQ(fault([](SoftMaterial& m) { m.stretch_limit = 0.5; }).code(),
            StatusCode::invalid_argument);
  EXPECT_EQ(fault([](SoftMaterial& m) { m.strength = 1; }).code(), StatusCode::invalid_argument);
  EXPECT_EQ(fault([](SoftMaterial& m) { m.flaw_length = 0; }).code(), StatusCode::invalid_argument);
  EXPECT_EQ(fault([](SoftMaterial& m) { m.membrane_stiffness = -1; }).code(),
            StatusCode::invalid_argument);
}

}  // namespace
}  // namespace sunder
