#pragma once

#include <string>
#include <vector>

#include "support/oracles/displaced_surface.h"

namespace sunder::bench {

/// The displaced surface of a torn model whose lips gape.
struct SurfaceFigures {
  std::string name;
  double wanted_gap = 0;  ///< As a fraction of the range of a particle.
  double gap = 0;         ///< The largest displacement, relative to the range of a particle.
  test::DisplacedSurface surface;
};

/// A sheet, a tube and the bunny, torn with walls: a tension pulls the lips apart, and a hold pulls
/// at one of them.
[[nodiscard]] std::vector<SurfaceFigures> measure_surfaces();

}  // namespace sunder::bench
