#include "tools/open_lips.h"

#include <sunder/skinning/deform.h>
#include <sunder/skinning/pose.h>

#include <utility>

namespace sunder::tools {
namespace {

constexpr double kRange =
    0.075;  ///< Of a particle, of the diagonal: how far from the lips the tissue gives way.
constexpr double kTension =
    1.3;  ///< Newtons a metre: against the stiffness and mass of the default material.
constexpr double kStep = 1.0 / 60;
constexpr int kMostSteps = 180;

}  // namespace

Result<OpenLips> OpenLips::create(const TornModel& model) {
  const ModelPose rest = bind_pose(model.character());
  DecompositionOptions options;
  options.range = kRange;
  Result<ParticleSet> particles = ParticleSet::create(model, rest, options);
  if (!particles) return particles.error();
  OpenLips lips;
  lips.particles_ = std::make_unique<ParticleSet>(std::move(*particles));
  const SoftMaterial tissue;
  Result<SoftBody> body = SoftBody::create(*lips.particles_, rest, std::span(&tissue, 1));
  if (!body) return body.error();
  lips.body_ = std::make_unique<SoftBody>(std::move(*body));
  if (const Status status = lips.body_->set_tension({kTension, {}}); !status) return status;
  return lips;
}

Status OpenLips::follow(const TornModel& model, std::span<const ChangeRecord> changes) {
  return particles_->follow(model, changes);
}

Status OpenLips::step(const TornModel& model, const ModelPose& pose) {
  return body_->step(model, pose, kStep);
}

Status OpenLips::open(const TornModel& model, const ModelPose& pose) {
  for (int i = 0; i < kMostSteps; ++i) {
    if (const Status status = step(model, pose); !status) return status;
    if (body_->awake_count() == 0) break;
  }
  return {};
}

void OpenLips::displace(std::vector<DeformedMesh>& posed) const {
  for (std::uint32_t m = 0; m < posed.size(); ++m) {
    const std::span<const std::uint32_t> points = particles_->vertex_points(m);
    for (std::size_t v = 0; v < points.size(); ++v)
      if (points[v] != kNone)
        posed[m].positions[v] += body_->point_displacement(points[v]).cast<float>();
  }
}

}  // namespace sunder::tools
