// The whole chain: a tear, particles that follow it, a body whose lips open, and tissue that tears
// by itself.

#include <sunder/particles/force_tearing.h>
#include <sunder/tear/torn_model.h>

#include <array>
#include <cmath>
#include <cstring>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include "particles/frequency_of.h"
#include "particles/soft_scene.h"
#include "support/models/rigs.h"
#include "support/oracles/membrane.h"
#include "support/oracles/model_state.h"

namespace sunder {
namespace {

using test::difference;
using test::down_at;
using test::make_sheet;
using test::SoftScene;
using test::state_of;

constexpr double kStep = 1.0 / 60, kRange = 0.06;
constexpr double kDiagonal = 1.4142135623730951;  ///< Of the sheet.

///
/// @param return_stiffness  0: pulled tissue is stretched evenly.
SoftMaterial tissue(double strength, double return_stiffness = 0) {
  SoftMaterial material;
  material.return_frequency = test::frequency_of(return_stiffness);
  material.strength = strength;
  return material;
}

/// Held along both sides, which a pull along x separates; only the middle can tear.
struct Pulled : SoftScene {
  explicit Pulled(double strength)
      : SoftScene(make_sheet(40), {tissue(0), tissue(strength)}, kRange, {}) {
    for (std::uint32_t p = 0; p < count(); ++p) {
      const Vec3d at = body->place(p);
      const Status status = body->set_material(p, at.x() > 0.4 && at.x() < 0.6 ? 1 : 0);
      EXPECT_TRUE(status) << status.text();
      if (at.x() > 0.15 && at.x() < 0.85) continue;
      const auto hold = body->hold(p, at);
      EXPECT_TRUE(hold);
      holds.push_back({*hold, at});
    }
  }

  void pull(double by) {
    for (const Hold& hold : holds)
      ASSERT_TRUE(body->move_hold(hold.id, hold.at + Vec3d(hold.at.x() < 0.5 ? -by : by, 0, 0)));
    step(kStep);
  }

  ForceTearingReport tear(const ForceTearingOptions& options = {}) {
    const auto report = tear_overstretched(*body, *set, *model, pose, options, &changes);
    EXPECT_TRUE(report) << report.error().text();
    return report ? *report : ForceTearingReport();
  }

  /// Pulled farther and farther, for the given number of calls.
  std::vector<ForceTearingReport> tear_apart(int calls, double speed = 0.003) {
    std::vector<ForceTearingReport> torn;
    for (int i = 1; i <= calls; ++i) {
      pull(speed * i);
      if (ForceTearingReport report = tear(); report.has_torn) torn.push_back(std::move(report));
    }
    return torn;
  }

