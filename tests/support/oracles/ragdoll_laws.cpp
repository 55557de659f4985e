#include "support/oracles/ragdoll_laws.h"

#include <sunder/particles/collider.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "support/models/rigs.h"

namespace sunder::test {
namespace {

void expect_rigid(const Affine3d& frame) {
  const Mat3d turn = frame.linear();
  EXPECT_LT((turn * turn.transpose() - Mat3d::Identity()).norm(), 1e-9);
  EXPECT_GT(turn.determinant(), 0.0);
  EXPECT_TRUE(frame.matrix().allFinite());
}

void expect_same(const Affine3d& a, const Affine3d& b, double size) {
  EXPECT_LT((a.linear() - b.linear()).norm(), 1e-7 * (1 + a.linear().norm()));
  EXPECT_LT((a.translation() - b.translation()).norm(), 1e-7 * size);
}

/// The triangles of the body's part are within its shape and its hull.
void expect_parts_held(const Character& character, const ModelPose& pose, const Ragdoll& ragdoll,
                       double size) {
  std::vector<ConvexHull> hulls;
  if (has_convex_hulls()) {
    auto made = hulls_of_ragdoll(ragdoll, character, pose, 65535);
    ASSERT_TRUE(made) << made.error().text();
    hulls = *std::move(made);
    ASSERT_EQ(hulls.size(), ragdoll.bodies.size());
  }
  for (std::uint32_t m = 0; m < character.meshes.size(); ++m) {
    const Mesh& mesh = character.meshes[m];
    const std::vector<Vec3d> posed = posed_positions(character, m, pose);
    for (const Triangle& triangle : mesh.triangles) {
      if (is_retired(triangle)) continue;
      const std::uint32_t bone = main_bone(triangle, mesh.weights, character.skins[mesh.skin]);
      const std::uint32_t index = ragdoll.body_of_bone[bone];
      for (const std::uint32_t vertex : triangle) {
        const Vec3d local = ragdoll.bodies[index].model_from_body.inverse() * posed[vertex];
        ASSERT_LE(distance_to(ragdoll.bodies[index].shape, local).distance, 1e-6 * size);
        if (hulls.empty() || !(hulls[index].volume > 0)) continue;
        for (const Triangle& face : hulls[index].triangles) {
          const Vec3d& a = hulls[index].points[face[0]];
          const Vec3d normal = (hulls[index].points[face[1]] - a)
                                   .cross(hulls[index].points[face[2]] - a)
                                   .normalized();
          ASSERT_LE(normal.dot(local - a), 1e-6 * size);
        }
      }
    }
  }
}

void expect_joints(const Ragdoll& ragdoll, double size) {
  std::vector<Affine3d> places;
  for (const RagdollBody& body : ragdoll.bodies) places.push_back(body.model_from_body);
  std::vector<Quatd> turns(places.size());
  ASSERT_TRUE(joint_turns(ragdoll, places, turns));
  for (std::size_t i = 0; i < ragdoll.bodies.size(); ++i) {
    const RagdollBody& body = ragdoll.bodies[i];
    if (body.parent == kNone) continue;
    expect_rigid(body.parent_from_joint);
    expect_rigid(body.body_from_joint);
    const Vec3d at_parent = places[body.parent] * Vec3d(body.parent_from_joint.translation());
    const Vec3d at_body = places[i] * Vec3d(body.body_from_joint.translation());
    EXPECT_LT((at_parent - at_body).norm(), 1e-9 * size);
    EXPECT_LE(beyond_limit(turns[i], body.limit), 1e-3);
  }
}

}  // namespace

double beyond_limit(const Quatd& turn, const BoneLimit& limit) {
  const Mat3d matrix = turn.toRotationMatrix();
  const double swing = std::acos(std::clamp(matrix(0, 0), -1.0, 1.0));
  const double allowed = limit.kind == BoneLimit::Kind::hinge ? 0.0 : limit.cone;
  const double beyond = std::max(0.0, swing - allowed);
  if (swing > std::numbers::pi - 0.01) return beyond;  // the twist of a full swing is any
  // The twist that is left when the shortest turn takes the x axis back.
  const Eigen::Quaterniond back =
      Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d(matrix.col(0)), Eigen::Vector3d::UnitX());
  const Eigen::Matrix3d left = back.toRotationMatrix() * matrix;
  const double twist = std::atan2(left(2, 1), left(1, 1));
  double beyond_twist = HUGE_VAL;
  for (const double turns : {-1.0, 0.0, 1.0}) {
    const double angle = twist + turns * 2 * std::numbers::pi;
    beyond_twist =
        std::min(beyond_twist, std::max({0.0, limit.lower - angle, angle - limit.upper}));
  }
  return std::max(beyond, beyond_twist);
}

void expect_ragdoll_laws(const Character& character, const ModelPose& pose, const Ragdoll& ragdoll,
                         Random& random) {
  const double size = posed_diagonal(character, pose);
  ASSERT_FALSE(ragdoll.bodies.empty());
  ASSERT_EQ(ragdoll.body_of_bone.size(), character.skeleton.bones.size());
  for (std::uint32_t i = 0; i < ragdoll.bodies.size(); ++i) {
    const RagdollBody& body = ragdoll.bodies[i];
    EXPECT_TRUE(body.parent == kNone || body.parent < i);
    EXPECT_EQ(ragdoll.body_of_bone[body.bone], i);
    EXPECT_GT(body.mass, 0.0);
    EXPECT_GT(body.moments[0], 0.0);
    EXPECT_LE(body.moments[0], body.moments[1]);
    EXPECT_LE(body.moments[1], body.moments[2]);
    expect_rigid(body.model_from_body);
  }
  expect_joints(ragdoll, size);
  expect_parts_held(character, pose, ragdoll, size);

  // The pose gives the places, and the places the pose; also after the bodies have moved.
  std::vector<Affine3d> places(ragdoll.bodies.size());
  ASSERT_TRUE(place_bodies(ragdoll, pose, places));
  for (std::size_t i = 0; i < places.size(); ++i)
    expect_same(places[i], ragdoll.bodies[i].model_from_body, size);
  ModelPose back = pose;
  ASSERT_TRUE(pose_of_bodies(ragdoll, places, back));
  for (std::size_t bone = 0; bone < pose.model_from_bone.size(); ++bone)
    expect_same(back.model_from_bone[bone], pose.model_from_bone[bone], size);
  for (Affine3d& place : places) {
    const Eigen::AngleAxisd turn(random.uniform(-3, 3), Eigen::Vector3d(random.direction()));
    place.linear() = turn.toRotationMatrix() * place.linear();
    place.translation() += size * random.direction();
  }
  ASSERT_TRUE(pose_of_bodies(ragdoll, places, back));
  std::vector<Affine3d> again(places.size());
  ASSERT_TRUE(place_bodies(ragdoll, back, again));
  for (std::size_t i = 0; i < places.size(); ++i) expect_same(again[i], places[i], size);
}

}  // namespace sunder::test
