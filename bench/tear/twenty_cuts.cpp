#include "bench/tear/twenty_cuts.h"

#include <sunder/skinning/pose.h>
#include <sunder/tear/torn_model.h>

#include <algorithm>
#include <cstdlib>

#include "bench/harness/measure.h"
#include "support/models/rigs.h"

namespace sunder::bench {

TwentyCuts cut_twenty_times(std::uint32_t seed) {
  const auto source = std::make_shared<const Character>(test::make_tube(101, 36, 8));
  auto model = TornModel::create(source);
  const auto pose = bind_pose(*source);
  if (!model || !pose) std::abort();
  Eigen::AlignedBox3d box;
  for (const Vec3f& position : source->meshes[0].positions)
    box.extend(Eigen::Vector3d(position.cast<double>()));
  test::Random random(seed);
  TwentyCuts result;
  for (int i = 0; i < 20; ++i) {
    PlaneCut cut;
    Eigen::Vector3d at;
    for (double& coordinate : at) coordinate = random.uniform(0.25, 0.75);
    cut.point = box.min() + at.cwiseProduct(box.sizes());
    cut.normal = random.direction();
    cut.caps = true;
    result.slowest_seconds = std::max(result.slowest_seconds, seconds_of([&] {
                                        if (!model->cut(*pose, cut)) std::abort();
                                      }));
  }
  for (const Triangle& triangle : model->character().meshes[0].triangles)
    result.faces += is_retired(triangle) ? 0 : 1;
  return result;
}

TwentyCuts worst_of_twenty_cuts() {
  constexpr std::uint32_t kSeeds = 12;
  TwentyCuts worst;
  for (std::uint32_t seed = 1; seed <= kSeeds; ++seed) {
    const TwentyCuts cuts = cut_twenty_times(seed);
    worst.faces = std::max(worst.faces, cuts.faces);
    worst.slowest_seconds = std::max(worst.slowest_seconds, cuts.slowest_seconds);
  }
  return worst;
}

}  // namespace sunder::bench
