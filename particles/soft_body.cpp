#include <sunder/particles/soft_body.h>

#include <algorithm>
#include <cmath>
#include <new>
#include <tuple>

#include "core/internal/out_of_memory.h"
#include "particles/body_state.h"
#include "particles/clusters/influences.h"
#include "particles/clusters/structure_of.h"
#include "particles/internal/body_copy.h"
#include "particles/internal/recorded_limits.h"
#include "particles/internal/tolerances.h"

namespace sunder {
namespace {

using particles::BodyState;
using particles::for_each_influence;

Status check_vector(const char* what, const Vec3d& value, double most) {
  if (!value.allFinite())
    return Status::failure(StatusCode::non_finite_value, kNone,
                           "%s is (%g, %g, %g); it must be finite", what, value.x(), value.y(),
                           value.z());
  if (value.cwiseAbs().maxCoeff() <= most) return {};
  return Status::failure(StatusCode::invalid_argument, kNone,
                         "%s is (%g, %g, %g); no coordinate may be beyond %g", what, value.x(),
                         value.y(), value.z(), most);
}

Status check_particle(const BodyState& state, Index particle) {
  if (particle < state.motion.count()) return {};
  return Status::failure(StatusCode::index_out_of_range, particle,
                         "particle %u does not exist; there are %u", particle,
                         state.motion.count());
}

Status check_point(const BodyState& state, Index point) {
  if (point >= state.set->point_count())
    return Status::failure(StatusCode::index_out_of_range, point,
                           "point %u does not exist; there are %u", point,
                           state.set->point_count());
  if (!(state.set->influences()[point].weights[0] > 0))
    return Status::failure(StatusCode::invalid_argument, point, "point %u belongs to no particle",
                           point);
  return {};
}

/// Whether an impulse leaves a particle as slow as a recorded one may be.
Status check_speed(const SoftBody& body, const BodyState& state, Index particle,
                   const Vec3d& newton_seconds) {
  const Vec3d velocity = state.motion.velocities[particle] + newton_seconds / body.mass(particle);
  if (velocity.cwiseAbs().maxCoeff() <= particles::kMostRecordedLength) return {};
  return Status::failure(StatusCode::invalid_argument, particle,
                         "an impulse would give particle %u a velocity beyond %g m/s", particle,
                         particles::kMostRecordedLength);
}

void push(const SoftBody& body, BodyState& state, Index particle, const Vec3d& newton_seconds) {
  if (newton_seconds == Vec3d::Zero()) return;
  state.motion.velocities[particle] += newton_seconds / body.mass(particle);
  state.wake_around(particle);
}

Status check_hold(const Vec3d& target, const HoldOptions& options) {
  if (!(options.stiffness > 0) || !(options.stiffness <= 1e12))
    return Status::failure(StatusCode::invalid_argument, kNone,
                           "the stiffness of a hold is %g; it must be above 0 and at most 1e12",
                           options.stiffness);
  return check_vector("the target of a hold", target, particles::kMostRecordedLength);
}

Status check_self_contact(const SelfContact& of) {
  for (const auto& [name, value, most] :
       {std::tuple{"thickness", of.thickness, particles::kMostRecordedLength},
        std::tuple{"friction", of.friction, particles::kMostRecordedForce}})
    if (!(value >= 0 && value <= most))
      return Status::failure(
          std::isfinite(value) ? StatusCode::invalid_argument : StatusCode::non_finite_value, kNone,
          "the %s of the self-contact is %g; it must be from 0 to %g", name, value, most);
  return {};
}

Status check_material(const SoftMaterial& material, Index index) {
  const Status status = validate_material(material);
  if (status) return status;
  return Status::failure(status.code(), index, "%.*s", static_cast<int>(status.text().size()),
                         status.text().data());
}

Status follow(BodyState& state) {
  try {
    state.follow_particles();
    return {};
  } catch (const std::bad_alloc&) {
    return out_of_memory();
  }
}

}  // namespace

SoftBody::SoftBody(std::unique_ptr<BodyState> state) : state_(std::move(state)) {}
SoftBody::~SoftBody() = default;
SoftBody::SoftBody(SoftBody&&) noexcept = default;
SoftBody& SoftBody::operator=(SoftBody&&) noexcept = default;

Result<SoftBody> SoftBody::create(ParticleSet& particles, const ModelPose& pose,
                                  std::span<const SoftMaterial> materials,
                                  const SoftBodyOptions& options) {
  if (materials.empty())
    return Status::failure(StatusCode::empty_input, kNone,
                           "a soft body needs at least one material");
  for (Index i = 0; i < materials.size(); ++i)
    if (Status status = check_material(materials[i], i); !status) return status;
  try {
    if (Status status = check_self_contact(options.self_contact); !status) return status;
    auto state = std::make_unique<BodyState>();
    state->set = &particles;
    state->options = options;
    state->materials.assign(materials.begin(), materials.end());
    if (Status status = state->rests.begin(particles, pose); !status) return status;
    state->revision = particles.revision() + 1;  // of none
    state->follow_particles();
    for (Index p = 0; p < particles.particle_count();
         ++p) {  // what is new wakes; here nothing moves yet
      state->motion.awake[p] = 0;
      state->motion.quiet.seconds[p] = 0;
    }
    state->motion.awake_count = 0;
    return SoftBody(std::move(state));
  } catch (const std::bad_alloc&) {
    return out_of_memory();
  }
}

SoftBody particles::copy_body(const SoftBody& other, ParticleSet& set) {
  auto copy = std::make_unique<BodyState>(BodyStateOf::in(other));
  SUNDER_ASSERT(&StructureOf::in(set) == &StructureOf::in(*copy->set));
  copy->set = &set;
  return BodyStateOf::body_of(std::move(copy));
}

// ---- Materials.

Status SoftBody::set_material(std::uint32_t particle, std::uint32_t material) {
  if (Status status = follow(*state_); !status) return status;
  if (Status status = check_particle(*state_, particle); !status) return status;
  if (material >= state_->materials.size())
    return Status::failure(StatusCode::index_out_of_range, material,
                           "material %u does not exist; there are %zu", material,
                           state_->materials.size());
  if (state_->motion.material_of[particle] == material) return {};
  state_->motion.material_of[particle] = material;
  state_->graph.is_stale = true;
  state_->wake_around(particle);
  return {};
}

Status SoftBody::change_material(std::uint32_t material, const SoftMaterial& to) {
  if (material >= state_->materials.size())
    return Status::failure(StatusCode::index_out_of_range, material,
                           "material %u does not exist; there are %zu", material,
                           state_->materials.size());
  if (Status status = check_material(to, material); !status) return status;
  if (Status status = follow(*state_); !status) return status;
  try {
    SoftMaterial copy = to;
    state_->materials[material] = std::move(copy);
  } catch (const std::bad_alloc&) {
    return out_of_memory();
  }
  state_->graph.is_stale = true;
  for (Index p = 0; p < state_->motion.count(); ++p)
    if (state_->motion.material_of[p] == material) state_->wake_around(p);
  return {};
}

std::uint32_t SoftBody::material_of(std::uint32_t particle) const {
  SUNDER_ASSERT(particle < particle_count());
  return state_->motion.material_of[particle];
}
std::span<const SoftMaterial> SoftBody::materials() const { return state_->materials; }

// ---- What acts.

Status SoftBody::add_impulse(std::uint32_t particle, const Vec3d& newton_seconds) {
  if (Status status = follow(*state_); !status) return status;
  if (Status status = check_particle(*state_, particle); !status) return status;
  if (Status status = check_vector("an impulse", newton_seconds, particles::kMostRecordedForce);
      !status)
    return status;
  if (Status status = check_speed(*this, *state_, particle, newton_seconds); !status) return status;
  push(*this, *state_, particle, newton_seconds);
  return {};
}

Status SoftBody::add_point_impulse(std::uint32_t point, const Vec3d& newton_seconds) {
  if (Status status = follow(*state_); !status) return status;
  if (Status status = check_point(*state_, point); !status) return status;
  if (Status status = check_vector("an impulse", newton_seconds, particles::kMostRecordedForce);
      !status)
    return status;
  const auto& influences = state_->set->influences()[point];
  Status status;
  for_each_influence(influences, [&](Index p, double weight) {
    if (status) status = check_speed(*this, *state_, p, weight * newton_seconds);
  });
  if (!status) return status;
  for_each_influence(influences, [&](Index p, double weight) {
    push(*this, *state_, p, weight * newton_seconds);
  });
  return {};
}

Status SoftBody::set_force(std::uint32_t particle, const Vec3d& newtons) {
  if (Status status = follow(*state_); !status) return status;
  if (Status status = check_particle(*state_, particle); !status) return status;
  if (Status status = check_vector("a force", newtons, particles::kMostRecordedForce); !status)
    return status;
  if (state_->motion.forces[particle] == newtons) return {};
  state_->motion.forces[particle] = newtons;
  state_->wake_around(particle);
  return {};
}

Status SoftBody::set_gravity(const Vec3d& acceleration) {
  if (Status status = check_vector("gravity", acceleration, particles::kMostRecordedForce); !status)
    return status;
  if (state_->outer.gravity == acceleration) return {};
  if (Status status = follow(*state_); !status) return status;
  state_->outer.gravity = acceleration;
  state_->wake_all();
  return {};
}

Status SoftBody::set_wind(WindField wind) {
  if (Status status = follow(*state_); !status) return status;
  // The next step finds the particles that feel it: the end of a wind as well as its beginning.
  if (!wind) state_->wake_all();
  state_->outer.wind = std::move(wind);
  return {};
}

Status SoftBody::set_tension(Tension tension) {
  if (!(tension.newtons_per_metre >= 0 &&
        tension.newtons_per_metre <= particles::kMostRecordedForce))
    return Status::failure(StatusCode::invalid_argument, kNone,
                           "the tension is %g N/m; it must be from 0 to %g",
                           tension.newtons_per_metre, particles::kMostRecordedForce);
  for (std::size_t i = 0; i < tension.shares.size(); ++i)
    if (!(tension.shares[i] >= 0 && tension.shares[i] <= 1))
      return Status::failure(StatusCode::invalid_argument, static_cast<Index>(i),
                             "the share of the tension at point %zu is %g; it must be from 0 to 1",
                             i, static_cast<double>(tension.shares[i]));
  state_->outer.tension = std::move(tension);
  state_->outer.is_tension_stale = true;
  return {};
}

Result<HoldId> SoftBody::hold(std::uint32_t particle, const Vec3d& target,
                              const HoldOptions& options) {
  if (Status status = follow(*state_); !status) return status;
  if (Status status = check_particle(*state_, particle); !status) return status;
  if (Status status = check_hold(target, options); !status) return status;
  try {
    const HoldId hold =
        state_->holds.add_particle(*state_->set, particle, target, options.stiffness);
    state_->outer.is_disturbed = true;
    return hold;
  } catch (const std::bad_alloc&) {
    return out_of_memory();
  }
}

Result<HoldId> SoftBody::hold_point(std::uint32_t point, const Vec3d& target,
                                    const HoldOptions& options) {
  if (Status status = follow(*state_); !status) return status;
  if (Status status = check_point(*state_, point); !status) return status;
  if (Status status = check_hold(target, options); !status) return status;
  try {
    const HoldId hold = state_->holds.add_point(*state_->set, point, target, options.stiffness);
    state_->outer.is_disturbed = true;
    return hold;
  } catch (const std::bad_alloc&) {
    return out_of_memory();
  }
}

Status SoftBody::move_hold(HoldId hold, const Vec3d& target) {
  if (Status status = check_vector("the target of a hold", target, particles::kMostRecordedLength);
      !status)
    return status;
  if (state_->holds.move(hold, target)) {
    state_->outer.is_disturbed = true;
    return {};
  }
  return Status::failure(StatusCode::not_found, kNone, "hold %llu does not exist",
                         static_cast<unsigned long long>(hold));
}

Status SoftBody::release(HoldId hold) {
  if (Status status = follow(*state_); !status) return status;
  ParticleInfluences whom;
  if (!state_->holds.remove(hold, whom))
    return Status::failure(StatusCode::not_found, kNone, "hold %llu does not exist",
                           static_cast<unsigned long long>(hold));
  for_each_influence(whom, [&](Index p, double) { state_->wake_around(p); });
  return {};
}

Status SoftBody::set_colliders(std::span<const Collider> colliders) {
  for (Index i = 0; i < colliders.size(); ++i)
    if (const Status status = validate_collider(colliders[i]); !status)
      return Status::failure(status.code(), i, "collider %u: %.*s", i,
                             static_cast<int>(status.text().size()), status.text().data());
  if (Status status = follow(*state_); !status) return status;
  try {
    state_->contact.set(colliders);
  } catch (const std::bad_alloc&) {
    return out_of_memory();
  }
  for (Index p = 0; p < state_->motion.count(); ++p)
    if (state_->motion.touched[p] != 0) state_->motion.wake(p);
  return {};
}

Status SoftBody::move_collider(std::uint32_t collider, const Vec3d& place, const Quatd& turn) {
  const auto colliders = state_->contact.colliders();
  if (collider >= colliders.size())
    return Status::failure(StatusCode::index_out_of_range, collider,
                           "collider %u does not exist; there are %zu", collider, colliders.size());
  Collider moved = colliders[collider];
  moved.place = place;
  moved.turn = turn;
  if (const Status status = validate_collider(moved); !status)
    return Status::failure(status.code(), collider, "collider %u: %.*s", collider,
                           static_cast<int>(status.text().size()), status.text().data());
  state_->contact.move(collider, place, turn);
  return {};
}

// ---- Motion.

Status SoftBody::step(const TornModel& model, const ModelPose& pose, double seconds,
                      std::uint32_t settled_points) {
  if (!std::isfinite(seconds))
    return Status::failure(StatusCode::non_finite_value, kNone, "the time step is not finite");
  if (seconds < 0)
    return Status::failure(StatusCode::invalid_argument, kNone,
                           "the time step is %g s; it must not be below 0", seconds);
  seconds = std::min(seconds, particles::kLongestStepSeconds);
  BodyState& state = *state_;
  if (state.is_idle()) {
    state.outer.advance(seconds);
    state.rests.skip_step();
    state.contact.skip_step();
    return {};
  }
  if (model.point_count() != state.set->point_count())
    return Status::failure(
        StatusCode::invalid_argument, kNone,
        "the model has %u points, the particles have %u; call ParticleSet::follow() first",
        model.point_count(), state.set->point_count());
  const bool is_posed = !state.rests.is_same(pose);
  if (!is_posed && state.is_still() && state.rests.carried().empty()) {
    state.outer.advance(seconds);
    state.contact.skip_step();
    return {};
  }
  if (is_posed)
    if (Status status = state.set->rest(pose, {}, {}); !status) return status;
  try {
    if (settled_points > 0) (void)state.set->settle(model, settled_points);
    state.follow_particles();
    state.step(model, pose, is_posed, seconds);
  } catch (const std::bad_alloc&) {
    return out_of_memory();
  }
  return {};
}

std::span<const Vec4f> SoftBody::displacements() {
  if (!follow(*state_)) return {};
  return state_->shown.displacements;
}

std::span<const Mat3f> SoftBody::rotations() {
  if (!follow(*state_)) return {};
  return state_->shown.turns;
}

std::span<const IndexRange> SoftBody::moved_vertices(const TornModel& model, std::uint32_t mesh) {
  try {
    const particles::Structure& structure = particles::StructureOf::in(*state_->set);
    SUNDER_ASSERT(mesh < structure.vertex_points.of_mesh.size());
    state_->follow_particles();
    particles::ShownMotion& shown = state_->shown;
    return shown.moved_vertices.of(structure, model, mesh, shown.displaced_key, shown.is_displaced);
  } catch (const std::bad_alloc&) {
    return {};
  }
}

Vec3d SoftBody::place(std::uint32_t particle) const {
  SUNDER_ASSERT(particle < particle_count());
  return state_->rests.place(particle) + state_->motion.displacements[particle];
}
Vec3d SoftBody::displacement(std::uint32_t particle) const {
  SUNDER_ASSERT(particle < particle_count());
  return state_->motion.displacements[particle];
}
Vec3d SoftBody::velocity(std::uint32_t particle) const {
  SUNDER_ASSERT(particle < particle_count());
  return state_->motion.velocities[particle] + state_->rests.velocity(particle);
}

Vec3d SoftBody::point_displacement(std::uint32_t point) const {
  SUNDER_ASSERT(point < state_->set->point_count());
  Vec3d sum = Vec3d::Zero();
  for_each_influence(state_->set->influences()[point],
                     [&](Index p, double weight) { sum += weight * displacement(p); });
  return sum;
}

double SoftBody::mass(std::uint32_t particle) const {
  SUNDER_ASSERT(particle < particle_count());
  const SoftMaterial& material = state_->materials[state_->motion.material_of[particle]];
  if (const particles::PointFactors* factors = particles::factors_at(*state_->set, particle))
    return particles::mass_of(*state_->set, particles::with_factors(material, *factors), particle);
  return particles::mass_of(*state_->set, material, particle);
}
std::uint32_t SoftBody::particle_count() const { return state_->motion.count(); }
bool SoftBody::is_awake(std::uint32_t particle) const {
  SUNDER_ASSERT(particle < particle_count());
  return state_->motion.awake[particle] != 0;
}
bool SoftBody::needs_step() const { return !state_->is_still(); }
std::uint32_t SoftBody::awake_count() const { return state_->motion.awake_count; }
std::size_t SoftBody::memory_bytes() const { return state_->memory_bytes(); }
const ContactReport& SoftBody::contacts() const { return state_->contact.report(); }

std::span<const ThreadLoad> thread_loads(const SoftBody& body) {
  return particles::BodyStateOf::in(body).outer.threads.loads();
}

}  // namespace sunder
