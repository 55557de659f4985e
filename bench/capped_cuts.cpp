#include "bench/capped_cuts.h"

#include <sunder/skinning/pose.h>

#include <algorithm>
#include <cstdlib>

#include "bench/in_turns.h"
#include "bench/measure.h"
#include "bench/repeated_operation.h"
#include "support/rigs.h"

#if SUNDER_BENCH_VTK
#include "bench/vtk_peer.h"
#endif

namespace sunder::bench {
namespace {

/// Medians of one size, in seconds.
struct OneSize {
  double plain = 0, capped = 0;
  std::optional<double> vtk;
};

OneSize measure(int divisions) {
  RepeatedOperation plain(scene_of(divisions), cut_in_two);
  RepeatedOperation capped(scene_of(divisions), cut_with_caps);
  std::vector<Candidate> candidates;
  candidates.push_back({[&] { return plain.run(); }, {4, 0.3, 1}, 5, 1});
  candidates.push_back({[&] { return capped.run(); }, {4, 0.3, 1}, 5, 1});
#if SUNDER_BENCH_VTK
  VtkPeer peer(scene_of(divisions));
  candidates.push_back({[&] { return peer.clip(); }, {4, 0.3, 1}, 5, 1});
#endif
  measure_in_turns(candidates);
  OneSize result{median(candidates[0].seconds), median(candidates[1].seconds), {}};
  if (candidates.size() > 2) result.vtk = median(candidates[2].seconds);
  return result;
}

}  // namespace

CappedCuts measure_capped_cuts() {
  CappedCuts result;
  for (std::size_t i = 0; i < kDivisions.size(); ++i) {
    const OneSize size = measure(kDivisions[i]);
    result.filling_seconds[i] = size.capped - size.plain;
    if (!size.vtk) continue;
    if (!result.vs_vtk) result.vs_vtk = result.filling_vs_vtk = CappedCuts::Figures{};
    (*result.vs_vtk)[i] = size.capped / *size.vtk;
    (*result.filling_vs_vtk)[i] = result.filling_seconds[i] / *size.vtk;
  }
  return result;
}

TwentyCuts cut_twenty_times() {
  const auto source = std::make_shared<const Character>(test::make_tube(101, 36, 8));
  auto model = TornModel::create(source);
  const auto pose = bind_pose(*source);
  if (!model || !pose) std::abort();
  Eigen::AlignedBox3d box;
  for (const Vec3f& position : source->meshes[0].positions)
    box.extend(Eigen::Vector3d(position.cast<double>()));
  test::Random random(3);
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

}  // namespace sunder::bench
