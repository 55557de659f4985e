#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace sunder::bench {

/// A line of a plot.
struct PlotSeries {
  std::string name;
  std::vector<double> values;  ///< One per place on the x axis.
};

/// A plot with two logarithmic axes. Zeros stand at the lower end of an axis.
struct Plot {
  std::string title, of_x;
  std::vector<double> x;
  std::vector<PlotSeries> series;
};

/// Writes a plot as SVG. @return false if the file cannot be written.
[[nodiscard]] bool write_svg(const Plot& plot, const std::filesystem::path& file);

}  // namespace sunder::bench
