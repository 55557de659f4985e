#include "scene/torn_parts.h"

#include <sunder/skinning/pose.h>

#include <utility>

#include "particles/internal/body_copy.h"

namespace sunder::scene {

Status TornParts::make_soft(const TissueAtRest& tissue,
                            const std::shared_ptr<const ParticleAsset>& asset) {
  Result<ParticleSet> made = ParticleSet::create(asset, model);
  if (!made) return made.error();
  auto set = std::make_unique<ParticleSet>(std::move(*made));
  SoftBody of_set = sunder::particles::copy_body(tissue.body, *set);
  take(std::move(set), std::move(of_set));
  return {};
}

void TornParts::take(std::unique_ptr<ParticleSet> set, SoftBody made) {
  body.reset();
  particles = std::move(set);
  body.emplace(std::move(made));
}

Result<TissueAtRest> make_tissue(const SoftTissue& soft, const TornModel& untorn,
                                 std::shared_ptr<const ParticleAsset> asset) {
  Result<ParticleSet> made = ParticleSet::create(std::move(asset), untorn);
  if (!made) return made.error();
  auto set = std::make_unique<ParticleSet>(std::move(*made));
  Result<SoftBody> body = make_body(soft, untorn.source(), *set);
  if (!body) return body.error();
  return TissueAtRest{std::move(set), std::move(*body)};
}

Result<SoftBody> make_body(const SoftTissue& soft, const Character& source, ParticleSet& set) {
  const Result<ModelPose> rest = rest_pose(source);
  if (!rest) return rest.error();
  Result<SoftBody> made = SoftBody::create(set, *rest, soft.materials, soft.body);
  if (!made) return made;
  if (Status status = made->set_gravity(soft.gravity); !status) return status;
  if (Status status = made->set_tension(soft.tension); !status) return status;
  return made;
}

}  // namespace sunder::scene
