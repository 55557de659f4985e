#pragma once

#include <sunder/particles/bullet_body.h>

#include <memory>
#include <vector>

#include <BulletCollision/CollisionShapes/btSphereShape.h>
#include <BulletDynamics/Dynamics/btDynamicsWorld.h>
#include <BulletDynamics/Dynamics/btRigidBody.h>

namespace sunder::particles {

inline Vec3d to_vec(const btVector3& v) { return {double{v.x()}, double{v.y()}, double{v.z()}}; }
inline btVector3 to_bullet(const Vec3d& v) {
  return {static_cast<btScalar>(v.x()), static_cast<btScalar>(v.y()), static_cast<btScalar>(v.z())};
}

/// A sphere that does not rotate, for one particle.
struct ParticleBody {
  std::unique_ptr<btSphereShape> shape;
  std::unique_ptr<btRigidBody> body;
};

/// The bodies of particles in the host's Bullet world.
class ParticleBodies {
 public:
  ParticleBodies(btDynamicsWorld& world, const BulletBodyOptions& options)
      : world_(&world), options_(options) {}
  /// Removes all bodies from the world.
  ~ParticleBodies();
  ParticleBodies(const ParticleBodies&) = delete;
  ParticleBodies& operator=(const ParticleBodies&) = delete;

  [[nodiscard]] Index count() const { return static_cast<Index>(bodies_.size()); }
  [[nodiscard]] btRigidBody& operator[](Index particle) const { return *bodies_[particle].body; }
  [[nodiscard]] Vec3d place(Index particle) const {
    return to_vec((*this)[particle].getWorldTransform().getOrigin());
  }
  [[nodiscard]] Vec3d velocity(Index particle) const {
    return to_vec((*this)[particle].getLinearVelocity());
  }
  /// Whether only the host moves a body.
  [[nodiscard]] bool is_held(Index particle) const;
  [[nodiscard]] bool is_any_awake() const;

  /// Makes a body that is not in the world. @param radius  metres. @param still_speed  metres per
  /// second below which it may sleep.
  [[nodiscard]] ParticleBody make(double radius, double still_speed) const;
  /// Replaces all bodies.
  /// @param bodies  new bodies; null: the particle keeps its previous one.
  /// @param old_of  its previous index.
  void follow(std::vector<ParticleBody> bodies, const std::vector<Index>& old_of);
  /// Puts a new body into the world.
  void enter(Index particle, const Vec3d& velocity);

  void put(Index particle, const Vec3d& place);
  /// Sets the mass of all bodies that are not held, and their weight. @param gravity  zero: none.
  void weigh(double mass, const Vec3d& gravity);
  void activate_all();

 private:
  void leave(ParticleBody& leaving);

  btDynamicsWorld* world_;
  BulletBodyOptions options_;
  std::vector<ParticleBody> bodies_;
};

}  // namespace sunder::particles
