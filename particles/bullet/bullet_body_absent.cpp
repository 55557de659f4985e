#include <sunder/particles/bullet_body.h>

#include <cstdlib>

namespace sunder {
namespace particles {

class BulletParticles {};

}  // namespace particles

namespace {

Status absent() {
  return Status::failure(StatusCode::unsupported_feature, kNone,
                         "this build cannot put particles into a Bullet world: it was configured "
                         "without Bullet (SUNDER_BULLET)");
}

}  // namespace

bool has_bullet_body() { return false; }

Result<BulletBody> BulletBody::create(const ParticleSet&, btDynamicsWorld&, const ModelPose&,
                                      const BulletBodyOptions&, const Affine3d&) {
  return absent();
}

// No object was ever created.
BulletBody::BulletBody(std::unique_ptr<particles::BulletParticles> particles)
    : particles_(std::move(particles)) {}
BulletBody::~BulletBody() = default;
BulletBody::BulletBody(BulletBody&&) noexcept = default;
BulletBody& BulletBody::operator=(BulletBody&&) noexcept = default;
Status BulletBody::before_step(const ParticleSet&, const ModelPose&, double) { return absent(); }
Status BulletBody::before_step(const ParticleSet&, const ModelPose&, double, const Affine3d&) {
  return absent();
}
void BulletBody::after_step() {}
std::span<const Vec4f> BulletBody::displacements() const { return {}; }
std::uint32_t BulletBody::particle_count() const { return 0; }
btRigidBody& BulletBody::body(std::uint32_t) const { std::abort(); }

}  // namespace sunder
