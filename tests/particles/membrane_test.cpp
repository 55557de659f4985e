#include "support/oracles/membrane.h"

#include <sunder/tear/tear_stroke.h>

#include <cmath>
#include <tuple>
#include <utility>

#include <gtest/gtest.h>

#include "particles/frequency_of.h"
#include "particles/soft_scene.h"

namespace sunder {
namespace {

using test::Asymmetry;
using test::GapProfile;
using test::SlitSheet;
using test::SoftScene;

constexpr double kTension = 1.2;

GapProfile opened(SlitSheet& sheet) {
  sheet.open(kTension);
  return gap_of(sheet);
}

TEST(membrane, has_the_area_of_the_surface) {
  for (const double range : {0.05, 0.1, 0.3}) {
    const SoftScene scene(test::make_sheet(30, 2.0f), {}, range);
    double area = 0, mass = 0;
    for (std::uint32_t p = 0; p < scene.count(); ++p) {
      area += scene.set->area(p);
      mass += scene.body->mass(p);
    }
    EXPECT_NEAR(area, 4, 1e-5) << range;
    EXPECT_NEAR(mass, 4 * SoftMaterial().areal_density, 1e-5) << range;
  }
}

TEST(membrane, has_the_energy_of_a_uniform_stretch) {
  // With u = g . x, the sum of the couplings times (u_q - u_p)^2 is |g|^2 times the area, up to the
  // outermost cells, whose seeds are not in their middles.
  for (std::uint64_t seed = 0; seed < 4; ++seed)
    for (const Vec3d& along : {Vec3d(1, 0, 0), Vec3d(0, 1, 0), Vec3d(0.6, 0.8, 0)}) {
      const SoftScene scene(test::make_sheet(80), {}, 0.05);
      double energy = 0;
      for (std::uint32_t p = 0; p < scene.count(); ++p)
        for (const ParticleNeighbour& neighbour : scene.set->neighbours(p)) {
          const Vec3f between = scene.set->positions()[scene.set->seed(neighbour.particle)] -
                                scene.set->positions()[scene.set->seed(p)];
          energy += 0.5 * neighbour.coupling * std::pow(along.dot(between.cast<double>()), 2);
        }
      EXPECT_NEAR(energy, 1, 0.06) << seed;
    }
}

TEST(membrane, a_gap_is_that_of_finite_elements_at_any_range) {
  for (const auto& [half_length, range] :
       {std::pair(0.2, 0.2), std::pair(0.2, 0.1), std::pair(0.2, 0.05), std::pair(0.125, 0.07)}) {
    SlitSheet sheet(100, half_length, range, {});
    const GapProfile gap = opened(sheet), wanted = reference_gap(sheet, kTension);
    EXPECT_NEAR(gap.widest() / wanted.widest(), 1, 0.1) << range;
    EXPECT_LT(rms_difference(gap, wanted), 0.08) << range;
  }
}

TEST(membrane, a_gap_of_a_stroke_in_many_calls_is_that_of_one) {
  SlitSheet whole(100, 0.2, 0.1, {});
  const std::vector<Vec3d> wanted = test::solve_membrane(
      *whole.model, whole.set->positions(), SoftMaterial(), test::lip_forces(*whole.set, kTension));
  double widest = 0;
  for (const LipPair& pair : whole.lips)
    widest = std::max(widest, (wanted[pair.left] - wanted[pair.right]).norm());

  const SoftScene scene(test::make_sheet(100), {}, 0.1 / std::sqrt(2.0));
  const auto blade = [](double x) { return Blade{{x, 0.503, 0.5}, {x, 0.503, -0.5}}; };
  auto stroke = TearStroke::create(*scene.model, scene.pose, blade(0.3), {});
  ASSERT_TRUE(stroke);
  std::vector<LipPair> lips;
  const auto follow = [&](const ChangeRecord& change) {
    lips.insert(lips.end(), change.lips.begin(), change.lips.end());
    ASSERT_TRUE(scene.set->follow(*scene.model, {&change, 1}));
    ASSERT_TRUE(scene.body->step(*scene.model, scene.pose, 1.0 / 60));
  };
  ASSERT_TRUE(scene.body->set_tension({kTension, {}}));
  for (int i = 1; i <= 40; ++i) {
    ChangeRecord change;
    ASSERT_TRUE(stroke->extend(scene.pose, blade(0.3 + 0.01 * i), 0.0, &change));
    follow(change);
  }
  ChangeRecord change;
  ASSERT_TRUE(stroke->end(&change));
  follow(change);
  for (int i = 0; i < 400 && scene.body->awake_count() > 0; ++i)
    ASSERT_TRUE(scene.body->step(*scene.model, scene.pose, 0.1));
  double found = 0;
  for (const LipPair& pair : lips)
    found = std::max(found, (scene.body->point_displacement(pair.left) -
                             scene.body->point_displacement(pair.right))
                                .norm());
  EXPECT_NEAR(found / widest, 1, 0.05);
}

TEST(membrane, a_gap_on_a_weak_foundation_is_an_ellipse) {
  SoftMaterial material;
  material.return_frequency = test::frequency_of(1);
  material.damping_ratio = 1;
  SlitSheet sheet(160, 0.12, 0.03, material);
  const GapProfile gap = opened(sheet);
  EXPECT_LT(difference_from_ellipse(gap, 0.12), 0.05);
  EXPECT_LT(asymmetry(gap).most, 0.03);
}

TEST(membrane, a_gap_does_not_depend_on_the_mesh) {
  // Seeds are points of the mesh, so another mesh has other particles. With half the slit four
  // ranges long, the mean over several orders of seeds shows what is left of the mesh itself.
  constexpr std::uint64_t kOrders = 6;
  for (const auto& [range, orders, most] :
       {std::tuple(0.1, std::uint64_t{1}, 0.07), std::tuple(0.05, kOrders, 0.03)}) {
    std::vector<double> widths;
    for (const std::uint32_t cells : {80u, 160u, 320u}) {
      double sum = 0;
      for (std::uint64_t order = 0; order < orders; ++order) {
        SlitSheet sheet(cells, 0.2, range, {}, 1, order);
        sum += opened(sheet).widest() / static_cast<double>(orders);
      }
      widths.push_back(sum);
    }
    for (const double width : widths) EXPECT_NEAR(width / widths[0], 1, most) << range;
  }
}

TEST(membrane, no_particle_stays_behind_at_a_lip) {
  // Small particles take the cells of older ones next to a lip, which still move points.
  std::uint32_t crowded = 0;
  for (const double range : {0.1, 0.05, 0.025})
    for (std::uint64_t order = 0; order < 3; ++order) {
      SlitSheet sheet(160, 0.2, range, {}, 1, order);
      const double widest = opened(sheet).widest();
      const std::vector<Vec3d> wanted =
          test::solve_membrane(*sheet.model, sheet.set->positions(), SoftMaterial(),
                               test::lip_forces(*sheet.set, kTension));
      for (std::uint32_t p = 0; p < sheet.set->particle_count(); ++p) {
        const std::uint32_t seed = sheet.set->seed(p);
        if (sheet.set->owners()[seed] == p) continue;
        ++crowded;
        EXPECT_LT((sheet.body->displacement(p) - wanted[seed]).norm(), 0.1 * widest) << p;
      }
    }
  EXPECT_GT(crowded, 0u);
}

TEST(membrane, a_gap_is_symmetric_where_the_mesh_is_fine) {
  for (std::uint64_t order = 0; order < 6; ++order) {
    SlitSheet sheet(320, 0.2, 0.05, {}, 1, order);
    const Asymmetry of = asymmetry(opened(sheet));
    EXPECT_LT(of.rms, 0.02) << order;
    EXPECT_LT(of.most, 0.025) << order;
  }
}

TEST(membrane, the_unit_of_length_does_not_matter) {
  // A power of two, so that points at equal distances from two seeds stay there.
  constexpr double kUnits = 128;
  SoftMaterial metres, others;
  others.areal_density = metres.areal_density / (kUnits * kUnits);
  // Newtons per metre are kilograms per square second: the same in any unit of length.
  SlitSheet small(32, 0.2, 0.1, metres), large(32, 0.2, 0.1, others, kUnits);
  ASSERT_EQ(small.set->particle_count(), large.set->particle_count());
  for (SlitSheet* sheet : {&small, &large}) {
    ASSERT_TRUE(sheet->body->set_tension({kTension, {}}));
    for (int i = 0; i < 60; ++i)
      ASSERT_TRUE(sheet->body->step(*sheet->model, sheet->pose, 1.0 / 60));
  }
  double most = 0;
  for (std::uint32_t p = 0; p < small.set->particle_count(); ++p) {
    most = std::max(most, small.body->displacement(p).norm());
    EXPECT_LT((large.body->displacement(p) / kUnits - small.body->displacement(p)).norm(), 1e-9);
  }
  EXPECT_GT(most, 0.01);
}

TEST(membrane, a_pull_reaches_as_far_as_that_of_finite_elements) {
  const SoftScene scene(test::make_sheet(80), {}, 0.03);
  const std::uint32_t pulled = scene.nearest({0.5, 0.5, 0});
  ASSERT_TRUE(scene.body->set_force(pulled, {0, 0, 1}));
  for (int i = 0; i < 100; ++i) ASSERT_TRUE(scene.body->step(*scene.model, scene.pose, 0.1));
  std::vector<Vec3d> forces(scene.set->point_count(), Vec3d::Zero());
  std::uint32_t count = 0;
  for (const std::uint32_t owner : scene.set->owners()) count += owner == pulled ? 1 : 0;
  for (std::uint32_t p = 0; p < forces.size(); ++p)
    if (scene.set->owners()[p] == pulled) forces[p].z() = 1.0 / count;
  const std::vector<Vec3d> wanted =
      test::solve_membrane(*scene.model, scene.set->positions(), SoftMaterial(), forces);
  for (std::uint32_t p = 0; p < scene.count(); ++p) {
    const std::uint32_t seed = scene.set->seed(p);
    if (p == pulled) continue;
    EXPECT_NEAR(scene.body->displacement(p).z(), wanted[seed].z(),
                0.1 * wanted[seed].z() + 0.01 * wanted[scene.set->seed(pulled)].z());
  }
}

}  // namespace
}  // namespace sunder
