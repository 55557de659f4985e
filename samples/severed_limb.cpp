// A limb is cut off a character that moves on. It comes free as a rigid body of a Bullet world,
// with its mass and hulls, and falls to the ground. The character skins and simulates it no more.

#include <sunder/bodies/convex_hulls.h>
#include <sunder/scene/character_instance.h>
#include <sunder/tear/detached_piece.h>

#include <cstdio>
#include <memory>
#include <vector>

#include <btBulletDynamicsCommon.h>

#include "samples/tube.h"

namespace {

constexpr float kFrame = 1.0f / 60;

/// A piece as a body of the engine's world. The body's frame is that of the piece's only bone.
class Limb {
 public:
  Limb(const sunder::DetachedPiece& piece, const std::vector<sunder::ConvexHull>& hulls) {
    for (const sunder::ConvexHull& hull : hulls) {
      auto& shape = shapes_.emplace_back(std::make_unique<btConvexHullShape>());
      for (const sunder::Vec3d& point : hull.points)
        shape->addPoint(btVector3(float(point.x()), float(point.y()), float(point.z())), false);
      shape->recalcLocalAabb();
      shape->setMargin(0.002f);
      compound_.addChildShape(btTransform::getIdentity(), shape.get());
    }
    const sunder::Quatd turn(piece.model_from_piece.linear());
    const sunder::Vec3d& centre = piece.mass.centre;
    const btTransform place(
        btQuaternion(float(turn.x()), float(turn.y()), float(turn.z()), float(turn.w())),
        btVector3(float(centre.x()), float(centre.y()), float(centre.z())));
    // Principal axes: the tensor is diagonal in the piece's frame.
    const sunder::Vec3d moments = piece.inertia_piece.diagonal();
    const btVector3 inertia(float(moments.x()), float(moments.y()), float(moments.z()));
    body_ = std::make_unique<btRigidBody>(btRigidBody::btRigidBodyConstructionInfo(
        float(piece.mass.mass), nullptr, &compound_, inertia));
    body_->setWorldTransform(place);
    body_->setDamping(0.02f, 0.2f);
  }
  [[nodiscard]] btRigidBody& body() { return *body_; }

 private:
  std::vector<std::unique_ptr<btConvexHullShape>> shapes_;
  btCompoundShape compound_;
  std::unique_ptr<btRigidBody> body_;
};

/// Cuts the upper end of the tube off in its present pose.
sunder::Result<sunder::DetachedPiece> cut_off(sunder::CharacterInstance& instance) {
  sunder::PlaneCut cut;
  cut.point = sunder::Vec3d(0, 0.7, 0);
  cut.normal = sunder::Vec3d(0, 1, 0.3);
  cut.caps = true;
  const auto report = instance.cut(instance.pose(), cut);
  if (!report) return report.error();
  return instance.detach(instance.pose(), sunder::PieceNear{sunder::Vec3d(0, 2, 0)});
}

int fail(const sunder::Status& status) { return std::printf("%s\n", status.text().data()), 1; }

}  // namespace

int main() {
  if (!sunder::has_convex_hulls()) return std::printf("built without Qhull\n"), 0;
  // The world of an engine, with a ground.
  btDefaultCollisionConfiguration configuration;
  btCollisionDispatcher dispatcher(&configuration);
  btDbvtBroadphase broadphase;
  btSequentialImpulseConstraintSolver solver;
  btDiscreteDynamicsWorld world(&dispatcher, &broadphase, &solver, &configuration);
  world.setGravity({0, -9.81f, 0});
  btStaticPlaneShape plane({0, 1, 0}, 0);
  btRigidBody ground(btRigidBody::btRigidBodyConstructionInfo(0, nullptr, &plane));
  world.addRigidBody(&ground);

  const auto tube = std::make_shared<const sunder::Character>(samples::make_tube());
  auto instance = sunder::CharacterInstance::create(tube, {});
  if (!instance) return fail(instance.error());
  std::unique_ptr<Limb> limb;
  for (int frame = 0; frame < 240; ++frame) {
    const double angle = 0.4 * std::sin(0.05 * frame);  // the character plays on
    if (const auto status = instance->advance(samples::bent(*tube, angle), double{kFrame}); !status)
      return fail(status);
    if (frame == 30) {
      const auto piece = cut_off(*instance);
      if (!piece) return fail(piece.error());
      const auto hulls = convex_hulls(*piece, {4, 32});
      if (!hulls) return fail(hulls.error());
      std::printf("the limb has %zu triangles, %.2f kg and %zu hulls\n",
                  piece->character->meshes[0].triangles.size(), piece->mass.mass, hulls->size());
      limb = std::make_unique<Limb>(*piece, *hulls);
      world.addRigidBody(&limb->body());
    }
    world.stepSimulation(kFrame, 4);
    if (!limb || frame % 30 != 29) continue;
    const btVector3& at = limb->body().getWorldTransform().getOrigin();
    std::printf("%.1f s: the limb is at a height of %.2f m\n", double{kFrame} * (frame + 1),
                double{at.y()});
  }
  const float height = limb->body().getWorldTransform().getOrigin().y();
  const bool lies =
      height > 0.02f && height < 0.3f && limb->body().getLinearVelocity().length() < 1;
  world.removeRigidBody(&limb->body());
  world.removeRigidBody(&ground);
  std::printf("the limb %s\n", lies ? "lies on the ground" : "is lost");
  return lies ? 0 : 1;
}
