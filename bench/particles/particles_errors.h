#pragma once

#include <vector>

namespace sunder::bench {

/// How far the particles around an open slit are from finite elements on the same mesh: root mean
/// squares over several orders of seeds, the greatest of them for `most`.
struct ErrorFigures {
  double range = 0;  ///< Metres.
  double particles = 0;
  double step_seconds = 0;
  double displacement = 0, most = 0;       ///< RMS and greatest over all points, by half the gap.
  double gap = 0;                          ///< Of the widest gap, relative.
  double least_gap = 0, greatest_gap = 0;  ///< Widest gap of an order, by that of the elements.
  double asymmetry = 0;  ///< Greatest difference of widths at x and -x, by the widest.
  double length = 0;     ///< Of the wound, between places three tenths as wide, relative.
};

/// A slit of 0.4 m in a sheet of a metre, 320 x 320 cells, under a tension of 1.2 N/m, for ranges
/// from 0.28 to 0.025 m.
[[nodiscard]] std::vector<ErrorFigures> measure_errors();

/// The order with which errors of displacements fall with the range: the slope of their logarithms
/// (least squares).
[[nodiscard]] double order_of(const std::vector<ErrorFigures>& figures);

/// Draws errors against the time of a step as SVG. @return false if it cannot be written.
[[nodiscard]] bool write_errors_picture(const std::vector<ErrorFigures>& figures, const char* file);

}  // namespace sunder::bench
