#include "particles/motion/plasticity.h"

#include <cmath>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include "particles/soft_scene.h"
#include "support/models/rigs.h"

namespace sunder {
namespace {

using test::SoftScene;

/// Well damped tissue that yields at a strain of 0.05.
SoftMaterial clay(double yield_stretch = 1.05) {
  SoftMaterial material;
  material.damping_ratio = 3;
  material.return_frequency = 1;
  material.membrane_stiffness = 4;
  material.membrane_damping = 2;
  material.yield_stretch = yield_stretch;
  material.plastic_limit = 10;
  return material;
}

double load_at(double x) { return std::sin(2 * std::numbers::pi * x); }

/// The same tissue along a line of 1 m, pulled along it by `most` times load_at() per area and
/// released again: finite differences with a return map on each of many cells, in small steps of
/// the load.
std::vector<double> line_of_clay(const SoftMaterial& material, double most, bool is_released) {
  constexpr int kNodes = 401, kLoads = 200;
  const double h = 1.0 / (kNodes - 1), stiffness = material.membrane_stiffness,
               foundation = material.areal_density *
                            std::pow(2 * std::numbers::pi * material.return_frequency, 2),
               yield = material.yield_stretch - 1;
  std::vector<double> u(kNodes, 0.0), kept(kNodes - 1, 0.0);
  const auto balance = [&](double load) {
    // (F + K) u = f + K kept, tridiagonal with free ends.
    std::vector<double> upper(kNodes), right(kNodes);
    for (int i = 0; i < kNodes; ++i) {
      const double part = i == 0 || i == kNodes - 1 ? 0.5 : 1.0;
      const double left = i > 0 ? stiffness / h : 0, after = i + 1 < kNodes ? stiffness / h : 0;
      double diagonal = part * h * foundation + left + after;
      double value = part * h * load * load_at(i * h);
      if (i > 0) value += stiffness * kept[i - 1];
      if (i + 1 < kNodes) value -= stiffness * kept[i];
      if (i > 0) {
        diagonal -= left * upper[i - 1];
        value += left * right[i - 1];
      }
      upper[i] = after / diagonal;
      right[i] = value / diagonal;
    }
    u[kNodes - 1] = right[kNodes - 1];
    for (int i = kNodes - 2; i >= 0; --i) u[i] = right[i] + upper[i] * u[i + 1];
  };
  const auto settle = [&](double load) {
    for (int sweep = 0; sweep < 4000; ++sweep) {
      balance(load);
      double moved = 0;
      for (int i = 0; i + 1 < kNodes; ++i) {
        const double elastic = (u[i + 1] - u[i]) / h - kept[i];
        if (std::abs(elastic) <= yield) continue;
        const double by = elastic - std::copysign(yield, elastic);
        kept[i] += by;
        moved = std::max(moved, std::abs(by));
      }
      if (moved < 1e-7) break;
    }
  };
  for (int i = 1; i <= kLoads; ++i) settle(most * i / kLoads);
  if (is_released)
    for (int i = kLoads - 1; i >= 0; --i) settle(most * i / kLoads);
  return u;
}

void load(SoftScene& scene, double most) {
  for (std::uint32_t p = 0; p < scene.count(); ++p) {
    const double x{scene.set->positions()[scene.set->seed(p)].x()};
    EXPECT_TRUE(scene.body->set_force(p, Vec3d(most * load_at(x) * scene.set->area(p), 0, 0)));
  }
}

/// Loads a sheet slowly and releases it. @return the displacement after each, by the points.
std::array<std::vector<double>, 2> pulled_sheet(SoftScene& scene, double most) {
  constexpr int kLoads = 60;
  std::array<std::vector<double>, 2> moved;
  for (const bool is_release : {false, true}) {
    for (int i = 1; i <= kLoads; ++i) {
      load(scene, most * (is_release ? kLoads - i : i) / kLoads);
      scene.run(0.5, 0.05);
    }
    scene.run(20, 0.1);
    for (Index point = 0; point < scene.set->point_count(); ++point)
      moved[is_release ? 1 : 0].push_back(scene.body->point_displacement(point).x());
  }
  return moved;
}

double rms_from_line(const SoftScene& scene, const std::vector<double>& moved,
                     const std::vector<double>& line) {
  double squares = 0, most = 0;
  for (const double of : line) most = std::max(most, std::abs(of));
  for (Index point = 0; point < scene.set->point_count(); ++point) {
    const double x = scene.set->positions()[point].x() * (static_cast<double>(line.size()) - 1);
    const auto i = std::min(static_cast<std::size_t>(x), line.size() - 2);
    const double wanted = line[i] + (x - static_cast<double>(i)) * (line[i + 1] - line[i]);
    squares += std::pow(moved[point] - wanted, 2);
  }
  return std::sqrt(squares / scene.set->point_count()) / most;
}

TEST(plasticity, what_is_kept_converges_to_that_of_a_line) {
  const SoftMaterial material = clay();
  constexpr double kMost = 2.5;
  const auto pulled = line_of_clay(material, kMost, false);
  const auto released = line_of_clay(material, kMost, true);
  double before = 0.55;
  for (const double range : {0.2, 0.1, 0.05}) {
    SoftScene scene(test::make_sheet(60), material, range / std::sqrt(2));
    const auto moved = pulled_sheet(scene, kMost);
    const double of_pulled = rms_from_line(scene, moved[0], pulled),
                 of_released = rms_from_line(scene, moved[1], released);
    const double worse = std::max(of_pulled, of_released);
    EXPECT_LT(worse, 0.75 * before + 0.05) << range;
    before = worse;
  }
  EXPECT_LT(before, 0.22);
}

TEST(plasticity, below_the_yield_stretch_no_bit_changes) {
  SoftScene plain(test::make_sheet(30), clay(0)), other(test::make_sheet(30), clay(1.5));
  for (SoftScene* scene : {&plain, &other}) {
    load(*scene, 5);
    scene->run(2);
  }
  EXPECT_GT(plain.farthest(), 0.01);
  EXPECT_TRUE(std::ranges::equal(plain.body->displacements(), other.body->displacements()));
}

TEST(plasticity, is_bounded_by_the_limit) {
  SoftMaterial material = clay(1.02);
  material.plastic_limit = 0.1;
  SoftScene scene(test::make_sheet(30), material);
  load(scene, 400);
  scene.run(5);
  const double pulled = scene.farthest();
  load(scene, 0);
  scene.run(30, 0.1);
  EXPECT_GT(pulled, 0.5);
  EXPECT_GT(scene.farthest(), 0.005);
  EXPECT_LT(scene.farthest(), 0.1 * 1);  // a strain of 0.1 over a metre
}

TEST(plasticity, is_saved_and_goes_through_tears) {
  const auto character = std::make_shared<const Character>(test::make_sheet(30));
  TornModel model = *TornModel::create(character);
  const ModelPose pose = *bind_pose(*character);
  const auto asset = *ParticleAsset::create(model, pose, {0.1});
  ParticleSet set = *ParticleSet::create(asset, model);
  const SoftMaterial material = clay();
  SoftBody body = *SoftBody::create(set, pose, {&material, 1});
  for (Index p = 0; p < set.particle_count(); ++p)
    ASSERT_TRUE(body.set_force(
        p, Vec3d(20 * load_at(set.positions()[set.seed(p)].x()) * set.area(p), 0, 0)));
  for (int i = 0; i < 60; ++i) ASSERT_TRUE(body.step(model, pose, 1.0 / 60));
  for (Index p = 0; p < set.particle_count(); ++p) ASSERT_TRUE(body.set_force(p, Vec3d::Zero()));
  const Stroke stroke = {test::down_at(0.5, 0.3), test::down_at(0.5, 0.7)};
  ChangeRecord change;
  ASSERT_TRUE(model.tear(pose, stroke, {}, &change));
  ASSERT_TRUE(set.follow(model, {&change, 1}));
  for (int i = 0; i < 10; ++i) ASSERT_TRUE(body.step(model, pose, 1.0 / 60));
  ParticleSet other = *ParticleSet::restore(asset, model, *set.save());
  SoftBody other_body = *SoftBody::create(other, pose, {&material, 1});
  ASSERT_TRUE(other_body.restore(*body.save()));
  double farthest = 0;
  for (int i = 0; i < 600; ++i) {
    ASSERT_TRUE(body.step(model, pose, 1.0 / 30));
    ASSERT_TRUE(other_body.step(model, pose, 1.0 / 30));
  }
  for (Index p = 0; p < set.particle_count(); ++p)
    farthest = std::max(farthest, body.displacement(p).norm());
  EXPECT_GT(farthest, 0.01);
  EXPECT_TRUE(std::ranges::equal(body.displacements(), other_body.displacements()));
  StateArrays broken = *body.save();
  broken.doubles.pop_back();
  EXPECT_FALSE(other_body.restore(broken));
}

}  // namespace
}  // namespace sunder
