#include "bench/particles/particles_oracle.h"

#include <cmath>
#include <numbers>

#include "support/oracles/graph_wound.h"

namespace sunder::bench {
namespace {

using test::GraphMesh;
using test::GraphSurface;
using test::GraphWound;
using test::QuadraticMembrane;
using test::TwoMembranes;

constexpr double kTension = 1.2;
constexpr int kReferenceCells = 16;
constexpr double kCellsTimesRange = 8;  ///< Of every mesh and its particles.

struct Setup {
  const char* name;
  GraphSurface surface;
  GraphMesh mesh;
  TwoMembranes materials;
};

/// Part of a round surface: of a ball, or of a cylinder along x or y.
GraphSurface round(double radius, bool is_bent_in_x, bool is_bent_in_y) {
  GraphSurface surface;
  const double y0 = surface.slit_y;
  const auto x_of = [=](double x) { return is_bent_in_x ? x - 0.5 : 0.0; };
  const auto y_of = [=](double y) { return is_bent_in_y ? y - y0 : 0.0; };
  const auto depth = [=](double x, double y) {
    return std::sqrt(radius * radius - x_of(x) * x_of(x) - y_of(y) * y_of(y));
  };
  surface.height = [=](double x, double y) { return depth(x, y) - radius; };
  surface.slope = [=](double x, double y) {
    return Vec2d(-x_of(x) / depth(x, y), -y_of(y) / depth(x, y));
  };
  return surface;
}

GraphSurface saddle() {
  constexpr double kBend = 0.8;
  GraphSurface surface;
  const double y0 = surface.slit_y;
  surface.height = [=](double x, double y) {
    return kBend * ((x - 0.5) * (x - 0.5) - (y - y0) * (y - y0));
  };
  surface.slope = [=](double x, double y) {
    return Vec2d(2 * kBend * (x - 0.5), -2 * kBend * (y - y0));
  };
  return surface;
}

/// Faces in the middle are four times as high as wide.
GraphMesh stretched() {
  GraphMesh mesh;
  mesh.place = [](double u, double v) {
    return Vec2d(u + 0.75 / (2 * std::numbers::pi) * std::sin(2 * std::numbers::pi * u), v);
  };
  return mesh;
}

/// Columns of the grid are waves, up to 43 degrees from upright.
GraphMesh skewed() {
  GraphMesh mesh;
  mesh.place = [](double u, double v) {
    return Vec2d(u + 0.15 * std::sin(std::numbers::pi * u) * std::sin(2 * std::numbers::pi * v), v);
  };
  return mesh;
}

std::vector<Setup> setups() {
  // The default material, and one that is four times as stiff on the same foundation.
  const TwoMembranes::Membrane soft{4, 0.4 * std::pow(2 * std::numbers::pi * 3.2, 2)},
      stiff{16, soft.foundation};
  const TwoMembranes one{soft, soft, TwoMembranes::Across::nothing, 0.5},
      across{soft, stiff, TwoMembranes::Across::x, 0.5},
      beside{soft, stiff, TwoMembranes::Across::y, 0.6};
  return {
      {"flat", {}, {}, one},
      {"cylinder, slit along it", round(0.55, false, true), {}, one},
      {"cylinder, slit around it", round(0.55, true, false), {}, one},
      {"ball", round(0.8, true, true), {}, one},
      {"saddle", saddle(), {}, one},
      {"flat, stretched mesh", {}, stretched(), one},
      {"flat, skewed mesh", {}, skewed(), one},
      {"flat, the other half 4 S", {}, {}, across},
      {"flat, 4 S from 0.1 m beside", {}, {}, beside},
      {"ball, skewed mesh, half 4 S", round(0.8, true, true), skewed(), across},
  };
}

MeanOf mean_of(const std::vector<double>& values) {
  MeanOf of;
  const auto count = static_cast<double>(values.size());
  for (const double value : values) of.mean += value / count;
  for (const double value : values) of.deviation += (value - of.mean) * (value - of.mean);
  of.deviation = std::sqrt(of.deviation / (count - 1));
  return of;
}

OracleFigures measure(const Setup& setup, const QuadraticMembrane& wanted, std::uint32_t cells,
                      std::uint64_t orders) {
  OracleFigures figures;
  figures.cells = cells;
  figures.range = kCellsTimesRange / cells;
  GraphMesh mesh = setup.mesh;
  mesh.cells = cells;
  std::vector<double> widths, gaps, displacements;
  for (std::uint64_t order = 0; order < orders; ++order) {
    GraphWound wound(setup.surface, setup.materials, mesh, figures.range, order);
    const test::MembraneDifference found = wound.difference(wanted, kTension);
    widths.push_back(found.width);
    gaps.push_back(found.gap);
    displacements.push_back(found.displacement);
    figures.particles += wound.set->particle_count() / static_cast<double>(orders);
    if (order == 0 && setup.materials.across == TwoMembranes::Across::nothing)
      figures.elements_width = wound.difference_of_elements(wanted, kTension).width;
  }
  figures.width = mean_of(widths);
  figures.gap = mean_of(gaps);
  figures.displacement = mean_of(displacements);
  return figures;
}

}  // namespace

std::vector<OracleCase> measure_against_oracle(std::uint64_t orders) {
  std::vector<OracleCase> cases;
  for (const Setup& setup : setups()) {
    OracleCase& of = cases.emplace_back();
    of.name = setup.name;
    const QuadraticMembrane wanted(setup.surface, setup.materials, kTension, kReferenceCells),
        coarser(setup.surface, setup.materials, kTension, kReferenceCells / 2);
    of.reference_error = std::abs(coarser.widest_gap() / wanted.widest_gap() - 1);
    for (const std::uint32_t cells : {40u, 80u, 160u})
      of.refined.push_back(measure(setup, wanted, cells, orders));
    const OracleFigures &first = of.refined.front(), &last = of.refined.back();
    of.order = std::log(first.displacement.mean / last.displacement.mean) /
               std::log(first.range / last.range);
  }
  return cases;
}

}  // namespace sunder::bench
