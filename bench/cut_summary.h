#pragma once

#include <array>
#include <optional>

#include "bench/tear_scene.h"

namespace sunder::bench {

/// A plane cut through the middle, with its pieces named, compared with VTK on the same mesh, in
/// turns. By size; medians.
struct CutFigures {
  std::array<double, kDivisions.size()> seconds = {}, allocations = {};
  std::optional<std::array<double, kDivisions.size()>> vtk_seconds;  ///< Where VTK is installed.

  [[nodiscard]] std::optional<std::array<double, kDivisions.size()>> ratios_to_vtk() const;
};
[[nodiscard]] CutFigures measure_cuts();

/// `bench_tear --cuts`: one JSON object.
void print_cut_summary();

}  // namespace sunder::bench
