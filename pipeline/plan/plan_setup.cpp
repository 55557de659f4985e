#include "pipeline/plan/plan_setup.h"

#include <sunder/skinning/pose.h>

#include <algorithm>
#include <limits>
#include <utility>
#include <vector>

#include "pipeline/plan/check_inputs.h"
#include "pipeline/plan/posed_places.h"

namespace sunder::plan {
namespace {

constexpr double kTolerance = 0.01;         ///< Of the curve's length.
constexpr double kLeastTolerance = 0.0005;  ///< Of the diagonal of the posed character.
/// Errors that count as one, as shares of the tolerance and the depth.
constexpr double kPlaceScale = 0.02, kDepthScale = 0.05;

SplineLimits spline_limits(const BladeChain& chain, const PlanOptions& options) {
  SplineLimits limits;
  limits.values = limits_of(chain);
  limits.speed = limits.acceleration = Values::Constant(static_cast<Eigen::Index>(chain.size()),
                                                        std::numeric_limits<double>::infinity());
  for (std::size_t i = 0; i < chain.size(); ++i) {
    const auto index = static_cast<Eigen::Index>(i);
    if (chain.speed_limit(i) > 0) limits.speed[index] = chain.speed_limit(i);
    if (options.maximum_acceleration > 0) limits.acceleration[index] = options.maximum_acceleration;
  }
  return limits;
}

}  // namespace

double diagonal_of(const Character& character, const ModelPose& pose) {
  std::vector<SurfaceAnchor> places;
  for (std::uint32_t mesh = 0; mesh < character.meshes.size(); ++mesh)
    for (std::uint32_t i = 0; i < character.meshes[mesh].triangle_count(); ++i)
      places.push_back({mesh, {i, {1, 0, 0}}});
  std::vector<Vec3d> posed(places.size());
  if (places.empty() || !PosedPlaces(character, places).pose(pose, posed, {})) return 0;
  Vec3d low = posed[0], high = posed[0];
  for (const Vec3d& place : posed) {
    low = low.cwiseMin(place);
    high = high.cwiseMax(place);
  }
  return (high - low).norm();
}

double usual_tolerance(const Character& character, const TargetPath& path, const ModelPose& pose) {
  return std::max(kTolerance * path.length(), kLeastTolerance * diagonal_of(character, pose));
}

Result<PlanSetup> PlanSetup::create(const std::shared_ptr<const Character>& character,
                                    const WoundTarget& target, const PlanTiming& timing,
                                    const PlanTool& tool, const PlanOptions& options) {
  Result<BladeChain> chain = BladeChain::create(tool);
  if (!chain) return chain.error();
  const Result<ModelPose> pose = make_pose(*character, timing.pose);
  if (!pose) return pose.error();
  Result<TargetPath> path = TargetPath::create(character, target, *pose);
  if (!path) return path.error();
  if (const Status status = check_blade(target, *chain); !status) return status;
  if (const Status status = check_shapes(tool); !status) return status;
  SplineLimits limits = spline_limits(*chain, options);
  PlanSetup setup{std::move(*chain), std::move(*path), options.tolerance, {}, std::move(limits)};
  if (setup.tolerance == 0) setup.tolerance = usual_tolerance(*character, setup.path, *pose);
  setup.scales.place = kPlaceScale * setup.tolerance;
  setup.scales.depth = kDepthScale * *std::min_element(target.depth.begin(), target.depth.end());
  return setup;
}

}  // namespace sunder::plan
