#include "tools/model/posed_source.h"

#include <algorithm>
#include <utility>

namespace sunder::tools {
namespace {

constexpr std::size_t kMostSourcePoses = 16, kMostTriangles = 1'000'000;

bool is_same(const ModelPose& a, const ModelPose& b) {
  return a.morph_weights == b.morph_weights &&
         std::ranges::equal(
             a.model_from_bone, b.model_from_bone,
             [](const Affine3d& x, const Affine3d& y) { return x.matrix() == y.matrix(); });
}

}  // namespace

Result<const PosedSurface*> PosedSource::in(const ModelPose& pose) {
  const auto found =
      std::ranges::find_if(kept_, [&](const Kept& kept) { return is_same(kept.pose, pose); });
  if (found != kept_.end()) {
    kept_.splice(kept_.begin(), kept_, found);
    return &kept_.front().surface;
  }
  Result<PosedSurface> surface = pose_surface(*source_, pose);
  if (!surface) return surface.error();
  kept_.push_front({pose, std::move(*surface)});
  const std::size_t triangles = std::max<std::size_t>(1, kept_.front().surface.triangles.size());
  if (kept_.size() > std::clamp<std::size_t>(kMostTriangles / triangles, 1, kMostSourcePoses))
    kept_.pop_back();
  return &kept_.front().surface;
}

}  // namespace sunder::tools
