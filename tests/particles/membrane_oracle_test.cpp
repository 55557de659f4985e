// The membrane of particles on curved surfaces, uneven meshes and of two materials, against
// biquadratic finite elements that share nothing with it.

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "particles/frequency_of.h"
#include "support/oracles/graph_wound.h"

namespace sunder {
namespace {

using test::GraphMesh;
using test::GraphSurface;
using test::GraphWound;
using test::MembraneDifference;
using test::QuadraticMembrane;
using test::TwoMembranes;

constexpr double kOracleTension = 1.2;

TwoMembranes soft_and(double stiffness, TwoMembranes::Across across, double border) {
  return {{4, 160}, {stiffness, 160}, across, border};
}

GraphSurface ball() {
  GraphSurface surface;
  constexpr double kRadius = 0.8;
  const double y0 = surface.slit_y;
  const auto depth = [=](double x, double y) {
    return std::sqrt(kRadius * kRadius - (x - 0.5) * (x - 0.5) - (y - y0) * (y - y0));
  };
  surface.height = depth;
  surface.slope = [=](double x, double y) {
    return Vec2d(-(x - 0.5) / depth(x, y), -(y - y0) / depth(x, y));
  };
  return surface;
}

GraphMesh skewed() {
  GraphMesh mesh;
  mesh.place = [](double u, double v) {
    return Vec2d(u + 0.15 * std::sin(std::numbers::pi * u) * std::sin(2 * std::numbers::pi * v), v);
  };
  return mesh;
}

TEST(quadratic_membrane, has_the_gap_of_the_formula_in_a_flat_sheet) {
  for (const double reach : {0.05, 0.1}) {
    SoftMaterial material;
    material.return_frequency =
        test::frequency_of(material.membrane_stiffness / (material.areal_density * reach * reach));
    const TwoMembranes one{
        {material.membrane_stiffness, material.membrane_stiffness / (reach * reach)}, {}};
    EXPECT_NEAR(QuadraticMembrane({}, one, kOracleTension, 12).gap(0.5) /
                    *gap_under_tension(material, 0.4, kOracleTension),
                1, 2e-3)
        << reach;
  }
}

TEST(quadratic_membrane, converges_on_a_ball_of_two_materials) {
  const TwoMembranes two = soft_and(16, TwoMembranes::Across::x, 0.5);
  const double fine = QuadraticMembrane(ball(), two, kOracleTension, 20).gap(0.4),
               coarse = QuadraticMembrane(ball(), two, kOracleTension, 10).gap(0.4);
  EXPECT_NEAR(coarse / fine, 1, 2e-3);
  EXPECT_LT(QuadraticMembrane(ball(), two, kOracleTension, 10).gap(0.6), 0.8 * coarse);
}

void expect_near(const GraphSurface& surface, const TwoMembranes& materials, const GraphMesh& mesh,
                 double most_width, double most_displacement) {
  const QuadraticMembrane wanted(surface, materials, kOracleTension, 10);
  for (const std::uint64_t order : {0u, 1u}) {
    GraphWound wound(surface, materials, mesh, 0.1, order);
    const MembraneDifference found = wound.difference(wanted, kOracleTension);
    EXPECT_NEAR(found.width, 1, most_width) << order;
    EXPECT_LT(found.displacement, most_displacement) << order;
  }
}

TEST(membrane_oracle, particles_on_a_ball_and_on_a_skewed_mesh) {
  const TwoMembranes one = soft_and(4, TwoMembranes::Across::nothing, 0);
  expect_near(ball(), one, {}, 0.1, 0.06);
  expect_near({}, one, skewed(), 0.1, 0.06);
}

TEST(membrane_oracle, particles_of_two_materials) {
  expect_near({}, soft_and(16, TwoMembranes::Across::x, 0.5), {}, 0.1, 0.06);
  expect_near(ball(), soft_and(16, TwoMembranes::Across::y, 0.6), skewed(), 0.1, 0.06);
}

}  // namespace
}  // namespace sunder
