#pragma once

#include <array>
#include <optional>

#include "bench/tear/tear_scene.h"

namespace sunder::bench {

/// A plane cut through the middle, with its pieces named, without caps and with them, compared with
/// VTK's plane clipper on the same mesh, in turns. VTK keeps one side and makes no caps. By size;
/// medians.
struct CutFigures {
  using BySize = std::array<double, kDivisions.size()>;

  BySize seconds = {}, capped_seconds = {};
  BySize allocations = {}, capped_allocations = {};  ///< Of a warm cut and its undo.
  std::optional<BySize> vtk_seconds;                 ///< Where VTK is installed.

  /// Time by that of VTK.
  [[nodiscard]] std::optional<BySize> ratios_to_vtk() const;
  [[nodiscard]] std::optional<BySize> capped_ratios_to_vtk() const;
};

/// About half a minute; sets an environment variable of VTK.
[[nodiscard]] CutFigures measure_cuts();

/// The ratios that a summary shows, from measure_cuts().
struct CutRatios {
  double cut_vs_vtk = 0;         ///< The worst of all sizes.
  double cut_vs_vtk_900k = 0;    ///< At the largest.
  double capped_cut_vs_vtk = 0;  ///< With caps, the worst of all sizes.
};
/// @return nullopt without VTK.
[[nodiscard]] std::optional<CutRatios> measure_cut_ratios();

/// `bench_tear --cuts`: one JSON object.
void print_cut_summary();

}  // namespace sunder::bench
