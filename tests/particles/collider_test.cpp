#include <sunder/skinning/deform.h>

#include <functional>

#include "particles/contact/contact_points.h"
#include "particles/frequency_of.h"
#include "particles/motion/epoch_pose.h"
#include "particles/soft_scene.h"
#include "skinning/internal/reference.h"

namespace sunder {
namespace {

using test::SoftScene;

Quatd random_turn(test::Random& random) {
  return Quatd(Eigen::AngleAxisd{random.uniform(-3, 3), random.direction()});
}

/// The surface of a collider by its definition: samples on it.
std::vector<Vec3d> places_on(const Collider& collider, test::Random& random, int count) {
  std::vector<Vec3d> places;
  for (int i = 0; i < count; ++i) {
    Vec3d place;
    if (const auto* sphere = std::get_if<Collider::Sphere>(&collider.shape)) {
      place = sphere->radius * random.direction();
    } else if (const auto* capsule = std::get_if<Collider::Capsule>(&collider.shape)) {
      const Vec3d direction = random.direction();
      const bool is_side = random.index(2) == 0;
      place = is_side
                  ? Vec3d(capsule->radius * Vec3d(direction.x(), 0, direction.z()).normalized() +
                          Vec3d(0, random.uniform(-1, 1) * capsule->half_length, 0))
                  : Vec3d(capsule->radius * direction +
                          Vec3d(0, direction.y() < 0 ? -capsule->half_length : capsule->half_length,
                                0));
    } else if (const auto* box = std::get_if<Collider::Box>(&collider.shape)) {
      for (int axis = 0; axis < 3; ++axis)
        place[axis] = random.uniform(-1, 1) * box->half_size[axis];
      const std::uint32_t axis = random.index(3);
      place[axis] = random.index(2) == 0 ? box->half_size[axis] : -box->half_size[axis];
    } else {
      place = {random.uniform(-4, 4), 0, random.uniform(-4, 4)};
    }
    places.push_back(collider.place + collider.turn * place);
  }
  return places;
}

TEST(collider, distances_are_those_of_its_surface) {
  test::Random random(5);
  const std::variant<Collider::Sphere, Collider::Capsule, Collider::Box, Collider::HalfSpace>
      shapes[] = {Collider::Sphere{0.6}, Collider::Capsule{0.3, 0.8},
                  Collider::Box{{0.3, 0.9, 0.5}}, Collider::HalfSpace{}};
  for (const auto& shape : shapes) {
    const Collider collider{shape, 0.4 * random.direction(), random_turn(random), 0};
    const std::vector<Vec3d> surface = places_on(collider, random, 60000);
    for (int i = 0; i < 60; ++i) {
      const Vec3d place = collider.place + random.uniform(0, 1.5) * random.direction();
      double nearest = 1e300;
      for (const Vec3d& at : surface) nearest = std::min(nearest, (at - place).norm());
      const SurfaceDistance found = distance_to(collider, place);
      EXPECT_NEAR(std::abs(found.distance), nearest, 0.03);
      EXPECT_LE(std::abs(found.distance), nearest + 1e-12);
      EXPECT_NEAR(found.normal.norm(), 1, 1e-12);
      // One step along the normal leads to the surface; a little farther is outside, a little less
      // is inside.
      const Vec3d at = place - found.distance * found.normal;
      EXPECT_NEAR(distance_to(collider, at).distance, 0, 1e-9);
      EXPECT_GT(distance_to(collider, at + 1e-3 * found.normal).distance, 0);
      EXPECT_LT(distance_to(collider, at - 1e-3 * found.normal).distance, 0);
    }
  }
}

TEST(collider, the_middle_of_a_shape_is_inside) {
  for (const Collider& collider :
       {Collider{Collider::Sphere{0.6}, {1, 2, 3}, Quatd::Identity(), 0},
        Collider{Collider::Capsule{0.6, 1}, {1, 2, 3}, Quatd::Identity(), 0},
        Collider{Collider::Box{{0.6, 1, 1}}, {1, 2, 3}, Quatd::Identity(), 0}}) {
    const SurfaceDistance found = distance_to(collider, {1, 2, 3});
    EXPECT_DOUBLE_EQ(found.distance, -0.6);
    EXPECT_DOUBLE_EQ(found.normal.norm(), 1);
  }
}

TEST(collider, is_checked) {
  const auto fault = [](const Collider& collider) { return validate_collider(collider).code(); };
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(fault({Collider::Sphere{1}, Vec3d::Zero(), Quatd::Identity(), 0}), StatusCode::ok);
  EXPECT_EQ(fault({Collider::Sphere{0}, Vec3d::Zero(), Quatd::Identity(), 0}),
            StatusCode::invalid_argument);
  EXPECT_EQ(fault({Collider::Capsule{1, -1}, Vec3d::Zero(), Quatd::Identity(), 0}),
            StatusCode::invalid_argument);
  EXPECT_EQ(fault({Collider::Box{{1, 0, 1}}, Vec3d::Zero(), Quatd::Identity(), 0}),
            StatusCode::invalid_argument);
  EXPECT_EQ(fault({Collider::Sphere{nan}, Vec3d::Zero(), Quatd::Identity(), 0}),
            StatusCode::invalid_argument);
  EXPECT_EQ(fault({Collider::HalfSpace{}, {nan, 0, 0}, Quatd::Identity(), 0}),
            StatusCode::non_finite_value);
  EXPECT_EQ(fault({Collider::HalfSpace{}, Vec3d::Zero(), Quatd(2, 0, 0, 0), 0}),
            StatusCode::invalid_argument);
  EXPECT_EQ(fault({Collider::HalfSpace{}, Vec3d::Zero(), Quatd::Identity(), -1}),
            StatusCode::invalid_argument);
}

TEST(collider, places_and_sizes_that_no_state_may_have_are_refused) {
  // A radius of 3e38 m is finite, and pushes tissue to where single precision has no number.
  const auto fault = [](const Collider& collider) { return validate_collider(collider).code(); };
  for (const double far : {1e10, 1e38, std::numeric_limits<double>::max()}) {
    EXPECT_EQ(fault({Collider::Sphere{far}, Vec3d::Zero(), Quatd::Identity(), 0}),
              StatusCode::invalid_argument);
    EXPECT_EQ(fault({Collider::Capsule{1, far}, Vec3d::Zero(), Quatd::Identity(), 0}),
              StatusCode::invalid_argument);
    EXPECT_EQ(fault({Collider::Box{{1, 1, far}}, Vec3d::Zero(), Quatd::Identity(), 0}),
              StatusCode::invalid_argument);
    EXPECT_EQ(fault({Collider::HalfSpace{}, {0, -far, 0}, Quatd::Identity(), 0}),
              StatusCode::invalid_argument);
  }
  EXPECT_EQ(fault({Collider::HalfSpace{}, Vec3d::Zero(), Quatd::Identity(), 1e13}),
            StatusCode::invalid_argument);
  EXPECT_EQ(fault({Collider::Sphere{1e9}, {1e9, 0, 0}, Quatd::Identity(), 1e12}), StatusCode::ok);
}

/// The position of a point, skinned by the reference and displaced by the body's results.
Vec3d place_of(const SoftScene& scene, std::uint32_t vertex) {
  const Mesh& mesh = scene.model->character().meshes[0];
  std::vector<Affine3d> palette(scene.character->skins[mesh.skin].bones.size());
  EXPECT_TRUE(compute_palette(scene.character->skins[mesh.skin], scene.pose, std::span(palette)));
  return deform_position_reference(mesh, vertex, palette, scene.pose.morph_weights) +
         scene.body->point_displacement(scene.set->vertex_points(0)[vertex]);
}

/// The largest depth of a contact point inside the collider, in ranges of its particle.
double deepest(const SoftScene& scene, const Collider& collider) {
  particles::ContactPoints points;
  particles::EpochPose poses;
  const particles::SurfacePose& posed = poses.at(*scene.model, scene.pose, 1);
  points.follow(scene.count());
  double most = 0;
  for (std::uint32_t p = 0; p < scene.count(); ++p) {
    const auto& of = points.of(*scene.set, *scene.model, posed, 1, p);
    EXPECT_GT(of.count, 0u);
    for (std::uint32_t i = 0; i < of.count; ++i)
      most = std::max(
          most, -distance_to(collider, of.places[i] + scene.body->point_displacement(of.points[i]))
                        .distance /
                    scene.set->range(p));
  }
  return most;
}

TEST(collider, a_ball_pressed_into_a_tube_leaves_no_mark) {
  for (const double friction : {0.0, 0.8}) {
    SoftScene scene(test::make_tube(80, 24, 6), find_material("foam").value(), 0.06);
    Collider ball{Collider::Sphere{0.4}, {1.2, 3, 0}, Quatd::Identity(), friction};
    ASSERT_TRUE(scene.body->set_colliders({&ball, 1}));
    scene.run(0.2);
    EXPECT_EQ(scene.body->awake_count(), 0u);
    EXPECT_EQ(scene.body->contacts().points, 0u);
    const std::uint32_t far = scene.nearest({0.5, 0.3, 0});
    for (int i = 1; i <= 60; ++i) {
      ball.place.x() = 1.2 - 0.5 * i / 60.0;
      ASSERT_TRUE(scene.body->move_collider(0, ball.place, Quatd::Identity()));
      scene.step(1.0 / 60);
      ASSERT_LT(deepest(scene, ball), 5e-3) << i;
      ASSERT_LT(scene.body->contacts().deepest, 5e-3 * scene.set->range(0));
    }
    EXPECT_GT(scene.body->contacts().points, 0u);
    EXPECT_GT(scene.farthest(), 0.1);
    EXPECT_LT(scene.farthest(), 0.45);
    EXPECT_EQ(scene.body->displacement(far), Vec3d::Zero());
    scene.run(8);
    EXPECT_LT(deepest(scene, ball), 5e-3);
    EXPECT_EQ(scene.body->awake_count(), 0u);
    for (int i = 59; i >= 0; --i) {
      ASSERT_TRUE(scene.body->move_collider(0, {1.2 - 0.5 * i / 60.0, 3, 0}, Quatd::Identity()));
      scene.step(1.0 / 60);
    }
    scene.run(5);
    EXPECT_EQ(scene.farthest(), 0);
    EXPECT_EQ(scene.body->awake_count(), 0u);
  }
}

TEST(collider, tissue_of_any_kind_falls_asleep_in_contact) {
  for (const SoftMaterial& material : material_presets())
    for (const double range : {0.06, 0.08, 0.1})
      for (const double friction : {0.0, 0.8}) {
        SCOPED_TRACE(material.name + " " + std::to_string(range) + " " + std::to_string(friction));
        SoftScene scene(test::make_tube(80, 24, 6), material, range);
        Collider ball{Collider::Sphere{0.4}, {1.2, 3, 0}, Quatd::Identity(), friction};
        ASSERT_TRUE(scene.body->set_colliders({&ball, 1}));
        const auto move = [&](int i) {
          ball.place.x() = 1.2 - 0.5 * i / 60.0;
          ASSERT_TRUE(scene.body->move_collider(0, ball.place, Quatd::Identity()));
          scene.step(1.0 / 60);
        };
        for (int i = 1; i <= 60; ++i) move(i);
        scene.run(8);
        EXPECT_EQ(scene.body->awake_count(), 0u);
        EXPECT_LT(deepest(scene, ball), 5e-3);
        EXPECT_GT(scene.farthest(), 0.1);
        for (int i = 59; i >= 0; --i) move(i);
        scene.run(15);
        EXPECT_EQ(scene.farthest(), 0);
        EXPECT_EQ(scene.body->awake_count(), 0u);
      }
}

TEST(collider, pushes_nothing_that_it_does_not_touch) {
  SoftScene scene(test::make_tube(80, 24, 6), find_material("skin").value(), 0.06);
  const Collider ball{Collider::Sphere{0.4}, {0.5 + 0.4 + 0.002, 3, 0}, Quatd::Identity(), 0};
  ASSERT_TRUE(scene.body->set_colliders({&ball, 1}));
  scene.run(0.5);
  EXPECT_EQ(scene.farthest(), 0);
}

TEST(collider, every_shape_is_left_at_any_step) {
  test::Random random(9);
  const std::variant<Collider::Sphere, Collider::Capsule, Collider::Box, Collider::HalfSpace>
      shapes[] = {Collider::Sphere{0.5}, Collider::Capsule{0.3, 0.5},
                  Collider::Box{{0.3, 0.5, 0.4}}, Collider::HalfSpace{}};
  for (const auto& shape : shapes)
    for (const double seconds : {1e-4, 1.0 / 60, 0.5}) {
      SoftScene scene(test::make_bumpy_ball(1500), find_material("fat").value(), 0.08);
      const Vec3d away = random.direction();
      // A half-space with its plane across the ball, a shape dipped into it.
      Collider collider{shape, 1.25 * away, random_turn(random), 0.3};
      if (std::holds_alternative<Collider::HalfSpace>(shape)) {
        collider.place = -0.9 * away;
        collider.turn = Quatd::FromTwoVectors(Eigen::Vector3d::UnitY(), Eigen::Vector3d(away));
      }
      ASSERT_TRUE(scene.body->set_colliders({&collider, 1}));
      for (int i = 0; i < 30; ++i) {
        scene.step(seconds);
        ASSERT_LT(deepest(scene, collider), 1e-2) << shape.index() << ' ' << seconds << ' ' << i;
        ASSERT_LT(scene.farthest(), 1.5);
      }
    }
}

TEST(collider, a_floor_carries_falling_tissue) {
  SoftMaterial material;
  material.return_frequency = test::frequency_of(20);
  material.membrane_stiffness = 2;
  material.damping_ratio = 0.5;
  SoftScene scene(test::make_bumpy_ball(1500), material, 0.1);
  ASSERT_TRUE(scene.body->set_gravity({0, -9.81, 0}));
  const Collider floor{Collider::HalfSpace{}, {0, -1.15, 0}, Quatd::Identity(), 0.5};
  ASSERT_TRUE(scene.body->set_colliders({&floor, 1}));
  for (int i = 0; i < 300; ++i) {
    scene.step(1.0 / 60);
    ASSERT_LT(deepest(scene, floor), 1e-2) << i;
  }
  EXPECT_GT(scene.body->contacts().points + (scene.body->awake_count() == 0 ? 1u : 0u), 0u);
  double lowest = 0;
  for (std::uint32_t v = 0; v < scene.character->meshes[0].vertex_count(); ++v)
    lowest = std::min(lowest, place_of(scene, v).y());
  EXPECT_GT(lowest, -1.15 - 0.02);
  EXPECT_LT(lowest, -1.1);
}

TEST(collider, friction_drags_along) {
  double dragged[2] = {};
  for (const bool is_rough : {false, true}) {
    SoftScene scene(test::make_sheet(24, 2.0f), find_material("skin").value(), 0.06);
    Collider box{
        Collider::Box{{0.2, 0.2, 0.2}}, {1, 1, 0.15}, Quatd::Identity(), is_rough ? 1.0 : 0.0};
    ASSERT_TRUE(scene.body->set_colliders({&box, 1}));
    scene.run(0.5);
    for (int i = 1; i <= 30; ++i) {
      ASSERT_TRUE(scene.body->move_collider(0, {1 + 0.002 * i, 1, 0.15}, Quatd::Identity()));
      scene.step(1.0 / 60);
    }
    dragged[is_rough ? 1 : 0] = scene.body->displacement(scene.nearest({1, 1, -0.05})).x();
  }
  EXPECT_LT(std::abs(dragged[0]), 0.01);
  EXPECT_GT(dragged[1], 0.04);
}

TEST(collider, a_pose_that_moves_into_it_is_pushed_back) {
  for (const Follow follow : {Follow::ride, Follow::lag}) {
    SoftBodyOptions options;
    options.follow = follow;
    SoftScene scene(test::make_tube(60, 16, 6), find_material("skin").value(), 0.08, options);
    const Collider wall{Collider::HalfSpace{},
                        {0.7, 0, 0},
                        Quatd::FromTwoVectors(Eigen::Vector3d::UnitY(), -Eigen::Vector3d::UnitX()),
                        0.2};
    ASSERT_TRUE(scene.body->set_colliders({&wall, 1}));
    const ModelPose start = scene.pose;
    for (int i = 1; i <= 30; ++i) {
      scene.pose = test::moved(start, test::shift_by({0.01 * i, 0, 0}));
      scene.step(1.0 / 60);
      ASSERT_LT(deepest(scene, wall), 1e-2);
    }
    EXPECT_GT(scene.farthest(), 0.05);
    for (int i = 29; i >= 0; --i) {
      scene.pose = test::moved(start, test::shift_by({0.01 * i, 0, 0}));
      scene.step(1.0 / 60);
    }
    scene.run(5);
    EXPECT_EQ(scene.farthest(), 0);
  }
}

}  // namespace
}  // namespace sunder
