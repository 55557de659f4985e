#pragma once

#include <BulletDynamics/Dynamics/btActionInterface.h>

#include "particles/bullet/particle_bodies.h"
#include "particles/bullet/rest_path.h"
#include "particles/bullet/substep_springs.h"

namespace sunder::particles {

/// The data of a BulletBody: lets springs act on the bodies of particles in every substep of the
/// world.
class BulletParticles final : public btActionInterface {
 public:
  BulletParticles(btDynamicsWorld& world, const BulletBodyOptions& options,
                  const Affine3d& world_from_model);
  ~BulletParticles() override;
  BulletParticles(const BulletParticles&) = delete;
  BulletParticles& operator=(const BulletParticles&) = delete;

  /// As BulletBody::create() and BulletBody::before_step(), with checked arguments. @throws
  /// std::bad_alloc
  Status create(const ParticleSet& set, const ModelPose& pose);
  Status before_step(const ParticleSet& set, const ModelPose& pose, double seconds,
                     const Affine3d& world_from_model);
  void after_step();

  /// Bullet calls this at the end of every substep, so it prepares the next one.
  void updateAction(btCollisionWorld* world, btScalar seconds) override;
  void debugDraw(btIDebugDraw*) override {}

  [[nodiscard]] std::span<const Vec4f> displacements() const { return displacements_; }
  [[nodiscard]] const Affine3d& world_from_model() const { return world_from_model_; }
  [[nodiscard]] const ParticleBodies& bodies() const { return bodies_; }

 private:
  /// Entries per particle that keep their particle when the set changes.
  struct Columnwise {
    std::vector<std::uint64_t> serials;
    std::vector<double> still;  ///< Metres per second below which a particle is still.
    Columns rest_velocity;
    Columns given;  ///< Forces of the springs given to the bodies last, newtons.
    /// The change of velocity by springs when a body was last awake, metres per second.
    Columns balance;
  };
  /// The motion of a particle, which new ones inherit.
  struct MotionColumns {
    Columns displacement, velocity;
    Columns lag;  ///< Distance of the rest place from its target.
  };

  void match(const ParticleSet& set, const Columns& places);
  [[nodiscard]] std::vector<Index> old_indices(const ParticleSet& set) const;
  [[nodiscard]] MotionColumns inherit(const ParticleSet& set,
                                      const std::vector<Index>& old_of) const;
  [[nodiscard]] Columnwise columns_for(const ParticleSet& set,
                                       const std::vector<Index>& old_of) const;
  void make_room(Index count);
  /// False if memory ran out in match(): no springs act until the next before_step().
  [[nodiscard]] bool is_matched() const { return scratch_.held.size() == bodies_.count(); }
  void jump(const Affine3d& world_from_model);
  void pull(double seconds);
  void give(double seconds, const Columns& velocities);
  void weigh(double seconds);
  void read_gravity();
  void read();
  [[nodiscard]] double still_speed(double range) const;

  btDynamicsWorld* world_;
  BulletBodyOptions options_;
  Affine3d world_from_model_;
  bool is_in_world_ = false;
  std::uint64_t revision_ = 0;  ///< Of the set.
  ModelPose pose_;              ///< Of the target of rest_.
  double substep_;              ///< Seconds of the last one.
  Vec3d gravity_ = Vec3d::Zero();
  ParticleBodies bodies_;
  RestPath rest_;
  SubstepSprings springs_;
  Columnwise of_particles_;
  struct Scratch {
    Columns new_target, old_target, displaced, relative;
    std::vector<char> held;
  } scratch_;
  std::vector<Vec4f> displacements_;
};

}  // namespace sunder::particles
