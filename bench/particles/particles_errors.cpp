#include "bench/particles/particles_errors.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdlib>

#include "bench/harness/measure.h"
#include "bench/harness/plot.h"
#include "support/oracles/membrane.h"

namespace sunder::bench {
namespace {

constexpr std::uint32_t kErrorCells = 320;  // along each edge of the sheet
constexpr double kErrorTension = 1.2, kHalfLength = 0.2;
constexpr std::uint64_t kOrders = 6;
constexpr double kOpen = 0.3;  ///< A wound ends where it is this much as wide as its widest gap.

/// The reference: the same for all particles, which do not change the mesh.
struct Reference {
  std::vector<Vec3d> displacements;
  test::GapProfile gap;
};

Reference reference_of(const test::SlitSheet& sheet) {
  return {test::solve_membrane(*sheet.model, sheet.set->positions(), sheet.body->materials()[0],
                               test::lip_forces(*sheet.set, kErrorTension)),
          test::reference_gap(sheet, kErrorTension)};
}

/// The length along which a wound is open. Between points squares of widths are linear, as they are
/// next to tips.
double open_length(const test::GapProfile& gap) {
  const double least = std::pow(kOpen * gap.widest(), 2);
  double first = gap.half_length, last = -gap.half_length;
  double x0 = -gap.half_length, w0 = 0;
  const auto visit = [&](double x, double width) {
    const double w = width * width;
    if ((w >= least) != (w0 >= least)) {
      const double at = x0 + (x - x0) * (least - w0) / (w - w0);
      first = std::min(first, at);
      last = std::max(last, at);
    }
    x0 = x;
    w0 = w;
  };
  for (std::size_t i = 0; i < gap.x.size(); ++i) visit(gap.x[i], gap.width[i]);
  visit(gap.half_length, 0);
  return last - first;
}

double step_seconds_of(test::SlitSheet& sheet) {
  if (!sheet.body->set_tension({kErrorTension, {}})) std::exit(1);
  std::vector<double> seconds;
  for (int i = 0; i < 20; ++i)
    seconds.push_back(
        seconds_of([&] { (void)sheet.body->step(*sheet.model, sheet.pose, 1.0 / 60); }));
  return median(seconds);
}

ErrorFigures measure(double range, const Reference& wanted) {
  ErrorFigures figures;
  figures.range = range;
  std::vector<double> seconds;
  const auto add_square = [](double& mean, double error) { mean += error * error / kOrders; };
  for (std::uint64_t order = 0; order < kOrders; ++order) {
    test::SlitSheet sheet(kErrorCells, kHalfLength, range, {}, 1, order);
    figures.particles += sheet.set->particle_count() / double{kOrders};
    seconds.push_back(step_seconds_of(sheet));
    sheet.open(kErrorTension);
    const double unit = 0.5 * wanted.gap.widest();
    double squares = 0;
    for (std::uint32_t p = 0; p < sheet.set->point_count(); ++p) {
      const double error =
          (sheet.body->point_displacement(p) - wanted.displacements[p]).norm() / unit;
      squares += error * error / sheet.set->point_count();
      figures.most = std::max(figures.most, error);
    }
    const test::GapProfile gap = gap_of(sheet);
    figures.displacement += squares / kOrders;
    const double width = gap.widest() / wanted.gap.widest();
    add_square(figures.gap, width - 1);
    figures.least_gap = order == 0 ? width : std::min(figures.least_gap, width);
    figures.greatest_gap = std::max(figures.greatest_gap, width);
    figures.asymmetry = std::max(figures.asymmetry, asymmetry(gap).most);
    add_square(figures.length, open_length(gap) / open_length(wanted.gap) - 1);
  }
  for (double* mean : {&figures.displacement, &figures.gap, &figures.length})
    *mean = std::sqrt(*mean);
  figures.step_seconds = median(seconds);
  return figures;
}

}  // namespace

std::vector<ErrorFigures> measure_errors() {
  const Reference reference = reference_of(test::SlitSheet(kErrorCells, kHalfLength, 0.2, {}));
  std::vector<ErrorFigures> figures;
  for (const double range : {0.28, 0.2, 0.14, 0.1, 0.07, 0.05, 0.035, 0.025})
    figures.push_back(measure(range, reference));
  return figures;
}

double order_of(const std::vector<ErrorFigures>& figures) {
  double x = 0, y = 0, xx = 0, xy = 0;
  for (const ErrorFigures& of : figures) {
    const double a = std::log(of.range), b = std::log(of.displacement);
    x += a;
    y += b;
    xx += a * a;
    xy += a * b;
  }
  const auto n = static_cast<double>(figures.size());
  return (n * xy - x * y) / (n * xx - x * x);
}

bool write_errors_picture(const std::vector<ErrorFigures>& figures, const char* file) {
  Plot plot;
  plot.title = "Errors of an open slit of 0.4 m, percent, for ranges of 0.28 to 0.025 m";
  plot.of_x = "microseconds per step";
  plot.series = {{"displacement, RMS", {}},
                 {"displacement, greatest", {}},
                 {"gap", {}},
                 {"length of the wound", {}}};
  for (const ErrorFigures& of : figures) {
    plot.x.push_back(1e6 * of.step_seconds);
    for (std::size_t s = 0; s < plot.series.size(); ++s)
      plot.series[s].values.push_back(100 *
                                      std::array{of.displacement, of.most, of.gap, of.length}[s]);
  }
  return write_svg(plot, file);
}

}  // namespace sunder::bench
