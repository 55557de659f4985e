#include "particles/bullet/particle_bodies.h"

#include <BulletDynamics/ConstraintSolver/btTypedConstraint.h>

static_assert(sizeof(btScalar) == sizeof(float),
              "the host's Bullet world must have single precision");

namespace sunder::particles {
namespace {

/// Removes the constraints on a body from the world; connected bodies wake.
void remove_constraints(btDynamicsWorld& world, const btRigidBody& body) {
  for (int i = world.getNumConstraints(); i-- > 0;) {
    btTypedConstraint* constraint = world.getConstraint(i);
    if (&constraint->getRigidBodyA() != &body && &constraint->getRigidBodyB() != &body) continue;
    constraint->getRigidBodyA().activate();
    constraint->getRigidBodyB().activate();
    world.removeConstraint(constraint);
  }
}

/// Wakes the bodies that touch a body.
void wake_touching(btDynamicsWorld& world, const btRigidBody& body) {
  btDispatcher* dispatcher = world.getDispatcher();
  for (int i = 0; i < dispatcher->getNumManifolds(); ++i) {
    const btPersistentManifold* manifold = dispatcher->getManifoldByIndexInternal(i);
    if (manifold->getBody0() != &body && manifold->getBody1() != &body) continue;
    manifold->getBody0()->activate();
    manifold->getBody1()->activate();
  }
}

}  // namespace

ParticleBodies::~ParticleBodies() {
  for (ParticleBody& leaving : bodies_) leave(leaving);
}

bool ParticleBodies::is_held(Index particle) const {
  const btRigidBody& body = (*this)[particle];
  return body.getInvMass() <= 0 || body.isStaticOrKinematicObject();
}

bool ParticleBodies::is_any_awake() const {
  for (const ParticleBody& of : bodies_)
    if (of.body->isActive()) return true;
  return false;
}

ParticleBody ParticleBodies::make(double radius, double still_speed) const {
  ParticleBody made;
  made.shape = std::make_unique<btSphereShape>(static_cast<btScalar>(radius));
  // Without inertia the body does not rotate.
  btRigidBody::btRigidBodyConstructionInfo info(static_cast<btScalar>(options_.mass), nullptr,
                                                made.shape.get());
  info.m_friction = static_cast<btScalar>(options_.friction);
  info.m_linearSleepingThreshold = static_cast<btScalar>(still_speed);
  made.body = std::make_unique<btRigidBody>(info);
  made.body->setAngularFactor(0);
  made.body->setFlags(made.body->getFlags() | BT_DISABLE_WORLD_GRAVITY);
  return made;
}

void ParticleBodies::follow(std::vector<ParticleBody> bodies, const std::vector<Index>& old_of) {
  for (std::size_t i = 0; i < bodies.size(); ++i)
    if (!bodies[i].body) bodies[i] = std::move(bodies_[old_of[i]]);
  for (ParticleBody& leaving : bodies_)
    if (leaving.body) leave(leaving);
  bodies_ = std::move(bodies);
}

void ParticleBodies::enter(Index particle, const Vec3d& velocity) {
  btRigidBody& body = (*this)[particle];
  body.setLinearVelocity(to_bullet(velocity));
  world_->addRigidBody(&body, options_.collision_group,
                       options_.collision_mask & ~options_.collision_group);
}

void ParticleBodies::put(Index particle, const Vec3d& place) {
  btRigidBody& body = (*this)[particle];
  btTransform transform = body.getWorldTransform();
  transform.setOrigin(to_bullet(place));
  body.setWorldTransform(transform);
  body.setInterpolationWorldTransform(transform);
}

void ParticleBodies::weigh(double mass, const Vec3d& gravity) {
  for (Index i = 0; i < count(); ++i) {
    if (is_held(i)) continue;
    (*this)[i].setMassProps(static_cast<btScalar>(mass), {0, 0, 0});
    if (options_.weight > 0) (*this)[i].setGravity(to_bullet(options_.mass / mass * gravity));
  }
}

void ParticleBodies::activate_all() {
  for (ParticleBody& of : bodies_) of.body->activate();
}

/// Removes a body from the world, with its constraints; bodies that touch it wake.
void ParticleBodies::leave(ParticleBody& leaving) {
  btRigidBody* body = leaving.body.get();
  if (body == nullptr || !body->isInWorld()) return;
  remove_constraints(*world_, *body);
  wake_touching(*world_, *body);
  world_->removeRigidBody(body);
}

}  // namespace sunder::particles
