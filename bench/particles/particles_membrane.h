#pragma once

#include <vector>

namespace sunder::bench {

/// The gap of a slit in a sheet of one metre, under a tension of 1.2 N/m, against that of finite
/// elements.
struct GapFigures {
  double range = 0;  ///< Metres.
  unsigned particles = 0;
  double step_seconds = 0;
  double widest = 0, reference_widest = 0;  ///< Metres.
  double rms = 0, asymmetry = 0;            ///< Relative to the widest gap.
};

/// A slit of 0.4 m, for ranges of 0.2, 0.1, 0.05 and 0.025 m.
[[nodiscard]] std::vector<GapFigures> measure_gaps();
/// A slit of a quarter of the model, with about 200 particles before it.
[[nodiscard]] GapFigures measure_gap_at_200();
/// Difference from an ellipse of a slit in a stretched sheet on a very weak foundation, relative to
/// its greatest width; half the slit is four ranges long.
[[nodiscard]] double measure_ellipse_rms();

/// How much the loads at which the slit of 0.4 m runs on differ between ranges of 0.2, 0.1 and 0.05
/// m and sheets of 80, 160 and 320 cells: the greatest over the least, less 1.
[[nodiscard]] double measure_griffith_load_spread();

}  // namespace sunder::bench
