#include "bench/scene/operation_ratios.h"

#include <optional>

#if SUNDER_BENCH_CUTS
#include "bench/tear/cut_figures.h"
#include "bench/tear/removal_times.h"
#endif

namespace sunder::bench {

#if SUNDER_BENCH_CUTS

void add_operation_ratios(JsonObject& object) {
  object.add("width_vs_tear", width_vs_tear());
  const std::optional<CutRatios> cuts = measure_cut_ratios();
  const auto add = [&](const char* name, double CutRatios::*ratio) {
    object.add(name, cuts ? std::optional(*cuts.*ratio) : std::nullopt);
  };
  add("cut_vs_vtk", &CutRatios::cut_vs_vtk);
  add("cut_vs_vtk_900k", &CutRatios::cut_vs_vtk_900k);
  add("capped_cut_vs_vtk", &CutRatios::capped_cut_vs_vtk);
}

#else

void add_operation_ratios(JsonObject& object) {
  for (const char* name : {"width_vs_tear", "cut_vs_vtk", "cut_vs_vtk_900k", "capped_cut_vs_vtk"})
    object.add(name, std::nullopt);
}

#endif

}  // namespace sunder::bench
