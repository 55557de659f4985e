#include "bench/tear/weld_figures.h"

#include <sunder/skinning/pose.h>
#include <sunder/tear/topology.h>
#include <sunder/tear/torn_weights.h>

#include <algorithm>
#include <vector>

#include "bench/harness/measure.h"
#include "support/machine/random.h"
#include "support/models/atlas_tube.h"
#include "support/models/make_model.h"
#include "support/models/random_operations.h"
#include "support/models/rigs.h"

namespace sunder::bench {
namespace {

constexpr std::uint32_t kRings = 160, kSides = 120;
constexpr std::size_t kWelds = 60, kPoses = 8;

/// The largest error of what operations made, in diagonals.
double largest_error(const TornModel& model, test::Random& random) {
  std::vector<ModelPose> poses;
  for (std::size_t i = 0; i < kPoses; ++i)
    poses.push_back(test::random_pose(model.source(), random));
  return measure_weight_errors(model, 0, kNone, poses)->of_diagonal.maximum;
}

bool is_whole(const TornModel& model) {
  const TopologyCounts before = *count_topology(model.source()),
                       after = *count_topology(model.character());
  return before.boundary_loops == after.boundary_loops && before.components == after.components;
}

}  // namespace

WeldFigures measure_welds() {
  const Character tube = test::make_atlas_tube(kRings, kSides);
  TornModel model = test::make_model(tube);
  const ModelPose pose = *bind_pose(tube);
  test::Random random(2);
  WeldFigures figures;
  std::vector<double> welds, ratios;
  std::size_t open = 0;
  while (welds.size() < kWelds) {
    const Stroke stroke = test::random_stroke(tube, pose, random, 0.35);
    TearOptions options;
    const bool is_exact = welds.size() % 2 == 0;
    options.weights = WeightOptions{};
    options.weights->policy = is_exact ? WeightPolicy::exact : WeightPolicy::barycentric;
    std::uint32_t runs = 0;
    const double tear = seconds_of([&] { runs = model.tear(pose, stroke, options)->runs; });
    if (runs == 0) continue;
    const double weld = seconds_of([&] { runs = model.weld(pose, {})->runs; });
    open += runs == 0 || !is_whole(model);
    welds.push_back(1e3 * weld);
    if (!is_exact) ratios.push_back(weld / tear);  // tears as they are by default
    double& error = is_exact ? figures.position_error : figures.position_error_barycentric;
    error = std::max(error, largest_error(model, random));
    while (model.undo_count() > 0) (void)model.undo();
  }
  figures.weld_ms = median(welds);
  figures.vs_tear = median(ratios);
  figures.open_share = double(open) / double(welds.size());
  return figures;
}

}  // namespace sunder::bench
