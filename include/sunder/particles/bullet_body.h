#pragma once

#ifdef BT_USE_DOUBLE_PRECISION
#error "sunder::BulletBody is for Bullet in single precision (Debian's libBulletDynamics, not its -float64 variant)"
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
  /// k: a particle alone is pulled to its rest place by k x its displacement, per mass; 1/s^2; >= 0. It swings with sqrt(k) / 2 pi
  /// hertz.
  double return_stiffness = 400.0;
  /// Of every spring: 0 swings for ever, 1 comes back without swinging; in [0, 10].
  double damping_ratio = 0.3;
  /// Likewise between neighbours, for how their displacements differ, times ParticleSet::coupling(); 1/s^2; >= 0.
  double neighbour_stiffness = 400.0;
  double mass = 0.05;     ///< Of each particle, kg; > 0. It matters where something else is met.
  double radius = 0.3;    ///< Of a particle's sphere, as a part of its range; > 0.
  double friction = 0.5;  ///< Of the spheres; >= 0.
  /// The part of the world's gravity that pulls at particles; >= 0. At 0 the pose is taken for the shape that weight has given
  /// already; at 1 it sags.
  double weight = 0.0;
  int collision_group = 64;  ///< Bits, as of btDynamicsWorld::addRigidBody(); not 0. 1 to 32 are taken by Bullet.
  int collision_mask = -1;   ///< With what particles collide; never with collision_group, so not with one another.
};

/// Whether this build can put particles into a world of Bullet, which is optional (SUNDER_BULLET).
[[nodiscard]] SUNDER_API bool has_bullet_body();

/// Particles whose motion a physics engine owns: each a sphere of the host's Bullet world that does not turn, pulled to its posed
/// rest place and towards what its neighbours do, and in contact with everything else in the world, both ways. A frame is
///
///     body.before_step(set, pose, seconds);
///     world.stepSimulation(seconds, …);
///     body.after_step();                      // displacements() -> SkinnedMesh, or the GPU
///
/// Springs are exact over a substep where they stand alone, implicit in velocity where they are many, and stable for any stiffness:
/// what would swing with less than four substeps a period is as stiff as that and no stiffer. Contacts are Bullet's. What hits a
/// sheet must be wider than the gaps between its spheres; what lies on it presses it in by its weight over mass x return_stiffness,
/// for which bodies are made heavier than `mass` by what their springs do within a substep: little, unless those are stiff for it.
/// Particles sleep as other bodies do, and wake when their rest place moves. What lies on spheres comes to rest where
/// btContactSolverInfo::m_linearSlop is above 0 (a millimetre): else Bullet parts them to the last bit and loses contacts.
///
/// The world must have been built with single precision, must outlive this object, and must clear forces after each
/// stepSimulation() as Bullet's own worlds do. Calls come from the thread that steps the world, outside of its callbacks.
class SUNDER_API BulletBody {
 public:
  /// Adds a body a particle, and an action, to the world. Nothing moves yet.
  ///
  /// @param pose              in which particles are put to rest.
  /// @param world_from_model  places the model in the world: rotation, translation, scale. Spheres keep the size that they get.
  /// @return unsupported_feature where has_bullet_body() is false; invalid_argument for the options and for a placement that
  /// mirrors
  ///         or flattens; non_finite_value for a placement, and as ParticleSet::rest() for the pose; limit_exceeded without enough
  ///         memory. The world is as it was then. O(particles + pairs of neighbours).
  static Result<BulletBody> create(const ParticleSet& set, btDynamicsWorld& world, const ModelPose& pose,
                                   const BulletBodyOptions& options = {}, const Affine3d& world_from_model = Affine3d::Identity());

  /// Removes all that it added from the world.
  ~BulletBody();
  BulletBody(BulletBody&&) noexcept;
  BulletBody& operator=(BulletBody&&) noexcept;

  /// Says where rest places will be after the coming stepSimulation(), and lets springs pull during it. Rest places move there
  /// evenly, so that a model that is carried along lags behind only while it speeds up.
  ///
  /// Where the set's revision changed, bodies follow it: new particles inherit their parents' displacement and velocity, those that
  /// are no more leave the world together with the constraints on them (which the host still owns), and no displacement of the
  /// others jumps although their members are others now.
  ///
  /// @param set      that of create(), moved or not.
  /// @param seconds  until the pose is reached: what stepSimulation() is called with. 0 puts the model there at once: displacements
  ///                 and the velocities relative to it turn with it.
  /// @return as create(); invalid_argument for seconds below 0. Nothing is changed then.
  ///
  /// O(bones + particles); where any is awake also O(pairs of neighbours) at most 64 times, mostly a few. Allocates only where the
  /// set's revision changed.
  Status before_step(const ParticleSet& set, const ModelPose& pose, double seconds);
  Status before_step(const ParticleSet& set, const ModelPose& pose, double seconds, const Affine3d& world_from_model);

  /// Reads displacements back. O(particles).
  void after_step();

  /// How far particles are from where the pose has them: x, y, z, 0; metres, model space. One a particle; valid until the next
  /// call. The last substep's, which Bullet does not interpolate here.
  [[nodiscard]] std::span<const Vec4f> displacements() const;

  [[nodiscard]] std::uint32_t particle_count() const;

  /// A particle's body, for impulses and constraints (the hand that holds). btRigidBody::getUserIndex() is the particle. A body
  /// made kinematic, or of mass 0, is held: springs pull at its neighbours only. Unchecked; lives as long as the particle.
  [[nodiscard]] btRigidBody& body(std::uint32_t particle) const;

 private:
  explicit BulletBody(std::unique_ptr<particles::BulletParticles> particles);
  std::unique_ptr<particles::BulletParticles> particles_;
};

}  // namespace sunder