  struct Hold {
    HoldId id;
    Vec3d at;
  };
  std::vector<Hold> holds;
  std::vector<ChangeRecord> changes;
};

/// Torn along y at x = 0.5, from one height to another; the particles follow.
std::vector<LipPair> tear_down(SoftScene& scene, double from, double to, double x = 0.503) {
  ChangeRecord change;
  const std::array<Blade, 2> stroke = {down_at(x, from), down_at(x, to)};
  const auto report = scene.model->tear(scene.pose, stroke, {}, &change);
  EXPECT_TRUE(report) << report.error().text();
  EXPECT_TRUE(scene.set->follow(*scene.model, {&change, 1}));
  while (scene.set->settle(*scene.model)) continue;
  return change.lips;
}

TEST(ForceTearing, begins_across_the_pull_and_runs_on_from_its_tip) {
  Pulled scene(1.3);
  const auto torn = scene.tear_apart(60);
  ASSERT_GE(torn.size(), 4u);
  EXPECT_FALSE(torn[0].is_from_tip);
  EXPECT_TRUE(torn[1].is_from_tip);
  std::size_t ran_on = 0;
  for (std::size_t i = 0; i < torn.size(); ++i) {
    EXPECT_GT(torn[i].greatest_stretch, 1.3) << i;
    EXPECT_LE(torn[i].tear.length_posed, 0.5 * kRange * kDiagonal * 1.05) << i;
    EXPECT_NEAR(torn[i].direction.norm(), 1, 1e-9) << i;
    EXPECT_LT(std::abs(torn[i].direction.x()), std::sin(30 * std::numbers::pi / 180))
        << i << ": " << torn[i].direction.transpose();
    ran_on += torn[i].is_from_tip;
  }
  EXPECT_GE(ran_on, torn.size() / 2);
}

TEST(ForceTearing, holds_below_the_strength_and_without_one) {
  Pulled strong(3.0);
  EXPECT_TRUE(strong.tear_apart(30).empty());
  EXPECT_GT(strong.tear().greatest_stretch, 1.05);
  Pulled any(0.0);
  EXPECT_TRUE(any.tear_apart(60).empty());
  EXPECT_EQ(any.model->history()->size(), 0u);
}

TEST(ForceTearing, stands_in_the_history_and_is_undone_and_replayed) {
  Pulled scene(1.3);
  const auto before = state_of(*scene.model);
  const auto torn = scene.tear_apart(50);
  ASSERT_FALSE(torn.empty());
  ASSERT_EQ(scene.model->history()->size(), torn.size());
  ASSERT_EQ(scene.changes.size(), torn.size());

  auto again = TornModel::create(scene.character);
  ASSERT_TRUE(again);
  for (const Operation& operation : *scene.model->history())
    ASSERT_TRUE(apply_operation(*again, operation));
  EXPECT_EQ(again->digest(), scene.model->digest());

  for (std::size_t i = 0; i < torn.size(); ++i) {
    ChangeRecord change;
    ASSERT_TRUE(scene.model->undo(&change));
    ASSERT_TRUE(scene.set->follow(*scene.model, {&change, 1}));
  }
  EXPECT_EQ(difference(state_of(*scene.model), before), "");
  scene.step(kStep);
}

TEST(ForceTearing, is_deterministic) {
  Pulled a(1.3), b(1.3);
  EXPECT_EQ(a.tear_apart(40).size(), b.tear_apart(40).size());
  EXPECT_EQ(a.model->digest(), b.model->digest());
  ASSERT_EQ(a.count(), b.count());
  EXPECT_EQ(std::memcmp(a.body->displacements().data(), b.body->displacements().data(),
                        a.count() * sizeof(Vec4f)),
            0);
}

TEST(ForceTearing, refuses_bad_options) {
  Pulled scene(1.3);
  for (const double length : {0.0, -1.0, 2.5, std::nan("")}) {
    const auto report =
        tear_overstretched(*scene.body, *scene.set, *scene.model, scene.pose, {length});
    ASSERT_FALSE(report) << length;
    EXPECT_EQ(report.error().code(), StatusCode::invalid_argument);
  }
}

/// The energy that the tips of a slit release, by the tissue's own particles.
double release_of_tips(std::uint32_t cells, double half_length, double range) {
  SoftMaterial material;
  material.toughness = 1e6;
  test::SlitSheet sheet(cells, half_length, range, material);
  sheet.open(1.2);
  EXPECT_TRUE(sheet.body->set_tension({1.21, {}}));  // so that it is awake
  for (int i = 0; i < 5; ++i) EXPECT_TRUE(sheet.body->step(*sheet.model, sheet.pose, 0.1));
  const auto report = tear_overstretched(*sheet.body, *sheet.set, *sheet.model, sheet.pose);
  EXPECT_TRUE(report);
  EXPECT_FALSE(report->has_torn);
  return report->greatest_release;
}

/// The same by finite elements: the work of the tension on a slightly longer slit less that on a
/// slightly shorter one.
double release_by_energies(std::uint32_t cells, double half_length) {
  const double more = 4.0 / cells;
  const auto energy = [&](double half) {
    const test::SlitSheet sheet(cells, half, 0.2, {});
    const std::vector<Vec3d> forces = test::lip_forces(*sheet.set, 1.21);
    const std::vector<Vec3d> moved =
        test::solve_membrane(*sheet.model, sheet.set->positions(), {}, forces);
    double sum = 0;
    for (std::size_t p = 0; p < moved.size(); ++p) sum += 0.5 * moved[p].dot(forces[p]);
    return sum;
  };
  return (energy(half_length + more) - energy(half_length - more)) / (4 * more);  // of two tips
}

TEST(Toughness, is_exceeded_at_the_same_load_at_any_range_and_on_any_mesh) {
  for (const double half_length : {0.1, 0.2, 0.3}) {
    const double wanted = release_by_energies(160, half_length);
    for (const double range : {0.2, 0.1, 0.05})
      for (const std::uint32_t cells : {80u, 160u}) {
        if (2 * half_length < 1.5 * range || range * cells < 7) continue;
        // Loads are as the roots of energies.
        EXPECT_NEAR(std::sqrt(release_of_tips(cells, half_length, range) / wanted), 1, 0.15)
            << half_length << " " << range << " " << cells;
      }
  }
}

TEST(Toughness, decides_whether_a_tip_runs_on) {
  for (const bool is_tough : {false, true}) {
    SoftMaterial material;
    material.toughness = is_tough ? 0.1 : 0.02;
    test::SlitSheet sheet(80, 0.2, 0.1, material);
    sheet.open(1.0);
    EXPECT_TRUE(sheet.body->set_tension({1.2, {}}));
    std::vector<ChangeRecord> changes;
    double torn = 0;
    for (int i = 0; i < 20; ++i) {
      ASSERT_TRUE(sheet.body->step(*sheet.model, sheet.pose, 1.0 / 60));
      const auto report =
          tear_overstretched(*sheet.body, *sheet.set, *sheet.model, sheet.pose, {}, &changes);
      ASSERT_TRUE(report) << report.error().text();
      if (!report->has_torn) continue;
      EXPECT_TRUE(report->is_from_tip);
      EXPECT_GT(std::abs(report->direction.x()), 0.9);  // straight on
      EXPECT_GE(report->greatest_release, 0.02);
      torn += report->tear.length_posed;
    }
    if (is_tough)
      EXPECT_EQ(torn, 0.0);
    else
      EXPECT_GT(torn, 0.1);
  }
}

TEST(Gap, opens_under_tension_and_closes_without) {
  SoftScene scene(make_sheet(40), tissue(0, 50), kRange);
  const auto lips = tear_down(scene, 0.75, 0.25);
  const auto lean = [&](std::uint32_t point) { return scene.body->point_displacement(point).x(); };
  const LipPair middle = lips[lips.size() / 2];
  ASSERT_TRUE(scene.body->set_tension({5.0, {}}));
  scene.run(5);
  // Torn downwards and seen from +z, left is +x.
  EXPECT_GT(lean(middle.left), 0.002);
  EXPECT_LT(lean(middle.right), -0.002);
  for (const LipPair& pair : lips) EXPECT_GE(lean(pair.left), lean(pair.right));

  ASSERT_TRUE(scene.body->set_tension({}));
  scene.run(10);
  for (const LipPair& pair : lips)
    EXPECT_LT(
        (scene.body->point_displacement(pair.left) - scene.body->point_displacement(pair.right))
            .norm(),
        1e-4 * kDiagonal);
  EXPECT_EQ(scene.body->awake_count(), 0u);
}

TEST(Gap, of_a_body_that_was_under_tension_already_opens_at_once) {
  SoftScene scene(make_sheet(40), tissue(0, 50), kRange);
  ASSERT_TRUE(scene.body->set_tension({5.0, {}}));
  scene.run(1);
  ASSERT_EQ(scene.body->awake_count(), 0u);
  const auto lips = tear_down(scene, 0.75, 0.25);
  scene.run(5);
  const LipPair middle = lips[lips.size() / 2];
  EXPECT_GT(scene.body->point_displacement(middle.left).x() -
                scene.body->point_displacement(middle.right).x(),
            0.004);
}

TEST(Gap, opens_across_the_lines_of_tension_and_not_along_them) {
  for (const bool is_across : {false, true}) {
    SoftScene scene(make_sheet(40), tissue(0, 50), kRange);
    const auto lips = tear_down(scene, 0.75, 0.25);
    ASSERT_TRUE(scene.body->set_tension(
        {5.0, [=](const Vec3d&) -> Vec3d { return is_across ? Vec3d::UnitX() : Vec3d::UnitY(); }}));
    scene.run(5);
    double widest = 0;
    for (const LipPair& pair : lips)
      widest = std::max(widest, (scene.body->point_displacement(pair.left) -
                                 scene.body->point_displacement(pair.right))
                                    .norm());
    if (is_across)
      EXPECT_GT(widest, 0.004);
    else
      EXPECT_LT(widest, 1e-4 * kDiagonal);
  }
}

TEST(Gap, of_two_edges_opens_too) {
  // Torn along a line of the mesh: the seeds of its two lips coincide, and their cells meet around
  // both tips.
  SoftScene scene(make_sheet(40), tissue(0, 50), kRange);
  const auto lips = tear_down(scene, 0.521, 0.479, 0.6);
  ASSERT_TRUE(scene.body->set_tension({1.0, {}}));
  scene.run(5);
  const std::vector<Vec3d> wanted =
      test::solve_membrane(*scene.model, scene.set->positions(), scene.body->materials()[0],
                           test::lip_forces(*scene.set, 1.0));
  double gap = 0, widest = 0;
  for (const LipPair& pair : lips) {
    gap = std::max(gap, (scene.body->point_displacement(pair.left) -
                         scene.body->point_displacement(pair.right))
                            .norm());
    widest = std::max(widest, (wanted[pair.left] - wanted[pair.right]).norm());
  }
  EXPECT_GT(widest, 1e-3);
  EXPECT_GT(gap, 0.4 * widest);
  EXPECT_LT(gap, 1.6 * widest);
}

TEST(Lips, move_apart_from_each_other_once_torn) {
  SoftScene scene(make_sheet(60), tissue(0, 50), 0.05);
  const auto point_near = [&](const Vec3d& at) {
    std::uint32_t best = 0;
    for (std::uint32_t p = 1; p < scene.set->point_count(); ++p)
      if ((scene.set->positions()[p].cast<double>() - at).norm() <
          (scene.set->positions()[best].cast<double>() - at).norm())
        best = p;
    return best;
  };
  // Tissue just across the future tear moves along.
  const std::uint32_t here = point_near({0.5, 0.5, 0}),
                      there = point_near({0.5 + 1.0 / 60, 0.5, 0});
  const auto hold = scene.body->hold_point(here, {0.5, 0.5, 0.05});
  ASSERT_TRUE(hold);
  scene.run(4);
  EXPECT_GT(scene.body->point_displacement(there).norm(),
            0.5 * scene.body->point_displacement(here).norm());
  ASSERT_TRUE(scene.body->release(*hold));
  scene.run(6);

  const auto lips = tear_down(scene, 0.9, 0.1);
  const LipPair middle = lips[lips.size() / 2];
  const auto of_left = scene.body->hold_point(middle.left, {0.503, 0.5, 0.05});
  ASSERT_TRUE(of_left);
  scene.run(4);
  const double moved = scene.body->point_displacement(middle.left).norm();
  EXPECT_GT(moved, 0.03);
  EXPECT_LT(scene.body->point_displacement(middle.right).norm(), 0.1 * moved);
}

TEST(Lips, do_not_jump_when_they_are_torn) {
  SoftScene scene(make_sheet(40), tissue(0, 50), kRange);
  for (std::uint32_t p = 0; p < scene.count(); ++p) {
    const Vec3d at = scene.body->place(p);
    ASSERT_TRUE(scene.body->hold(p, at + 0.1 * at.x() * Vec3d::UnitX()));
  }
  scene.run(2);
  const auto field = [&] {
    std::vector<Vec3d> places;
    for (std::uint32_t point = 0; point < scene.set->point_count(); ++point)
      places.push_back(scene.body->point_displacement(point));
    return places;
  };
  const std::vector<Vec3d> before = field();
  tear_down(scene, 0.75, 0.25);
  scene.step(0);
  const std::vector<Vec3d> after = field();
  double jump = 0, most = 0;
  for (std::size_t i = 0; i < before.size(); ++i) {
    jump = std::max(jump, (after[i] - before[i]).norm());
    most = std::max(most, before[i].norm());
  }
  EXPECT_LT(jump, 0.15 * most);  // the difference between two neighbouring particles
}

}  // namespace
}  // namespace sunder
