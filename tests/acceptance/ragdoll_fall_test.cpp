// Whole characters fall as ragdolls in a Bullet world for 20 seconds: no energy is gained, joints
// hold together, and nothing sinks into the ground.

#include <sunder/io/character_file.h>
#include <sunder/ragdoll/ragdoll.h>
#include <sunder/skinning/pose.h>

#include <algorithm>
#include <cctype>
#include <cmath>

#include <gtest/gtest.h>

#include "samples/bullet_ragdoll.h"
#include "support/models/rigs.h"
#include "support/models/shared_models.h"
#include "support/oracles/ragdoll_laws.h"

namespace sunder::test {
namespace {

constexpr double kGravity = 9.81;

/// A world with a ground at y = 0.
struct World {
  btDefaultCollisionConfiguration configuration;
  btCollisionDispatcher dispatcher{&configuration};
  btDbvtBroadphase broadphase;
  btSequentialImpulseConstraintSolver solver;
  btDiscreteDynamicsWorld world{&dispatcher, &broadphase, &solver, &configuration};
  btStaticPlaneShape plane{{0, 1, 0}, 0};
  btRigidBody ground{btRigidBody::btRigidBodyConstructionInfo(0, nullptr, &plane)};

  World() {
    world.setGravity({0, btScalar(-kGravity), 0});
    world.getSolverInfo().m_numIterations = 60;  // chains of ten bodies, feet lighter than trunks
    world.addRigidBody(&ground);
  }
  World(const World&) = delete;
  World& operator=(const World&) = delete;
  ~World() { world.removeRigidBody(&ground); }

  /// The greatest depth of any body below the ground, metres.
  [[nodiscard]] double depth() {
    double depth = 0;
    for (int m = 0; m < dispatcher.getNumManifolds(); ++m) {
      const btPersistentManifold* const manifold = dispatcher.getManifoldByIndexInternal(m);
      for (int c = 0; c < manifold->getNumContacts(); ++c)
        depth = std::max(depth, -double{manifold->getContactPoint(c).getDistance()});
    }
    return depth;
  }
};

double energy_of(const Ragdoll& ragdoll, const samples::BulletRagdoll& limp) {
  double energy = 0;
  for (std::size_t i = 0; i < ragdoll.bodies.size(); ++i) {
    const btRigidBody& body = *limp.bodies()[i];
    const btVector3 spin =
        body.getWorldTransform().getBasis().transpose() * body.getAngularVelocity();
    const Vec3d& moments = ragdoll.bodies[i].moments;
    energy +=
        ragdoll.bodies[i].mass * (0.5 * double{body.getLinearVelocity().length2()} +
                                  kGravity * double{body.getWorldTransform().getOrigin().y()});
    for (int axis = 0; axis < 3; ++axis)
      energy += 0.5 * moments[axis] * double{spin[axis]} * double{spin[axis]};
  }
  return energy;
}

/// The greatest distance between the two sides of a joint.
double gap_of(const Ragdoll& ragdoll, const std::vector<Affine3d>& places) {
  double gap = 0;
  for (std::size_t i = 0; i < places.size(); ++i) {
    const RagdollBody& body = ragdoll.bodies[i];
    if (body.parent == kNone) continue;
    const Vec3d at_parent = places[body.parent] * Vec3d(body.parent_from_joint.translation());
    gap = std::max(gap, (at_parent - places[i] * Vec3d(body.body_from_joint.translation())).norm());
  }
  return gap;
}

/// By how much any hinge is beyond its limit, radians. (Of cones Bullet limits three angles in
/// turn, which are those of swing and twist for small swings only.)
double hinge_excess_of(const Ragdoll& ragdoll, const std::vector<Affine3d>& places) {
  std::vector<Quatd> turns(places.size());
  EXPECT_TRUE(joint_turns(ragdoll, places, turns));
  double excess = 0;
  for (std::size_t i = 0; i < places.size(); ++i)
    if (ragdoll.bodies[i].parent != kNone && ragdoll.bodies[i].limit.kind == BoneLimit::Kind::hinge)
      excess = std::max(excess, beyond_limit(turns[i], ragdoll.bodies[i].limit));
  return excess;
}

class RagdollFalls : public testing::TestWithParam<std::filesystem::path> {};

TEST_P(RagdollFalls, without_gaining_energy) {
  const auto loaded = load_character(GetParam());
  ASSERT_TRUE(loaded) << loaded.error().text();
  const Character& character = *loaded->character;
  // 1.7 m large, whatever the unit of the file, and half a metre above the ground.
  ModelPose pose = *rest_pose(character);
  const double scale = 1.7 / posed_diagonal(character, pose);
  double lowest = HUGE_VAL;
  for (std::uint32_t m = 0; m < character.meshes.size(); ++m)
    for (const Vec3d& position : posed_positions(character, m, pose))
      lowest = std::min(lowest, scale * position.y());
  const Affine3d place = Eigen::Translation3d(0, 0.5 - lowest, 0) * Eigen::Scaling(scale);
  for (Affine3d& matrix : pose.model_from_bone) matrix = place * matrix;
  const auto ragdoll = make_ragdoll(character, pose);
  ASSERT_TRUE(ragdoll) << ragdoll.error().text();

  World world;
  const samples::BulletRagdoll limp(*ragdoll, world.world);
  const double start = energy_of(*ragdoll, limp);
  double mass = 0;
  for (const RagdollBody& body : ragdoll->bodies) mass += body.mass;
  double most = start, depth = 0, gap = 0, resting_depth = 0, resting_gap = 0;
  for (int frame = 0; frame < 20 * 60; ++frame) {
    world.world.stepSimulation(1.0f / 60, 8, 1.0f / 240);
    most = std::max(most, energy_of(*ragdoll, limp));
    depth = std::max(depth, world.depth());
    gap = std::max(gap, gap_of(*ragdoll, limp.places()));
    if (frame == 15 * 60) resting_depth = resting_gap = 0;
    resting_depth = std::max(resting_depth, world.depth());
    resting_gap = std::max(resting_gap, gap_of(*ragdoll, limp.places()));
  }
  EXPECT_LE(most - start, 0.02 * mass * kGravity * 0.5) << "as much as falling 1 cm gives";
  EXPECT_LT(energy_of(*ragdoll, limp), start);
  EXPECT_LT(depth, 0.08) << "a step of the impact, at 3 m/s, is 1.3 cm";

  const bool is_chain =
      GetParam().stem() == "many_bones";  // one of 16 is 500 times as heavy as another
  EXPECT_LT(resting_depth, is_chain ? 0.03 : 0.01);
  EXPECT_LT(resting_gap, is_chain ? 0.04 : 0.01);
  EXPECT_LT(gap, is_chain ? 0.5 : 0.1);
  EXPECT_LT(hinge_excess_of(*ragdoll, limp.places()), 0.1);
  ModelPose end = pose;
  ASSERT_TRUE(pose_of_bodies(*ragdoll, limp.places(), end));
  EXPECT_LT(posed_diagonal(character, end), 4 * 1.7);
}

INSTANTIATE_TEST_SUITE_P(models, RagdollFalls, testing::ValuesIn(rigged_gltf_models()),
                         [](const auto& model) {
                           std::string name = model.param.stem().string();
                           for (char& c : name)
                             if (std::isalnum(static_cast<unsigned char>(c)) == 0) c = '_';
                           return name + "_" + std::to_string(model.index);
                         });

}  // namespace
}  // namespace sunder::test
