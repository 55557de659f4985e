#include "particles/bullet/bullet_particles.h"

#include <algorithm>
#include <cmath>
#include <unordered_map>

#include "particles/internal/angular_frequency.h"
#include "particles/internal/tolerances.h"

namespace sunder::particles {
namespace {

/// The assumed length of a substep until the first one.
constexpr double kLikelySubstepSeconds = 1.0 / 60;

double scale_of(const Affine3d& world_from_model) {
  return std::cbrt(world_from_model.linear().determinant());
}

}  // namespace

BulletParticles::BulletParticles(btDynamicsWorld& world, const BulletBodyOptions& options,
                                 const Affine3d& world_from_model)
    : world_(&world),
      options_(options),
      world_from_model_(world_from_model),
      substep_(kLikelySubstepSeconds),
      bodies_(world, options),
      springs_(options) {}

BulletParticles::~BulletParticles() {
  if (is_in_world_) world_->removeAction(this);
}

Status BulletParticles::create(const ParticleSet& set, const ModelPose& pose) {
  if (Status status = rest_.evaluate(set, pose, world_from_model_, scratch_.new_target); !status)
    return status;
  pose_ = pose;
  match(set, scratch_.new_target);
  rest_.set_target(rest_.places());
  world_->addAction(this);
  is_in_world_ = true;
  read();
  return {};
}

Status BulletParticles::before_step(const ParticleSet& set, const ModelPose& pose, double seconds,
                                    const Affine3d& world_from_model) {
  if (Status status = rest_.evaluate(set, pose, world_from_model, scratch_.new_target); !status)
    return status;
  if (set.revision() != revision_ || set.particle_count() != bodies_.count()) {
    if (Status status = rest_.evaluate(set, pose_, world_from_model_, scratch_.old_target); !status)
      return status;
    match(set, scratch_.old_target);
  }
  pose_ = pose;
  rest_.set_target(scratch_.new_target);
  if (seconds > 0)
    rest_.begin(seconds, substep_);
  else
    jump(world_from_model);
  world_from_model_ = world_from_model;
  read_gravity();
  pull(substep_);
  read();
  return {};
}

void BulletParticles::after_step() {
  // stepSimulation() cleared the rest of them.
  of_particles_.given.setZero();
  read();
}

void BulletParticles::updateAction(btCollisionWorld*, btScalar seconds) {
  substep_ = double{seconds};
  if (!(substep_ > 0)) return;
  rest_.advance(substep_);
  pull(substep_);
}

/// For each particle of a set its previous index; kNone for new ones.
std::vector<Index> BulletParticles::old_indices(const ParticleSet& set) const {
  std::unordered_map<std::uint64_t, Index> old_of_serial;
  for (Index i = 0; i < bodies_.count(); ++i) old_of_serial.emplace(of_particles_.serials[i], i);
  std::vector<Index> old_of(set.particle_count(), kNone);
  for (Index i = 0; i < set.particle_count(); ++i)
    if (const auto old = old_of_serial.find(set.serial(i)); old != old_of_serial.end())
      old_of[i] = old->second;
  return old_of;
}

/// The motion of all particles of a set: their own, or that of their parents.
BulletParticles::MotionColumns BulletParticles::inherit(const ParticleSet& set,
                                                        const std::vector<Index>& old_of) const {
  const Index count = set.particle_count(), old_count = bodies_.count();
  MotionColumns motion{Columns::Zero(3, count), Columns::Zero(3, count), Columns::Zero(3, count)};
  const auto add_old = [&](Index to, double weight, Index old) {
    motion.displacement.col(to) += weight * (bodies_.place(old) - rest_.places().col(old));
    motion.velocity.col(to) += weight * bodies_.velocity(old);
    motion.lag.col(to) += weight * (rest_.target().col(old) - rest_.places().col(old));
  };
  for (Index i = 0; i < count; ++i)
    if (old_of[i] != kNone) add_old(i, 1.0, old_of[i]);
  for (Index i = 0; i < count; ++i) {
    if (old_of[i] != kNone) continue;
    // Parents have their indices before the tear. With several tears between two calls, parents of
    // later tears may be new themselves.
    const ParticleInfluences& parents = set.parents(i);
    for (std::size_t k = 0; k < parents.particles.size(); ++k) {
      const double weight = double{parents.weights[k]};
      const Index parent = parents.particles[k];
      if (!(weight > 0) || parent >= std::max(count, old_count)) continue;
      if (parent < old_count) {
        add_old(i, weight, parent);
        continue;
      }
      for (Columns* columns : {&motion.displacement, &motion.velocity, &motion.lag})
        columns->col(i) += weight * Vec3d(columns->col(parent));
    }
  }
  return motion;
}

BulletParticles::Columnwise BulletParticles::columns_for(const ParticleSet& set,
                                                         const std::vector<Index>& old_of) const {
  const Index count = set.particle_count();
  Columnwise columns{std::vector<std::uint64_t>(count), std::vector<double>(count),
                     Columns::Zero(3, count), Columns::Zero(3, count), Columns::Zero(3, count)};
  for (Index i = 0; i < count; ++i) {
    columns.serials[i] = set.serial(i);
    columns.still[i] = still_speed(set.range(i));
    if (old_of[i] == kNone) continue;
    columns.given.col(i) = of_particles_.given.col(old_of[i]);
    columns.rest_velocity.col(i) = of_particles_.rest_velocity.col(old_of[i]);
  }
  return columns;
}

void BulletParticles::make_room(Index count) {
  scratch_.held.assign(count, 0);  // first: is_matched()
  for (Columns* columns : {&scratch_.relative, &scratch_.displaced})
    *columns = Columns::Zero(3, count);
  displacements_.assign(count, Vec4f::Zero());
  springs_.make_room(count);
}

/// Gives the particles of the set bodies.
/// @param places  their rest places, if the target still has those of the previous particles.
void BulletParticles::match(const ParticleSet& set, const Columns& places) {
  const Index count = set.particle_count();
  const std::vector<Index> old_of = old_indices(set);
  const MotionColumns motion = inherit(set, old_of);
  std::vector<ParticleBody> made(count);
  for (Index i = 0; i < count; ++i)
    if (old_of[i] == kNone)
      made[i] = bodies_.make(options_.radius * set.range(i) * scale_of(world_from_model_),
                             still_speed(set.range(i)));
  std::vector<SubstepSprings::Pair> pairs = springs_.pairs_of(set);
  Columnwise columns = columns_for(set, old_of);
  Columns rest = places - motion.lag;
  make_room(count);

  // After this line only Bullet can fail.
  bodies_.follow(std::move(made), old_of);
  for (Index i = 0; i < count; ++i) {
    bodies_.put(i, rest.col(i) + motion.displacement.col(i));
    bodies_[i].setUserIndex(static_cast<int>(i));
    if (old_of[i] == kNone) bodies_.enter(i, motion.velocity.col(i));
    bodies_[i].activate(true);
  }
  rest_.follow(std::move(rest));
  springs_.connect(std::move(pairs));
  of_particles_ = std::move(columns);
  revision_ = set.revision();
}

double BulletParticles::still_speed(double range) const {
  return kBulletStillRanges * range * scale_of(world_from_model_) *
         std::max(1.0, angular_frequency(options_.return_frequency) /
                           std::max(1.0, 2 * options_.damping_ratio));
}

/// Gives bodies their masses and weights for a substep. A load that rests on a body displaced by u
/// should press on it with the force m k u, and Bullet adds its impulses after those of the
/// springs. So the body has the mass with which the spring's change of velocity corresponds to that
/// force. An implicit solver for springs and contacts would use about that mass, too.
void BulletParticles::weigh(double seconds) {
  const SubstepSpring& spring = springs_.return_spring();
  const double k = squared_frequency(options_.return_frequency),
               beta = spring.stiffness / (1 + spring.damping);
  bodies_.weigh(k > 0 && beta > 0 ? options_.mass * k * seconds / beta : options_.mass, gravity_);
}

void BulletParticles::read_gravity() {
  if (!(options_.weight > 0)) return;
  const Vec3d gravity = options_.weight * to_vec(world_->getGravity());
  if (gravity == gravity_) return;
  gravity_ = gravity;
  springs_.forget_substep();
  bodies_.activate_all();
}

/// Moves the model to the target at once: displacements and velocities rotate with it.
void BulletParticles::jump(const Affine3d& world_from_model) {
  const Mat3d turn = world_from_model.linear() * world_from_model_.linear().inverse();
  const bool turns = world_from_model.linear() != world_from_model_.linear();
  if (turns || rest_.moves()) {
    for (Index i = 0; i < bodies_.count(); ++i) {
      const Vec3d velocity = bodies_.velocity(i) - of_particles_.rest_velocity.col(i);
      bodies_.put(i, rest_.target().col(i) + turn * (bodies_.place(i) - rest_.places().col(i)));
      bodies_[i].setLinearVelocity(to_bullet(turn * velocity));
      bodies_[i].activate();
    }
    of_particles_.rest_velocity.setZero();
  }
  rest_.jump();
}

/// Gives the bodies the forces of the springs in the coming substep, and removes the previous ones.
/// Forces and not velocities, so that Bullet finds a body still if springs hold it against a
/// contact.
void BulletParticles::pull(double seconds) {
  const double part = rest_.part_of_way(seconds);
  if (!is_matched()) return;
  if (!(part > 0) && !bodies_.is_any_awake()) return;
  if (springs_.set_substep(seconds)) weigh(seconds);
  Columns& rest_velocity = of_particles_.rest_velocity;
  rest_velocity = (part / seconds) * (rest_.target() - rest_.places());
  for (Index i = 0; i < bodies_.count(); ++i) {
    scratch_.held[i] = bodies_.is_held(i) ? 1 : 0;
    scratch_.displaced.col(i) = bodies_.place(i) - rest_.places().col(i);
    scratch_.relative.col(i) = bodies_.velocity(i) - rest_velocity.col(i);
  }
  give(seconds, springs_.solve(scratch_.relative, scratch_.displaced, scratch_.held));
}

/// @param velocities  after the substep, relative to rest.
void BulletParticles::give(double seconds, const Columns& velocities) {
  const double wakes =
      kBulletWakesStills * std::min(1.0, angular_frequency(options_.return_frequency) * seconds);
  for (Index i = 0; i < bodies_.count(); ++i) {
    if (scratch_.held[i] != 0) continue;
    btRigidBody& of = bodies_[i];
    const Vec3d change = velocities.col(i) - scratch_.relative.col(i);
    if (of.isActive())
      of_particles_.balance.col(i) = change;
    else if ((change - of_particles_.balance.col(i)).norm() > wakes * of_particles_.still[i])
      of.activate();
    const Vec3d force = change / (seconds * double{of.getInvMass()});
    of.applyCentralForce(to_bullet(force - of_particles_.given.col(i)));
    of_particles_.given.col(i) = force;
  }
}

void BulletParticles::read() {
  if (!is_matched()) return;
  const Mat3d model_from_world = world_from_model_.linear().inverse();
  for (Index i = 0; i < bodies_.count(); ++i)
    displacements_[i].head<3>() =
        (model_from_world * (bodies_.place(i) - rest_.places().col(i))).cast<float>();
}

}  // namespace sunder::particles
