#pragma once

#ifdef BT_USE_DOUBLE_PRECISION
#error "sunder::BulletBody needs Bullet in single precision: undefine BT_USE_DOUBLE_PRECISION"
#endif

#include <sunder/particles/particle_set.h>

#include <memory>
#include <span>

class btDynamicsWorld;
class btRigidBody;

namespace sunder {

namespace particles {
class BulletParticles;
}

struct BulletBodyOptions {
  /// Frequency with which a particle without neighbours and damping swings, hertz, in [0, 1e150].
  /// Its spring has the stiffness k = (2 pi frequency)^2 by mass.
  double return_frequency = 3.2;
  /// Damping ratio of every spring, in [0, 10]: 0 swings for ever, 1 returns without swinging.
  double damping_ratio = 0.3;
  /// Stiffness by mass of the springs between neighbours, for the difference of their
  /// displacements, times ParticleNeighbour::coupling; 1/s^2; >= 0.
  double neighbour_stiffness = 100.0;
  double mass = 0.05;     ///< Kilograms per particle; > 0. It matters in contacts.
  double radius = 0.3;    ///< Radius of a particle's sphere, as a fraction of its range; > 0.
  double friction = 0.5;  ///< Of the spheres; >= 0.
  /// Fraction of the world's gravity that acts on particles; >= 0. With 0 the pose is the shape
  /// under weight; with 1 the tissue sags.
  double weight = 0.0;
  /// Bits as in btDynamicsWorld::addRigidBody(); not 0. Bullet uses 1 to 32.
  int collision_group = 64;
  /// The groups with which particles collide. They never collide with collision_group, so not with
  /// one another.
  int collision_mask = -1;
};

/// Whether this build can put particles into a Bullet world, which is optional (SUNDER_BULLET).
/// Thread-safe.
[[nodiscard]] SUNDER_API bool has_bullet_body();

/// Particles moved by a physics engine. Each is a sphere in the host's Bullet world that does not
/// rotate. Springs pull it to its posed rest and couple it to its neighbours; it collides with
/// everything else in the world. Per frame call before_step(), btDynamicsWorld::stepSimulation(),
/// after_step(); then use displacements() with SkinnedMesh or on the GPU.
///
/// The world must have single precision, must outlive this object, and must clear forces after each
/// stepSimulation(), as Bullet's own worlds do. docs/particles.md describes the method and settings
/// of the world. Not thread-safe: call it from the thread that steps the world, outside of its
/// callbacks.
class SUNDER_API BulletBody {
 public:
  /// Adds one body per particle, and an action, to the world. Nothing moves yet. On failure the
  /// world does not change. O(particles + pairs of neighbours).
  ///
  /// @param pose              the pose in which particles start at rest.
  /// @param world_from_model  places the model in the world: rotation, translation, scale. Spheres
  ///         keep their initial size.
  /// @return unsupported_feature if has_bullet_body() is false; invalid_argument for the options,
  ///         or a placement that mirrors or is singular; non_finite_value for the placement; as
  ///         ParticleSet::rest() for the pose; limit_exceeded if out of memory.
  static Result<BulletBody> create(const ParticleSet& set, btDynamicsWorld& world,
                                   const ModelPose& pose, const BulletBodyOptions& options = {},
                                   const Affine3d& world_from_model = Affine3d::Identity());

  /// Removes its bodies and its action from the world.
  ~BulletBody();
  BulletBody(BulletBody&&) noexcept;
  BulletBody& operator=(BulletBody&&) noexcept;

  /// Sets the rests after the next stepSimulation(), to which they move at constant speed, and lets
  /// springs act during it. Follows a changed set: new particles inherit the motion of their
  /// parents, vanished ones leave the world with their constraints (which the host still owns), and
  /// the displacements of the others do not jump. O(bones + particles); if any is awake, in
  /// addition O(pairs of neighbours) per iteration, at most 64. Allocates only if the set changed.
  ///
  /// @param set      that of create(); it may have been moved.
  /// @param seconds  argument of the next stepSimulation(). 0 moves the model at once;
  ///         displacements and relative velocities rotate with it.
  /// @return as create(); invalid_argument for seconds below 0. Nothing is changed then; if out of
  ///         memory, no springs act until the next call.
  Status before_step(const ParticleSet& set, const ModelPose& pose, double seconds);
  Status before_step(const ParticleSet& set, const ModelPose& pose, double seconds,
                     const Affine3d& world_from_model);

  /// Reads displacements back. O(particles).
  void after_step();

  /// Displacement of each particle from its rest after the last substep: x, y, z, 0; metres, model
  /// space. Valid until the next call.
  [[nodiscard]] std::span<const Vec4f> displacements() const;

  [[nodiscard]] std::uint32_t particle_count() const;

  /// The body of a particle, for impulses and constraints; its getUserIndex() is the particle. A
  /// kinematic body, or one of mass 0, is held: springs only act on its neighbours. The index is
  /// unchecked; the body lives as long as the particle.
  [[nodiscard]] btRigidBody& body(std::uint32_t particle) const;

 private:
  explicit BulletBody(std::unique_ptr<particles::BulletParticles> particles);
  std::unique_ptr<particles::BulletParticles> particles_;
};

}  // namespace sunder
