#pragma once

#include <sunder/ragdoll/ragdoll.h>

#include <algorithm>
#include <memory>
#include <numbers>
#include <variant>
#include <vector>

#include <btBulletDynamicsCommon.h>

namespace samples {

inline btTransform to_bullet(const sunder::Affine3d& frame) {
  btMatrix3x3 turn;
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 3; ++column)
      turn[row][column] = static_cast<btScalar>(frame.linear()(row, column));
  const sunder::Vec3d at = frame.translation();
  return btTransform(turn, btVector3(btScalar(at.x()), btScalar(at.y()), btScalar(at.z())));
}

inline sunder::Affine3d from_bullet(const btTransform& frame) {
  const btQuaternion turn = frame.getRotation();
  const btVector3& at = frame.getOrigin();
  sunder::Affine3d place = sunder::Affine3d::Identity();
  place.linear() =
      sunder::Quatd(double{turn.w()}, double{turn.x()}, double{turn.y()}, double{turn.z()})
          .normalized()
          .toRotationMatrix();
  place.translation() = sunder::Vec3d(double{at.x()}, double{at.y()}, double{at.z()});
  return place;
}

/// A ragdoll as bodies and joints of a Bullet world.
class BulletRagdoll {
 public:
  BulletRagdoll(const sunder::Ragdoll& ragdoll, btDynamicsWorld& world) : world_(world) {
    for (const sunder::RagdollBody& body : ragdoll.bodies) add_body(body);
    for (std::size_t i = 0; i < ragdoll.bodies.size(); ++i)
      if (ragdoll.bodies[i].parent != sunder::kNone) add_joint(ragdoll.bodies[i], *bodies_[i]);
  }
  BulletRagdoll(const BulletRagdoll&) = delete;
  BulletRagdoll& operator=(const BulletRagdoll&) = delete;
  ~BulletRagdoll() {
    for (const auto& joint : joints_) world_.removeConstraint(joint.get());
    for (const auto& body : bodies_) world_.removeRigidBody(body.get());
  }

  /// Where the bodies are, for pose_of_bodies().
  [[nodiscard]] std::vector<sunder::Affine3d> places() const {
    std::vector<sunder::Affine3d> places;
    for (const auto& body : bodies_) places.push_back(from_bullet(body->getWorldTransform()));
    return places;
  }
  [[nodiscard]] const std::vector<std::unique_ptr<btRigidBody>>& bodies() const { return bodies_; }

 private:
  static std::unique_ptr<btCollisionShape> shape_of(const sunder::Collider& collider) {
    if (const auto* ball = std::get_if<sunder::Collider::Sphere>(&collider.shape))
      return std::make_unique<btSphereShape>(btScalar(ball->radius));
    if (const auto* box = std::get_if<sunder::Collider::Box>(&collider.shape)) {
      const sunder::Vec3d& half = box->half_size;
      return std::make_unique<btBoxShape>(
          btVector3(btScalar(half.x()), btScalar(half.y()), btScalar(half.z())));
    }
    const auto& capsule = std::get<sunder::Collider::Capsule>(collider.shape);
    return std::make_unique<btCapsuleShape>(btScalar(capsule.radius),
                                            btScalar(2 * capsule.half_length));
  }

  void add_body(const sunder::RagdollBody& from) {
    shapes_.push_back(shape_of(from.shape));
    auto compound = std::make_unique<btCompoundShape>();
    sunder::Affine3d body_from_shape = sunder::Affine3d::Identity();
    body_from_shape.linear() = from.shape.turn.toRotationMatrix();
    body_from_shape.translation() = from.shape.place;
    compound->addChildShape(to_bullet(body_from_shape), shapes_.back().get());
    const btVector3 moments(btScalar(from.moments.x()), btScalar(from.moments.y()),
                            btScalar(from.moments.z()));
    const btRigidBody::btRigidBodyConstructionInfo info(btScalar(from.mass), nullptr,
                                                        compound.get(), moments);
    bodies_.push_back(std::make_unique<btRigidBody>(info));
    shapes_.push_back(std::move(compound));
    bodies_.back()->setWorldTransform(to_bullet(from.model_from_body));
    bodies_.back()->setDamping(0.05f, 0.3f);
    bodies_.back()->setFriction(0.8f);
    // Parts of one character overlap at their joints, so they collide with the rest of the world.
    world_.addRigidBody(bodies_.back().get(), btBroadphaseProxy::CharacterFilter,
                        btBroadphaseProxy::AllFilter ^ btBroadphaseProxy::CharacterFilter);
  }

  void add_joint(const sunder::RagdollBody& from, btRigidBody& body) {
    auto joint = std::make_unique<btGeneric6DofSpring2Constraint>(
        *bodies_[from.parent], body, to_bullet(from.parent_from_joint),
        to_bullet(from.body_from_joint), RO_XYZ);
    joint->setLinearLowerLimit({0, 0, 0});
    joint->setLinearUpperLimit({0, 0, 0});
    const bool is_hinge = from.limit.kind == sunder::BoneLimit::Kind::hinge;
    const double swing = is_hinge ? 0.0 : from.limit.cone;
    // The middle angle must stay below a right one, else the three angles are not unique.
    const auto y = btScalar(std::min(swing, 1.4)), z = btScalar(swing);
    // The angles of this joint count the other way round, and from -pi to pi.
    constexpr double kPi = std::numbers::pi;
    joint->setAngularLowerLimit({btScalar(-std::min(from.limit.upper, kPi)), -y, -z});
    joint->setAngularUpperLimit({btScalar(-std::max(from.limit.lower, -kPi)), y, z});
    world_.addConstraint(joint.get(), true);
    joints_.push_back(std::move(joint));
  }

  btDynamicsWorld& world_;
  std::vector<std::unique_ptr<btCollisionShape>> shapes_;
  std::vector<std::unique_ptr<btRigidBody>> bodies_;
  std::vector<std::unique_ptr<btTypedConstraint>> joints_;
};

}  // namespace samples
