#include <sunder/particles/fitted_colliders.h>
#include <sunder/skinning/pose.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
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

/// A box of given corners, with 12 triangles, appended to a mesh of one bone.
void add_box(Mesh& mesh, const Vec3f& low, const Vec3f& high) {
  const auto first = static_cast<Index>(mesh.positions.size());
  for (Index i = 0; i < 8; ++i)
    mesh.positions.emplace_back((i & 1U) != 0 ? high.x() : low.x(),
                                (i & 2U) != 0 ? high.y() : low.y(),
                                (i & 4U) != 0 ? high.z() : low.z());
  const std::array<std::array<Index, 4>, 6> faces = {
      {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}}};
  for (const auto& face : faces) {
    mesh.triangles.push_back({first + face[0], first + face[1], first + face[2]});
    mesh.triangles.push_back({first + face[0], first + face[2], first + face[3]});
  }
}

TEST(FittedColliders, of_a_bent_link_are_two_boxes) {
  Character bent;
  bent.meshes.resize(1);
  add_box(bent.meshes[0], Vec3f(0, 0, 0), Vec3f(4, 1, 1));
  add_box(bent.meshes[0], Vec3f(0, 2, 0), Vec3f(1, 6, 1));
  bent.meshes[0].submeshes = {{"link", kNone}};
  bent.meshes[0].triangle_submesh.assign(bent.meshes[0].triangles.size(), 0);
  test::rig_along(bent, 1);
  const auto one = fit_colliders(bent), several = fit_colliders(bent, 0.1, 5);
  ASSERT_TRUE(one && several) << several.error().text();
  ASSERT_EQ(one->size(), 1u);
  ASSERT_EQ(several->size(), 2u);
  double volume = 0;
  for (const BoneCollider& of : *several) {
    EXPECT_EQ(of.collider.friction, 0.1);
    volume += volume_of(of.collider);
  }
  EXPECT_NEAR(volume, 8, 0.01);
  EXPECT_GT(volume_of(one->at(0).collider), 15);
}

TEST(FittedColliders, hold_each_triangle_in_one_shape) {
  Character ball = test::make_bumpy_ball(1500);
  for (Vec3f& position : ball.meshes[0].positions)  // bent
    position =
        Vec3f(3 * position.x(), position.y() + 2 * position.x() * position.x(), position.z());
  test::rig_along(ball, 2);
  double before = 1e9;
  for (const std::uint32_t most : {1u, 2u, 4u, 8u}) {
    const auto fitted = fit_colliders(ball, 0, most);
    ASSERT_TRUE(fitted) << fitted.error().text();
    EXPECT_LE(fitted->size(), 2 * most);
    double volume = 0;
    for (const BoneCollider& of : *fitted) volume += volume_of(of.collider);
    EXPECT_LT(volume, 1.0001 * before) << most;
    before = volume;
    const ModelPose pose = *rest_pose(ball);
    const auto bone_of = [&](Index v) {
      const auto influences = ball.meshes[0].weights.of(v);
      return ball.skins[0]
          .bones[std::ranges::max_element(influences, {}, &Influence::weight)->slot];
    };
    for (const Triangle& corners : ball.meshes[0].triangles) {
      const Index bone = bone_of(corners[0]);
      if (bone_of(corners[1]) != bone || bone_of(corners[2]) != bone) continue;
      EXPECT_TRUE(std::ranges::any_of(*fitted, [&](const BoneCollider& of) {
        const Collider posed = posed_collider(of, pose.model_from_bone[of.bone]);
        return of.bone == bone && std::ranges::all_of(corners, [&](Index v) {
                 const Vec3d place = ball.meshes[0].positions[v].cast<double>();
                 return distance_to(posed, place).distance < 1e-5;
               });
      }));
    }
  }
}

TEST(FittedColliders, faults_are_named) {
  EXPECT_FALSE(fit_colliders(test::make_sheet(2), 0, 0));
  EXPECT_FALSE(fit_colliders(test::make_sheet(2), -1));
  EXPECT_FALSE(fit_colliders(test::make_sheet(2), std::nan("")));
  const auto none = fit_colliders(Character());
  ASSERT_TRUE(none);
  EXPECT_TRUE(none->empty());
}

}  // namespace
}  // namespace sunder
