#include "tools/picture/blood_covers.h"

#include <algorithm>
#include <utility>

#include "tools/model/posed_model.h"

namespace sunder::tools {
namespace {

constexpr double kReachOfLength = 0.06;

}  // namespace

Result<BloodCovers> BloodCovers::create(const TornModel& model, const ModelPose& pose,
                                        const ModelLooks& looks, double length) {
  const Result<std::vector<DeformedMesh>> source = pose_positions(model.source(), pose);
  if (!source) return source.error();
  BloodOptions options;
  options.flow_pose = &pose;
  options.reach = blood_reach(bounds_of(model.source(), *source).size().norm());
  if (length > 0) options.reach = std::min(options.reach, kReachOfLength * length);
  Result<BloodLayers> layers = lay_blood(model, *source, looks, options);
  if (!layers) return layers.error();
  BloodCovers covers;
  covers.layers_ = std::move(*layers);
  for (std::size_t m = 0; m < source->size(); ++m) {
    const Mesh& mesh = model.source().meshes[m];
    covers.submeshes_of_.push_back(mesh.submeshes.size());
    const double reach = options.reach * bind_scale(mesh, (*source)[m]);
    covers.reaches_of_.push_back(reach > 0 ? static_cast<float>(1 / reach) : 1.0f);
  }
  return covers;
}

std::vector<std::vector<ModelLooks::Cover>> BloodCovers::add_to(const ModelLooks& looks,
                                                                RenderScene& scene) const {
  std::vector<std::vector<ModelLooks::Cover>> covers(submeshes_of_.size());
  for (const BloodTexture& texture : layers_.textures) {
    RenderMaterial material = looks.of_file(texture.material).material;
    material.image = &texture.image;
    material.factor.head<3>().setOnes();
    if (texture.material == kNone) material.factor = looks.plain_color();
    material.wrap = {};
    material.is_skin = false;
    auto& of_mesh = covers[texture.mesh];
    of_mesh.resize(submeshes_of_[texture.mesh]);
    of_mesh[texture.submesh] = {static_cast<std::uint32_t>(scene.materials.size()), texture.uv_set,
                                texture.image_from_uv};
    scene.materials.push_back(material);
  }
  return covers;
}

}  // namespace sunder::tools
