#include <sunder/bodies/mass_properties.h>

#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "support/machine/random.h"
#include "support/models/solids.h"

namespace sunder {
namespace {

using test::make_ball;
using test::make_box;
using test::make_torus;
using test::Random;
using test::Solid;

MassProperties mass_of(const Solid& solid, const MassOptions& options = {}) {
  const auto mass = compute_mass(solid.positions, solid.triangles, options);
  EXPECT_TRUE(mass) << mass.error().text();
  return mass ? *mass : MassProperties();
}

double difference(const Mat3d& a, const Mat3d& b) { return (a - b).cwiseAbs().maxCoeff(); }

Mat3d random_rotation(Random& random) {
  const Vec3d x = random.direction(), y = x.cross(random.direction()).normalized();
  Mat3d axes;
  axes.col(0) = x;
  axes.col(1) = y;
  axes.col(2) = x.cross(y);
  return axes;
}

/// Tensor of a solid box about its centre.
Mat3d box_inertia(double mass, const Vec3d& size) {
  const Vec3d s = size.cwiseProduct(size);
  return (mass / 12 * Vec3d(s[1] + s[2], s[0] + s[2], s[0] + s[1])).asDiagonal();
}

TEST(MassProperties, of_boxes_are_known) {
  Random random(1);
  for (const double scale : {1e-9, 1e-3, 1.0, 1e4, 1e12})
    for (const double away : {0.0, 1.0, 1e3}) {
      const Vec3d size = scale * Vec3d(random.uniform(0.5, 2), random.uniform(0.5, 2), 1.0);
      const Vec3d centre = away * scale * random.direction();
      const Mat3d axes = random_rotation(random);
      Solid box = make_box(size);
      for (Vec3d& position : box.positions) position = axes * position + centre;
      const MassProperties mass = mass_of(box, {700});
      const double volume = size.prod();
      EXPECT_EQ(mass.rule, SolidRule::closed);
      EXPECT_EQ(mass.holes, 0u);
      EXPECT_NEAR(mass.volume / volume, 1, 1e-11);
      EXPECT_NEAR(mass.mass / (700 * volume), 1, 1e-11);
      EXPECT_NEAR(mass.area / (2 * (size[0] * size[1] + size[1] * size[2] + size[2] * size[0])), 1,
                  1e-11);
      EXPECT_LT((mass.centre - centre).norm(), 1e-12 * (1 + away) * scale);
      const Mat3d inertia = axes * box_inertia(700 * volume, size) * axes.transpose();
      EXPECT_LT(difference(mass.inertia, inertia), 1e-10 * inertia.norm()) << scale << " " << away;
    }
}

TEST(MassProperties, of_balls_and_ellipsoids_converge) {
  // A subdivided ball has less volume; the error falls with the square of the edge.
  double before = 1;
  for (const int levels : {2, 3, 4, 5}) {
    const MassProperties mass = mass_of(make_ball(levels));
    const double volume = 4.0 / 3 * std::numbers::pi;
    const double error = 1 - mass.volume / volume;
    EXPECT_GT(error, 0);
    EXPECT_LT(error, 0.3 * before);
    before = error;
    EXPECT_LT(difference(mass.inertia, 0.4 * mass.mass * Mat3d::Identity()), 4 * error * mass.mass);
    EXPECT_LT(mass.centre.norm(), 1e-12);
  }
  EXPECT_LT(before, 2e-3);
  const Vec3d axes(0.5, 1.5, 3);
  Solid ellipsoid = make_ball(5);
  for (Vec3d& position : ellipsoid.positions) position = position.cwiseProduct(axes);
  const MassProperties mass = mass_of(ellipsoid);
  EXPECT_NEAR(mass.volume / (4.0 / 3 * std::numbers::pi * axes.prod()), 1, 2e-3);
  const Vec3d s = axes.cwiseProduct(axes);
  const Mat3d inertia = (mass.mass / 5 * Vec3d(s[1] + s[2], s[0] + s[2], s[0] + s[1])).asDiagonal();
  EXPECT_LT(difference(mass.inertia, inertia), 3e-3 * inertia.norm());
}

TEST(MassProperties, of_tori_are_known) {
  const double ring = 1.0, tube = 0.25;
  const MassProperties mass = mass_of(make_torus(ring, tube, 256, 128));
  EXPECT_NEAR(mass.volume / (2 * std::pow(std::numbers::pi * tube, 2) * ring), 1, 1e-3);
  EXPECT_NEAR(mass.area / (4 * std::pow(std::numbers::pi, 2) * tube * ring), 1, 1e-3);
  const double about = mass.mass * (ring * ring + 0.75 * tube * tube),
               across = mass.mass * (0.5 * ring * ring + 0.625 * tube * tube);
  EXPECT_NEAR(mass.inertia(2, 2) / about, 1, 2e-3);
  EXPECT_NEAR(mass.inertia(0, 0) / across, 1, 2e-3);
  EXPECT_NEAR(mass.inertia(1, 1) / across, 1, 2e-3);
}

TEST(MassProperties, agree_with_random_samples) {
  Random random(5);
  const Solid torus = make_torus(0.7, 0.3, 96, 64);
  const MassProperties mass = mass_of(torus, {1});
  double inside = 0;
  Mat3d second = Mat3d::Zero();
  constexpr int kSamples = 200000;
  for (int i = 0; i < kSamples; ++i) {
    const Vec3d p{random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-0.3, 0.3)};
    const double to_ring = std::hypot(p[0], p[1]) - 0.7;
    if (to_ring * to_ring + p[2] * p[2] > 0.09) continue;
    ++inside;
    second += p * p.transpose();
  }
  const double cell = 2.0 * 2.0 * 0.6 / kSamples;
  EXPECT_NEAR(mass.volume, inside * cell, 0.01);
  const Mat3d inertia = cell * (second.trace() * Mat3d::Identity() - second);
  EXPECT_LT(difference(mass.inertia, inertia), 0.01);
}

TEST(MassProperties, add_up_by_the_parallel_axis_theorem) {
  // Two boxes, apart and as one body.
  Random random(7);
  Solid both;
  double total = 0;
  Vec3d moment = Vec3d::Zero();
  std::vector<MassProperties> each;
  for (int i = 0; i < 3; ++i) {
    Solid box = make_box(Vec3d(random.uniform(0.2, 1), random.uniform(0.2, 1), 0.4));
    const Mat3d axes = random_rotation(random);
    const Vec3d centre = 5.0 * i * Vec3d(1, 0.3, -0.2) + random.direction();
    for (Vec3d& position : box.positions) position = axes * position + centre;
    each.push_back(mass_of(box));
    total += each.back().mass;
    moment += each.back().mass * each.back().centre;
    append(box, both);
  }
  const MassProperties mass = mass_of(both);
  const Vec3d centre = moment / total;
  Mat3d inertia = Mat3d::Zero();
  for (const MassProperties& of : each) {
    const Vec3d d = of.centre - centre;
    inertia += of.inertia + of.mass * (d.squaredNorm() * Mat3d::Identity() - d * d.transpose());
  }
  EXPECT_NEAR(mass.mass, total, 1e-9 * total);
  EXPECT_LT((mass.centre - centre).norm(), 1e-12);
  EXPECT_LT(difference(mass.inertia, inertia), 1e-10 * inertia.norm());
}

TEST(MassProperties, do_not_depend_on_seams_and_the_order_of_triangles) {
  const Solid ball = make_ball(3);
  const MassProperties mass = mass_of(ball);
  Solid soup;  // three vertices of its own per triangle
  for (auto triangle = ball.triangles.rbegin(); triangle != ball.triangles.rend(); ++triangle) {
    const auto first = static_cast<std::uint32_t>(soup.positions.size());
    for (const std::uint32_t vertex : *triangle) soup.positions.push_back(ball.positions[vertex]);
    soup.triangles.push_back({first, first + 1, first + 2});
  }
  const MassProperties of_soup = mass_of(soup);
  EXPECT_EQ(of_soup.rule, SolidRule::closed);
  EXPECT_EQ(of_soup.holes, 0u);
  EXPECT_NEAR(of_soup.volume, mass.volume, 1e-13);
  EXPECT_LT(difference(of_soup.inertia, mass.inertia), 1e-9);
}

TEST(MassProperties, of_what_is_inside_out_are_the_same) {
  Solid box = make_box(Vec3d(1, 2, 3));
  const MassProperties mass = mass_of(box);
  for (Triangle& triangle : box.triangles) std::swap(triangle[0], triangle[1]);
  EXPECT_EQ(mass_of(box).volume, mass.volume);
  EXPECT_EQ(mass_of(box).inertia, mass.inertia);
}

TEST(MassProperties, flat_holes_are_closed_exactly) {
  Solid box = make_box(Vec3d(1, 2, 3));
  const MassProperties whole = mass_of(box);
  box.triangles.erase(box.triangles.begin(), box.triangles.begin() + 2);  // a side
  MassProperties open = mass_of(box);
  EXPECT_EQ(open.rule, SolidRule::fans);
  EXPECT_EQ(open.holes, 1u);
  EXPECT_NEAR(open.volume, whole.volume, 1e-12);
  EXPECT_LT((open.centre - whole.centre).norm(), 1e-12);
  EXPECT_LT(difference(open.inertia, whole.inertia), 1e-9);
  EXPECT_LT(open.area, whole.area);

  open = mass_of(box, {1000, SolidRule::shell, 0.01});
  EXPECT_EQ(open.rule, SolidRule::shell);
  EXPECT_NEAR(open.volume, 0.01 * open.area, 1e-12);
}

TEST(MassProperties, of_a_sheet_are_those_of_a_shell) {
  Solid sheet;
  sheet.positions = {{0, 0, 0}, {2, 0, 0}, {2, 3, 0}, {0, 3, 0}};
  sheet.triangles = {{0, 1, 2}, {0, 2, 3}};
  const MassProperties mass = mass_of(sheet, {500, SolidRule::fans, 0.02});
  EXPECT_EQ(mass.rule, SolidRule::shell);
  EXPECT_EQ(mass.holes, 1u);
  EXPECT_NEAR(mass.mass, 500 * 6 * 0.02, 1e-12);
  EXPECT_LT((mass.centre - Vec3d(1, 1.5, 0)).norm(), 1e-12);
  EXPECT_NEAR(mass.inertia(0, 0), mass.mass * 9 / 12, 1e-10);
  EXPECT_NEAR(mass.inertia(1, 1), mass.mass * 4 / 12, 1e-10);
  EXPECT_NEAR(mass.inertia(2, 2), mass.mass * 13 / 12, 1e-10);
  EXPECT_NEAR(mass_of(sheet).volume, 6 * 0.01 * std::sqrt(6), 1e-12);  // the default thickness
}

TEST(MassProperties, faults_are_named) {
  const Solid box = make_box(Vec3d(1, 1, 1));
  const auto code = [&](const Solid& solid, const MassOptions& options = {}) {
    return compute_mass(solid.positions, solid.triangles, options).error().code();
  };
  EXPECT_EQ(code({}), StatusCode::empty_input);
  Solid retired = box;
  retired.triangles.assign(1, {3, 3, 3});
  EXPECT_EQ(code(retired), StatusCode::empty_input);
  Solid beyond = box;
  beyond.triangles[4][1] = 99;
  EXPECT_EQ(code(beyond), StatusCode::index_out_of_range);
  Solid infinite = box;
  infinite.positions[3][1] = std::numeric_limits<double>::infinity();
  EXPECT_EQ(code(infinite), StatusCode::non_finite_value);
  EXPECT_EQ(compute_mass(infinite.positions, infinite.triangles).error().index(), 3u);
  EXPECT_EQ(code(box, {0}), StatusCode::invalid_argument);
  EXPECT_EQ(code(box, {1, SolidRule::closed}), StatusCode::invalid_argument);
  EXPECT_EQ(code(box, {1, SolidRule::fans, -1}), StatusCode::invalid_argument);
}

TEST(PrincipalAxes, diagonalise_random_tensors) {
  Random random(3);
  for (int i = 0; i < 200; ++i) {
    Vec3d moments{random.uniform(0, 1), random.uniform(0, 1), random.uniform(0, 1)};
    if (i % 3 == 0) moments[1] = moments[0];  // two equal ones
    if (i % 7 == 0) moments *= 1e-12;
    const Mat3d axes = random_rotation(random);
    const Mat3d tensor = axes * moments.asDiagonal() * axes.transpose();
    const PrincipalAxes found = principal_axes(0.5 * (tensor + tensor.transpose()));
    const double size = moments.maxCoeff();
    EXPECT_LE(found.moments[0], found.moments[1]);
    EXPECT_LE(found.moments[1], found.moments[2]);
    EXPECT_NEAR(found.axes.determinant(), 1, 1e-12);
    EXPECT_LT(difference(found.axes.transpose() * found.axes, Mat3d::Identity()), 1e-12);
    EXPECT_LT(difference(found.axes * found.moments.asDiagonal() * found.axes.transpose(), tensor),
              1e-13 * size);
  }
  const PrincipalAxes of_ball = principal_axes(2 * Mat3d::Identity());
  EXPECT_EQ(of_ball.axes, Mat3d(Mat3d::Identity()));
}

}  // namespace
}  // namespace sunder
