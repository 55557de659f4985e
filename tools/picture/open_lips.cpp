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
  CharacterInstanceOptions options;
  options.has_normals = options.has_tangents = false;
  options.soft.emplace();
  options.soft->decomposition.range = kRange;
  Result<CharacterInstance> instance = CharacterInstance::create(std::move(character), options);
  if (!instance) return instance;
  if (const Status status = instance->body()->set_tension({kTension, {}}); !status) return status;
  return instance;
}

Status open_lips(CharacterInstance& instance, const ModelPose& pose) {
  for (int i = 0; i < kMostSteps; ++i) {
    if (const Status status = instance.advance(pose, kPictureStep); !status) return status;
    if (instance.body()->awake_count() == 0) break;
  }
  return {};
}

void displace(const CharacterInstance& instance, std::vector<DeformedMesh>& posed) {
  for (std::uint32_t m = 0; m < posed.size(); ++m) {
    const std::span<const Vec3f> positions = instance.mesh(m).positions;
    posed[m].positions.assign(positions.begin(), positions.end());
  }
}

}  // namespace sunder::tools
