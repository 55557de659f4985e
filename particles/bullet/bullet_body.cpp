#include <sunder/particles/bullet_body.h>

#include <cmath>
#include <new>

#include "particles/bullet/bullet_particles.h"

namespace sunder {
namespace particles {
namespace {

Status check(const BulletBodyOptions& options) {
  const auto refuse = [](const char* what, double value, const char* wanted) {
    return Status::failure(StatusCode::invalid_argument, kNone, "%s is %g; it must be %s", what,
                           value, wanted);
  };
  const auto is_at_least_zero = [](double value) { return value >= 0 && std::isfinite(value); };
  const auto is_positive = [](double value) { return value > 0 && std::isfinite(value); };
  if (!(options.return_frequency >= 0 && options.return_frequency <= 1e150))
    return refuse("return_frequency", options.return_frequency, "in [0, 1e150]");
  if (!(options.damping_ratio >= 0 && options.damping_ratio <= 10))
    return refuse("damping_ratio", options.damping_ratio, "in [0, 10]");
  if (!is_at_least_zero(options.neighbour_stiffness))
    return refuse("neighbour_stiffness", options.neighbour_stiffness, "finite and not below 0");
  if (!is_positive(options.mass)) return refuse("mass", options.mass, "finite and above 0");
  if (!is_positive(options.radius)) return refuse("radius", options.radius, "finite and above 0");
  if (!is_at_least_zero(options.friction))
    return refuse("friction", options.friction, "finite and not below 0");
  if (!is_at_least_zero(options.weight))
    return refuse("weight", options.weight, "finite and not below 0");
  if (options.collision_group == 0) return refuse("collision_group", 0, "non-zero");
  return {};
}

Status check(const Affine3d& world_from_model) {
  if (!world_from_model.matrix().allFinite())
    return Status::failure(StatusCode::non_finite_value, kNone, "world_from_model is not finite");
  if (!(world_from_model.linear().determinant() > 0))
    return Status::failure(StatusCode::invalid_argument, kNone,
                           "world_from_model mirrors or flattens: its determinant is %g",
                           world_from_model.linear().determinant());
  return {};
}

}  // namespace
}  // namespace particles

bool has_bullet_body() { return true; }

BulletBody::BulletBody(std::unique_ptr<particles::BulletParticles> particles)
    : particles_(std::move(particles)) {}
BulletBody::~BulletBody() = default;
BulletBody::BulletBody(BulletBody&&) noexcept = default;
BulletBody& BulletBody::operator=(BulletBody&&) noexcept = default;

Result<BulletBody> BulletBody::create(const ParticleSet& set, btDynamicsWorld& world,
                                      const ModelPose& pose, const BulletBodyOptions& options,
                                      const Affine3d& world_from_model) {
  if (Status status = particles::check(options); !status) return status;
  if (Status status = particles::check(world_from_model); !status) return status;
  try {
    auto made = std::make_unique<particles::BulletParticles>(world, options, world_from_model);
    if (Status status = made->create(set, pose); !status) return status;
    return BulletBody(std::move(made));
  } catch (const std::bad_alloc&) {
    return Status::failure(StatusCode::limit_exceeded, kNone, "out of memory");
  }
}

Status BulletBody::before_step(const ParticleSet& set, const ModelPose& pose, double seconds) {
  return before_step(set, pose, seconds, particles_->world_from_model());
}

Status BulletBody::before_step(const ParticleSet& set, const ModelPose& pose, double seconds,
                               const Affine3d& world_from_model) {
  if (!(seconds >= 0) || !std::isfinite(seconds))
    return Status::failure(StatusCode::invalid_argument, kNone,
                           "the time step is %g s; it must be finite and not below 0", seconds);
  if (Status status = particles::check(world_from_model); !status) return status;
  try {
    return particles_->before_step(set, pose, seconds, world_from_model);
  } catch (const std::bad_alloc&) {
    return Status::failure(StatusCode::limit_exceeded, kNone, "out of memory");
  }
}

void BulletBody::after_step() { particles_->after_step(); }
std::span<const Vec4f> BulletBody::displacements() const { return particles_->displacements(); }
std::uint32_t BulletBody::particle_count() const { return particles_->bodies().count(); }
btRigidBody& BulletBody::body(std::uint32_t particle) const {
  SUNDER_ASSERT(particle < particle_count());
  return particles_->bodies()[particle];
}

}  // namespace sunder
