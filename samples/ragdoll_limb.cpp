// ragdoll_limb MODEL BONE: a limb is cut off a character while its clip plays. The limb falls as a
// ragdoll of a Bullet world, posed by its bodies, and the character moves on without it.

#include <sunder/aim/aim.h>
#include <sunder/io/character_file.h>
#include <sunder/ragdoll/ragdoll.h>
#include <sunder/scene/character_instance.h>
#include <sunder/skinning/pose.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>
#include <optional>
#include <utility>
#include <variant>
#include <vector>

#include "samples/bullet_ragdoll.h"

namespace {

constexpr double kFrame = 1.0 / 60;

int fail(const sunder::Status& status) { return std::printf("%s\n", status.text().data()), 1; }

/// The pose of a character at a time of its first clip.
sunder::Result<sunder::ModelPose> pose_at(const sunder::Character& character, double time) {
  if (character.clips.empty()) return rest_pose(character);
  const double duration = double{character.clips[0].duration};
  return make_pose(character, sunder::ClipPose{0u, duration > 0 ? std::fmod(time, duration) : 0});
}

/// Cuts the limb off in this pose and takes it off.
sunder::Result<sunder::DetachedPiece> sever(sunder::CharacterInstance& instance, const char* bone,
                                            const sunder::ModelPose& pose) {
  sunder::SeverOperation at;
  at.pose = pose;
  at.place = {bone, 0.2};
  if (const auto status = instance.prepare_to_tear(); !status) return status;
  const auto possible = at_nearest_share(*instance.model(), at);
  if (!possible) return possible.error();
  const auto cut = resolve(*instance.model(), *possible);
  if (!cut) return cut.error();
  const auto pieces =
      severed_pieces(*instance.model(), std::get<sunder::SeverOperation>(*possible));
  if (!pieces) return pieces.error();
  if (const auto report = instance.apply(*cut); !report) return report.error();
  sunder::DetachOptions options;
  options.motion = sunder::PieceMotion::animated;
  return instance.detach(pose, pieces->severed.front(), options);
}

/// The limb: its own instance, which the bodies of its ragdoll pose.
struct Limb {
  btDynamicsWorld& world;
  const sunder::Ragdoll ragdoll;
  sunder::CharacterInstance instance;
  sunder::ModelPose pose;
  samples::BulletRagdoll bodies{ragdoll, world};

  static sunder::Result<std::unique_ptr<Limb>> create(const sunder::DetachedPiece& piece,
                                                      const sunder::ModelPose& before,
                                                      const sunder::ModelPose& pose,
                                                      btDynamicsWorld& world) {
    auto ragdoll = make_ragdoll(*piece.character, pose);
    if (!ragdoll) return ragdoll.error();
    auto instance = sunder::CharacterInstance::create(piece.character);
    if (!instance) return instance.error();
    auto limb = std::make_unique<Limb>(world, *std::move(ragdoll), *std::move(instance), pose);
    limb->start_with_motion(before);
    return limb;
  }
  Limb(btDynamicsWorld& physics, sunder::Ragdoll made, sunder::CharacterInstance actor,
       const sunder::ModelPose& start)
      : world(physics), ragdoll(std::move(made)), instance(std::move(actor)), pose(start) {}
  /// The bodies go on as the clip moved them: their places a frame ago give their velocities.
  void start_with_motion(const sunder::ModelPose& before) {
    std::vector<sunder::Affine3d> from(ragdoll.bodies.size());
    if (!place_bodies(ragdoll, before, from)) return;
    for (std::size_t i = 0; i < from.size(); ++i) {
      const sunder::Affine3d& to = ragdoll.bodies[i].model_from_body;
      const Eigen::AngleAxisd turn(sunder::Mat3d(to.linear() * from[i].linear().transpose()));
      const sunder::Vec3d speed = (to.translation() - from[i].translation()) / kFrame;
      const sunder::Vec3d spin = turn.angle() / kFrame * turn.axis();
      bodies.bodies()[i]->setLinearVelocity(
          {btScalar(speed.x()), btScalar(speed.y()), btScalar(speed.z())});
      bodies.bodies()[i]->setAngularVelocity(
          {btScalar(spin.x()), btScalar(spin.y()), btScalar(spin.z())});
    }
  }
  sunder::Status advance() {
    if (const auto status = pose_of_bodies(ragdoll, bodies.places(), pose); !status) return status;
    if (const auto status = instance.advance(pose, kFrame); !status) return status;
    return instance.draw();
  }
  /// The heights of its lowest and highest vertex.
  [[nodiscard]] std::pair<float, float> heights() {
    float lowest = HUGE_VALF, highest = -HUGE_VALF;
    for (std::uint32_t m = 0; m < instance.character().meshes.size(); ++m)
      for (const sunder::Vec3f& position : instance.mesh(m).positions) {
        lowest = std::min(lowest, position.y());
        highest = std::max(highest, position.y());
      }
    return {lowest, highest};
  }
};

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3) return std::printf("usage: ragdoll_limb MODEL BONE\n"), 2;
  const auto loaded = sunder::load_character(argv[1]);
  if (!loaded) return fail(loaded.error());
  const sunder::Character& character = *loaded->character;
  auto instance = sunder::CharacterInstance::create(loaded->character);
  if (!instance) return fail(instance.error());

  btDefaultCollisionConfiguration configuration;
  btCollisionDispatcher dispatcher(&configuration);
  btDbvtBroadphase broadphase;
  btSequentialImpulseConstraintSolver solver;
  btDiscreteDynamicsWorld world(&dispatcher, &broadphase, &solver, &configuration);
  world.setGravity({0, -9.81f, 0});
  btStaticPlaneShape plane({0, 1, 0}, 0);
  btRigidBody ground(btRigidBody::btRigidBodyConstructionInfo(0, nullptr, &plane));
  world.addRigidBody(&ground);

  std::unique_ptr<Limb> limb;
  std::optional<sunder::ModelPose> before;
  for (int frame = 0; frame < 20 * 60; ++frame) {
    const auto pose = pose_at(character, frame * kFrame);
    if (!pose) return fail(pose.error());
    if (frame == 30) {
      const auto piece = sever(*instance, argv[2], *pose);
      if (!piece) return fail(piece.error());
      auto made = Limb::create(*piece, *before, *pose, world);
      if (!made) return fail(made.error());
      limb = *std::move(made);
      for (const sunder::RagdollBody& body : limb->ragdoll.bodies)
        std::printf("%s: %.3f kg\n", character.skeleton.bones[body.bone].name.c_str(), body.mass);
    }
    before = *pose;
    if (const auto status = instance->advance(*pose, kFrame); !status) return fail(status);
    if (const auto status = instance->draw(); !status) return fail(status);
    world.stepSimulation(btScalar(kFrame), 8, btScalar(kFrame / 4));
    if (!limb) continue;
    if (const auto status = limb->advance(); !status) return fail(status);
    if (frame % 120 == 119)
      std::printf("%.0f s: the limb's lowest vertex is at a height of %.3f m\n", frame * kFrame,
                  double{limb->heights().first});
  }
  float speed = 0;
  for (const auto& body : limb->bodies.bodies())
    speed = std::max(speed, body->getLinearVelocity().length());
  const auto [lowest, highest] = limb->heights();
  const bool lies = std::abs(lowest) < 0.5f * (highest - lowest) && speed < 0.1f;
  std::printf("the limb %s\n", lies ? "lies on the ground" : "is lost");
  limb.reset();
  world.removeRigidBody(&ground);
  return lies ? 0 : 1;
}
