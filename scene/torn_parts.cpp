#include "scene/torn_parts.h"

#include <sunder/skinning/pose.h>

namespace sunder::scene {

Status TornParts::make_soft(const SoftTissue& soft,
                            const std::shared_ptr<const ParticleAsset>& asset) {
  Result<ParticleSet> set = ParticleSet::create(asset, model);
  return set ? make_body(soft, std::move(*set)) : set.error();
}

Status TornParts::make_body(const SoftTissue& soft, ParticleSet set) {
  const Result<ModelPose> rest = rest_pose(model.source());
  if (!rest) return rest.error();
  body.reset();
  particles = std::make_unique<ParticleSet>(std::move(set));
  Result<SoftBody> made = SoftBody::create(*particles, *rest, soft.materials, soft.body);
  if (!made) return made.error();
  if (Status status = made->set_gravity(soft.gravity); !status) return status;
  if (Status status = made->set_tension(soft.tension); !status) return status;
  body.emplace(std::move(*made));
  return {};
}

}  // namespace sunder::scene
