#include "bench/particles/particles_membrane.h"

#include <sunder/particles/force_tearing.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>

#include "bench/harness/measure.h"
#include "support/oracles/membrane.h"

namespace sunder::bench {
namespace {

constexpr std::uint32_t kCells = 160;  // along each edge of the sheet
constexpr double kTension = 1.2;

GapFigures measure(double half_length, double range) {
  test::SlitSheet sheet(kCells, half_length, range, {});
  GapFigures figures;
  figures.range = range;
  figures.particles = sheet.set->particle_count();
  if (!sheet.body->set_tension({kTension, {}})) std::exit(1);
  std::vector<double> seconds;
  for (int i = 0; i < 20; ++i)
    seconds.push_back(
        seconds_of([&] { (void)sheet.body->step(*sheet.model, sheet.pose, 1.0 / 60); }));
  figures.step_seconds = median(seconds);
  sheet.open(kTension);
  const test::GapProfile gap = gap_of(sheet), wanted = reference_gap(sheet, kTension);
  figures.widest = gap.widest();
  figures.reference_widest = wanted.widest();
  figures.rms = rms_difference(gap, wanted);
  figures.asymmetry = asymmetry(gap).most;
  return figures;
}

}  // namespace

std::vector<GapFigures> measure_gaps() {
  std::vector<GapFigures> figures;
  for (const double range : {0.2, 0.1, 0.05, 0.025}) figures.push_back(measure(0.2, range));
  return figures;
}

GapFigures measure_gap_at_200() {
  double range = 0.07;
  GapFigures figures;
  for (int i = 0; i < 6; ++i) {
    const test::SlitSheet sheet(kCells, 0.125, range, {});
    const double ratio = sheet.set->report().particles / 200.0;
    if (ratio > 0.98 && ratio < 1.02) break;
    range *= std::sqrt(ratio);
  }
  return measure(0.125, range);
}

double measure_ellipse_rms() {
  SoftMaterial material;
  material.return_frequency = 0.16;
  material.damping_ratio = 1;
  constexpr double kHalfLength = 0.12;
  test::SlitSheet sheet(kCells, kHalfLength, kHalfLength / 4, material);
  sheet.open(kTension);
  return difference_from_ellipse(gap_of(sheet), kHalfLength);
}

double measure_griffith_load_spread() {
  double least = std::numeric_limits<double>::infinity(), greatest = 0;
  for (const double range : {0.2, 0.1, 0.05})
    for (const std::uint32_t cells : {80u, 160u, 320u}) {
      SoftMaterial material;
      material.toughness = 1e12;
      test::SlitSheet sheet(cells, 0.2, range, material);
      sheet.open(kTension);
      // A little more keeps it awake.
      if (!sheet.body->set_tension({1.01 * kTension, {}})) std::exit(1);
      for (int i = 0; i < 5; ++i)
        if (!sheet.body->step(*sheet.model, sheet.pose, 0.1)) std::exit(1);
      const auto report = tear_overstretched(*sheet.body, *sheet.set, *sheet.model, sheet.pose);
      if (!report) std::exit(1);
      const double load = 1 / std::sqrt(report->greatest_release);
      least = std::min(least, load);
      greatest = std::max(greatest, load);
    }
  return greatest / least - 1;
}

}  // namespace sunder::bench
