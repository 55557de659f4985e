#include "scene/torn_parts.h"

#include <sunder/skinning/pose.h>

namespace sunder::scene {

Status TornParts::make_soft(const SoftTissue& soft) {
  // At rest lengths are metres; bind space may have any unit, such as that of quantised positions.
  const Result<ModelPose> rest = rest_pose(model.source());
  if (!rest) return rest.error();
  Result<ParticleSet> divided = ParticleSet::create(model, *rest, soft.decomposition);
  if (!divided) return divided.error();
  particles.emplace(std::move(*divided));
  Result<SoftBody> made = SoftBody::create(*particles, *rest, soft.materials, soft.body);
  if (!made) return made.error();
  if (Status status = made->set_gravity(soft.gravity); !status) return status;
  if (Status status = made->set_tension(soft.tension); !status) return status;
  body.emplace(std::move(*made));
  return {};
}

}  // namespace sunder::scene
