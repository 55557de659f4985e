#include "tools/picture/open_lips.h"

#include <utility>

namespace sunder::tools {
namespace {

constexpr double kRange =
    0.075;  ///< Range of particles, as a fraction of the diagonal: how far lips give way.
constexpr double kTension = 1.3;  ///< Newtons per metre; tuned for the default material.
constexpr int kMostSteps = 180;

}  // namespace

Result<CharacterInstance> make_gaping_instance(std::shared_ptr<const Character> character) {
  CharacterAssetOptions options;
  options.has_normals = options.has_tangents = false;
  options.soft.emplace();
  options.soft->decomposition.range = kRange;
  options.soft->tension = {kTension, {}};
  Result<CharacterInstance> instance = CharacterInstance::create(std::move(character), options);
  if (!instance) return instance;
  if (const Status status = instance->prepare_to_tear(); !status) return status;
  return instance;
}

Status open_lips(CharacterInstance& instance, const ModelPose& pose) {
  for (int i = 0; i < kMostSteps; ++i) {
    if (const Status status = instance.advance(pose, kPictureStep); !status) return status;
    if (instance.body()->awake_count() == 0) break;
  }
  return instance.draw();
}

void displace(CharacterInstance& instance, std::vector<DeformedMesh>& posed) {
  for (std::uint32_t m = 0; m < posed.size(); ++m) {
    const std::span<const Vec3f> positions = instance.mesh(m).positions;
    posed[m].positions.assign(positions.begin(), positions.end());
  }
}

}  // namespace sunder::tools
