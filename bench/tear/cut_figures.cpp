#include "bench/tear/cut_figures.h"

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "bench/harness/in_turns.h"
#include "bench/harness/json_object.h"
#include "bench/harness/measure.h"
#include "bench/tear/repeated_operation.h"

#if SUNDER_BENCH_VTK
#include "bench/peers/vtk_peer.h"
#endif

namespace sunder::bench {
namespace {

using BySize = CutFigures::BySize;

std::optional<BySize> divide(BySize values, const std::optional<BySize>& by) {
  if (!by) return std::nullopt;
  for (std::size_t i = 0; i < values.size(); ++i) values[i] /= (*by)[i];
  return values;
}

std::vector<std::pair<std::string, double>> named(const BySize& values, double unit = 1) {
  std::vector<std::pair<std::string, double>> result;
  for (std::size_t i = 0; i < values.size(); ++i)
    result.emplace_back(size_name(kDivisions[i]), unit * values[i]);
  return result;
}

void measure_size(std::size_t i, CutFigures& figures) {
  constexpr int kTurns = 9;
  const Scene& scene = scene_of(kDivisions[i]);
  const Effort effort = {kDivisions[i] > 3 ? 2 : 20, 1, 1};
  RepeatedOperation cut(scene, cut_in_two), capped(scene, cut_with_caps);
  std::vector<Candidate> candidates;
  candidates.push_back({[&] { return cut.run(); }, effort, kTurns, 1});
  candidates.push_back({[&] { return capped.run(); }, effort, kTurns, 1});
#if SUNDER_BENCH_VTK
  VtkPeer peer(scene);
  candidates.push_back({[&] { return peer.clip(); }, effort, kTurns, 1});
#endif
  measure_in_turns(candidates);
  figures.seconds[i] = median(candidates[0].seconds);
  figures.capped_seconds[i] = median(candidates[1].seconds);
  const auto allocations = [](const RepeatedOperation& operation) {
    return static_cast<double>(operation.allocations + operation.undo_allocations);
  };
  figures.allocations[i] = allocations(cut);
  figures.capped_allocations[i] = allocations(capped);
  if (candidates.size() < 3) return;
  if (!figures.vtk_seconds) figures.vtk_seconds.emplace();
  (*figures.vtk_seconds)[i] = median(candidates[2].seconds);
}

}  // namespace

std::optional<BySize> CutFigures::ratios_to_vtk() const { return divide(seconds, vtk_seconds); }

std::optional<BySize> CutFigures::capped_ratios_to_vtk() const {
  return divide(capped_seconds, vtk_seconds);
}

CutFigures measure_cuts() {
  CutFigures figures;
  for (std::size_t i = 0; i < kDivisions.size(); ++i) measure_size(i, figures);
  return figures;
}

std::optional<CutRatios> measure_cut_ratios() {
  const CutFigures figures = measure_cuts();
  const auto plain = figures.ratios_to_vtk(), capped = figures.capped_ratios_to_vtk();
  if (!plain || !capped) return std::nullopt;
  return CutRatios{*std::max_element(plain->begin(), plain->end()), plain->back(),
                   *std::max_element(capped->begin(), capped->end())};
}

void print_cut_summary() {
  constexpr double kMicroseconds = 1e6;
  const CutFigures figures = measure_cuts();
  JsonObject object;
  if (const auto ratios = figures.ratios_to_vtk()) {
    object.add("cut_vs_vtk", named(*ratios));
    object.add("capped_cut_vs_vtk", named(*figures.capped_ratios_to_vtk()));
    object.add("vtk_us", named(*figures.vtk_seconds, kMicroseconds));
  }
  object.add("cut_us", named(figures.seconds, kMicroseconds));
  object.add("capped_cut_us", named(figures.capped_seconds, kMicroseconds));
  object.add("cut_and_undo_allocations", named(figures.allocations));
  object.add("capped_cut_and_undo_allocations", named(figures.capped_allocations));
  object.end();
}

}  // namespace sunder::bench
