#pragma once

#include <array>
#include <cstddef>
#include <optional>

#include "bench/tear_scene.h"

namespace sunder::bench {

/// Cuts of the whole model with caps, by size.
struct CappedCuts {
  using Figures = std::array<double, kDivisions.size()>;

  Figures filling_seconds = {};   ///< Median with caps minus median without them.
  std::optional<Figures> vs_vtk;  ///< Time with caps by that of VTK, which makes none.
  std::optional<Figures> filling_vs_vtk;
};

/// Measures them in turns with cuts without caps, and with VTK if it was found.
[[nodiscard]] CappedCuts measure_capped_cuts();

/// The result of twenty cuts with caps across a whole tube of 7,344 faces, in random planes.
struct TwentyCuts {
  std::size_t faces = 0;
  double slowest_seconds = 0;
};
[[nodiscard]] TwentyCuts cut_twenty_times();

}  // namespace sunder::bench
