#include <sunder/particles/fitted_colliders.h>

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "support/models/rigs.h"

namespace sunder {
namespace {

double volume_of(const Collider& collider) {
  if (const auto* sphere = std::get_if<Collider::Sphere>(&collider.shape))
    return 4.0 / 3 * std::numbers::pi * std::pow(sphere->radius, 3);
  if (const auto* box = std::get_if<Collider::Box>(&collider.shape))
    return 8 * box->half_size.prod();
  const auto& capsule = std::get<Collider::Capsule>(collider.shape);
  return std::numbers::pi * capsule.radius * capsule.radius *
         (2 * capsule.half_length + 4.0 / 3 * capsule.radius);
}

TEST(FittedColliders, hold_what_their_bone_moves_in_every_pose) {
  const Character tube = test::make_tube(12, 16, 3);
  const auto colliders = fit_colliders(tube, 0.2);
  ASSERT_TRUE(colliders) << colliders.error().text();
  ASSERT_EQ(colliders->size(), 3u);
  test::Random random(1);
  for (int i = 0; i < 20; ++i) {
    const ModelPose pose = test::random_pose(tube, random, 1.0, 1.0);
    for (const BoneCollider& fitted : *colliders) {
      const Collider posed = posed_collider(fitted, pose.model_from_bone[fitted.bone]);
      ASSERT_TRUE(validate_collider(posed));
      EXPECT_EQ(posed.friction, 0.2);
      for (Index v = 0; v < tube.meshes[0].vertex_count(); ++v) {
        const auto influences = tube.meshes[0].weights.of(v);
        const auto most = std::ranges::max_element(influences, {}, &Influence::weight);
        if (tube.skins[0].bones[most->slot] != fitted.bone) continue;
        const Vec3d carried = pose.model_from_bone[fitted.bone] *
                              (tube.skins[0].bone_from_bind[most->slot].cast<double>() *
                               tube.meshes[0].positions[v].cast<double>());
        EXPECT_LE(distance_to(posed, carried).distance, 1e-6);
      }
    }
  }
}

TEST(FittedColliders, are_of_the_shape_that_fits_best) {
  Character ball = test::make_bumpy_ball(2000);
  test::rig_along(ball, 1);
  for (Vec3f& position : ball.meshes[0].positions) position.normalize();
  auto fitted = fit_colliders(ball);
  ASSERT_TRUE(fitted);
  EXPECT_NEAR(volume_of(fitted->at(0).collider), 4.0 / 3 * std::numbers::pi, 0.05);
  for (Vec3f& position : ball.meshes[0].positions) position.y() += position.y() < 0 ? -3.0f : 3.0f;
  fitted = fit_colliders(ball);
  ASSERT_TRUE(fitted);
  EXPECT_TRUE(std::holds_alternative<Collider::Capsule>(fitted->at(0).collider.shape));
  Character sheet = test::make_sheet(4);
  fitted = fit_colliders(sheet);
  ASSERT_TRUE(fitted);
  for (const BoneCollider& of : *fitted) {
    EXPECT_TRUE(std::holds_alternative<Collider::Box>(of.collider.shape));
    EXPECT_TRUE(validate_collider(of.collider));
  }
}

TEST(FittedColliders, faults_are_named) {
  EXPECT_FALSE(fit_colliders(test::make_sheet(2), -1));
  EXPECT_FALSE(fit_colliders(test::make_sheet(2), std::nan("")));
  const auto none = fit_colliders(Character());
  ASSERT_TRUE(none);
  EXPECT_TRUE(none->empty());
}

}  // namespace
}  // namespace sunder
