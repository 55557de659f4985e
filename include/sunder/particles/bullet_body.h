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
  /// k: a particle alone is pulled to its rest place by k times its displacement, per mass; 1/s^2;
  /// >= 0. It swings with sqrt(k) / 2 pi hertz.
  double return_stiffness = 400.0;
  /// Damping ratio of every spring, in [0, 10]: 0 swings for ever, 1 returns without swinging.
  double damping_ratio = 0.3;
  /// The same between neighbours, for the difference of their displacements, times
  /// ParticleSet::coupling(); 1/s^2; >= 0.
  double neighbour_stiffness = 400.0;
  double mass = 0.05;     ///< Kilograms per particle; > 0. It matters in contacts.
  double radius = 0.3;    ///< Radius of a particle's sphere, as a fraction of its range; > 0.
  double friction = 0.5;  ///< Of the spheres; >= 0.
  /// Fraction of the world's gravity that pulls at particles; >= 0. At 0 the pose is taken for the
  /// shape under weight; at 1 it sags.
  double weight = 0.0;
  int collision_group =
      64;  ///< Bits as in btDynamicsWorld::addRigidBody(); not 0. Bullet uses 1 to 32.
  int collision_mask =
      -1;  ///< With what particles collide. Never with collision_group, so not with each other.
};

/// Whether this build can put particles into a Bullet world, which is optional (SUNDER_BULLET).
/// Thread-safe.
[[nodiscard]] SUNDER_API bool has_bullet_body();

/// Particles whose motion a physics engine owns: each is a sphere in the host's Bullet world that
/// does not turn, is pulled to its posed rest place and towards what its neighbours do, and is in
/// contact with everything else in the world, both ways. Call before_step(),
/// btDynamicsWorld::stepSimulation(), after_step() per frame; then displacements() are for
/// SkinnedMesh or the GPU.
///
/// The world must have single precision, must outlive this object, and must clear forces after each
/// stepSimulation() as Bullet's own worlds do. Method, loads and settings of the world:
/// docs/particles.md.
///
/// Not thread-safe: calls come from the thread that steps the world, outside of its callbacks.
class SUNDER_API BulletBody {
 public:
  /// Adds one body per particle, and an action, to the world. Nothing moves yet. O(particles +
  /// pairs of neighbours).
  ///
  /// @param pose              in which particles are put to rest.
  /// @param world_from_model  places the model in the world: rotation, translation, scale. Spheres
  /// keep the size that they get.
  /// @return unsupported_feature where has_bullet_body() is false; invalid_argument for the options
  /// and for a placement that
  ///         mirrors or flattens; non_finite_value for a placement; as ParticleSet::rest() for the
  ///         pose; limit_exceeded out of memory. The world is then as it was.
  static Result<BulletBody> create(const ParticleSet& set, btDynamicsWorld& world,
                                   const ModelPose& pose, const BulletBodyOptions& options = {},
                                   const Affine3d& world_from_model = Affine3d::Identity());

  /// Removes everything that it added from the world.
  ~BulletBody();
  BulletBody(BulletBody&&) noexcept;
  BulletBody& operator=(BulletBody&&) noexcept;

  /// Sets where rest places are after the next stepSimulation(), towards which they move evenly,
  /// and lets springs pull during it. Follows the set where its revision changed: new particles
  /// inherit the motion of their parents, vanished ones leave the world together with the
  /// constraints on them (which the host still owns), and the other displacements do not jump.
  ///
  /// @param set      that of create(), moved or not.
  /// @param seconds  until the pose is reached: the argument of stepSimulation(). 0 puts the model
  /// there at once: displacements and
  ///                 the velocities relative to it turn with it.
  /// @return as create(); invalid_argument for seconds below 0. Nothing is changed then; out of
  /// memory, springs rest until the next. O(bones + particles); where any is awake also O(pairs of
  /// neighbours) at most 64 times, usually a few. Allocates only where the set's revision changed.
  Status before_step(const ParticleSet& set, const ModelPose& pose, double seconds);
  Status before_step(const ParticleSet& set, const ModelPose& pose, double seconds,
                     const Affine3d& world_from_model);

  /// Reads displacements back. O(particles).
  void after_step();

  /// Per particle: its displacement from the rest place after the last substep, x, y, z, 0; metres,
  /// model space. Valid until the next call.
  [[nodiscard]] std::span<const Vec4f> displacements() const;

  [[nodiscard]] std::uint32_t particle_count() const;

  /// The body of a particle, for impulses and constraints; its getUserIndex() is the particle. A
  /// body made kinematic, or of mass 0, is held: springs pull only at its neighbours. Unchecked;
  /// lives as long as the particle.
  [[nodiscard]] btRigidBody& body(std::uint32_t particle) const;

 private:
  explicit BulletBody(std::unique_ptr<particles::BulletParticles> particles);
  std::unique_ptr<particles::BulletParticles> particles_;
};

}  // namespace sunder
