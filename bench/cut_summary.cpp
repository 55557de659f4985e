#include "bench/cut_summary.h"

#include <string>
#include <utility>
#include <vector>

#include "bench/in_turns.h"
#include "bench/json_object.h"
#include "bench/measure.h"
#include "bench/repeated_operation.h"

#if SUNDER_BENCH_VTK
#include "bench/vtk_peer.h"
#endif

namespace sunder::bench {

std::optional<std::array<double, kDivisions.size()>> CutFigures::ratios_to_vtk() const {
  if (!vtk_seconds) return std::nullopt;
  std::array<double, kDivisions.size()> ratios = seconds;
  for (std::size_t i = 0; i < ratios.size(); ++i) ratios[i] /= (*vtk_seconds)[i];
  return ratios;
}

CutFigures measure_cuts() {
  CutFigures figures;
  for (std::size_t i = 0; i < kDivisions.size(); ++i) {
    const Scene& scene = scene_of(kDivisions[i]);
    const bool is_large = kDivisions[i] > 3;
    RepeatedOperation cut(scene, cut_in_two);
    std::vector<Candidate> candidates;
    candidates.push_back({[&] { return cut.run(); }, {is_large ? 2 : 20, 1, 1}, 9, 1});
#if SUNDER_BENCH_VTK
    VtkPeer peer(scene);
    candidates.push_back({[&] { return peer.clip(); }, {is_large ? 2 : 20, 1, 1}, 9, 1});
#endif
    measure_in_turns(candidates);
    figures.seconds[i] = median(candidates[0].seconds);
    figures.allocations[i] = static_cast<double>(cut.allocations + cut.undo_allocations);
#if SUNDER_BENCH_VTK
    if (!figures.vtk_seconds) figures.vtk_seconds.emplace();
    (*figures.vtk_seconds)[i] = median(candidates[1].seconds);
#endif
  }
  return figures;
}

void print_cut_summary() {
  const CutFigures figures = measure_cuts();
  const auto by_size = [](auto value) {
    std::vector<std::pair<std::string, double>> named;
    for (std::size_t i = 0; i < kDivisions.size(); ++i)
      named.emplace_back(size_name(kDivisions[i]), value(i));
    return named;
  };
  JsonObject object;
  if (const auto ratios = figures.ratios_to_vtk()) {
    object.add("cut_vs_vtk", by_size([&](std::size_t i) { return (*ratios)[i]; }));
    object.add("vtk_us", by_size([&](std::size_t i) { return 1e6 * (*figures.vtk_seconds)[i]; }));
  }
  object.add("cut_us", by_size([&](std::size_t i) { return 1e6 * figures.seconds[i]; }));
  object.add("cut_and_undo_allocations",
             by_size([&](std::size_t i) { return figures.allocations[i]; }));
  object.end();
}

}  // namespace sunder::bench
