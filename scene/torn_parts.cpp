#include "scene/torn_parts.h"

#include <sunder/skinning/pose.h>

namespace sunder::scene {

Status TornParts::make_soft(const SoftTissue& soft,
                            const std::shared_ptr<const ParticleAsset>& asset) {
  Result<ParticleSet> made = ParticleSet::create(asset, model);
  if (!made) return made.error();
  auto set = std::make_unique<ParticleSet>(std::move(*made));
  Result<SoftBody> of_set = make_body(soft, model.source(), *set);
  if (!of_set) return of_set.error();
  take(std::move(set), std::move(*of_set));
  return {};
}

void TornParts::take(std::unique_ptr<ParticleSet> set, SoftBody made) {
  body.reset();
  particles = std::move(set);
  body.emplace(std::move(made));
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
