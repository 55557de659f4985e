// The whole chain: a tear, particles that follow it, a body whose lips open, and tissue that tears
// by itself.

#include <sunder/particles/force_tearing.h>
#include <sunder/tear/torn_model.h>

#include <array>
#include <cmath>
#include <cstring>
#include <numbers>
#include <vector>

#include <Eigen/SVD>
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

TEST(ForceTearing, a_call_tears_no_farther_than_asked) {
  for (const double metres : {0.02, 0.03, 10.0}) {
    Pulled scene(1.3);
    const double most = std::min(metres, 0.5 * kRange * kDiagonal);
    double longest = 0;
    for (int i = 1; i <= 50; ++i) {
      scene.pull(0.003 * i);
      longest = std::max(longest, scene.tear({0.5, metres}).tear.length_posed);
    }
    EXPECT_NEAR(longest, most, 0.05 * most);
  }
}

TEST(ForceTearing, refuses_bad_options) {
  Pulled scene(1.3);
  for (const double length : {0.0, -1.0, 2.5, std::nan("")}) {
    const auto report =
        tear_overstretched(*scene.body, *scene.set, *scene.model, scene.pose, {length});
    ASSERT_FALSE(report) << length;
    EXPECT_EQ(report.error().code(), StatusCode::invalid_argument);
  }
  for (const double metres : {0.0, -1.0, std::nan("")}) {
    const auto report =
        tear_overstretched(*scene.body, *scene.set, *scene.model, scene.pose, {0.5, metres});
    ASSERT_FALSE(report) << metres;
    EXPECT_EQ(report.error().code(), StatusCode::invalid_argument);
  }
}

constexpr double kPulledTension = 1.21;

SoftMaterial tough(double return_stiffness) {
  SoftMaterial material;
  material.return_frequency = test::frequency_of(return_stiffness);
  material.toughness = 1e6;
  return material;
}

/// The greatest energy that a tip releases, by the tissue's own particles.
double release_of_tips(SoftBody& body, ParticleSet& set, TornModel& model, const ModelPose& pose) {
  for (int i = 0; i < 5; ++i) EXPECT_TRUE(body.step(model, pose, 0.1));
  const auto report = tear_overstretched(body, set, model, pose);
  EXPECT_TRUE(report);
  EXPECT_FALSE(report->has_torn);
  return report->greatest_release;
}

/// The same in a sheet with a slit under tension.
double release_of_slit(std::uint32_t cells, double half_length, double range,
                       const SoftMaterial& material) {
  test::SlitSheet sheet(cells, half_length, range, material);
  sheet.open(1.2);
  EXPECT_TRUE(sheet.body->set_tension({kPulledTension, {}}));  // so that it is awake
  return release_of_tips(*sheet.body, *sheet.set, *sheet.model, sheet.pose);
}

/// The same by finite elements: the work of some forces on a slightly longer slit less that on a
/// slightly shorter one.
/// @param forces_on  gives the force on each point of a SlitSheet of 160 cells.
template <class Forces>
double release_by_energies(double half_length, const SoftMaterial& material, Forces forces_on) {
  constexpr double kMore = 4.0 / 160;
  const auto energy = [&](double half) {
    const test::SlitSheet sheet(160, half, 0.2, material);
    const std::vector<Vec3d> forces = forces_on(sheet);
    const std::vector<Vec3d> moved =
        test::solve_membrane(*sheet.model, sheet.set->positions(), material, forces);
    double sum = 0;
    for (std::size_t p = 0; p < moved.size(); ++p) sum += 0.5 * moved[p].dot(forces[p]);
    return sum;
  };
  return (energy(half_length + kMore) - energy(half_length - kMore)) / (4 * kMore);  // of two tips
}

double release_under_tension(double half_length, const SoftMaterial& material) {
  return release_by_energies(half_length, material, [](const test::SlitSheet& sheet) {
    return test::lip_forces(*sheet.set, kPulledTension);
  });
}

TEST(Toughness, is_exceeded_at_the_same_load_at_any_range_and_on_any_mesh) {
  for (const double return_stiffness : {40.0, 400.0, 4000.0})
    for (const double half_length : {0.1, 0.2, 0.3}) {
      const SoftMaterial material = tough(return_stiffness);
      const double wanted = release_under_tension(half_length, material);
      for (const double range : {0.2, 0.1, 0.05})
        for (const std::uint32_t cells : {80u, 160u}) {
          if (2 * half_length < 1.5 * range) continue;
          // Loads are as the roots of energies. A reach longer than the sheet asks for more of the
          // few particles of the greatest range.
          const bool is_far = return_stiffness < 100 && half_length < 1.5 * range;
          EXPECT_NEAR(std::sqrt(release_of_slit(cells, half_length, range, material) / wanted), 1,
                      is_far ? 0.1 : 0.05)
              << return_stiffness << " " << half_length << " " << range << " " << cells;
        }
    }
}

TEST(Toughness, is_exceeded_at_about_the_same_load_near_another_border) {
  constexpr double kHalfLength = 0.44;  // of a sheet of one metre
  for (const double return_stiffness : {40.0, 400.0}) {
    const SoftMaterial material = tough(return_stiffness);
    const double wanted = release_under_tension(kHalfLength, material);
    for (const double range : {0.2, 0.1, 0.05})
      EXPECT_NEAR(std::sqrt(release_of_slit(80, kHalfLength, range, material) / wanted), 1, 0.14)
          << return_stiffness << " " << range;
  }
}

TEST(Toughness, is_exceeded_at_the_same_load_on_a_bent_sheet) {
  constexpr double kHalfLength = 0.2;
  const SoftMaterial material = tough(400);
  const double wanted = release_under_tension(kHalfLength, material);
  for (const double radius : {1.0, 0.25})
    for (const double range : {0.2, 0.1}) {
      Character bent = make_sheet(80);
      for (Vec3f& at : bent.meshes[0].positions) {
        const double angle = (double{at.y()} - 0.5) / radius;
        at = Vec3d(at.x(), radius * std::sin(angle), radius * std::cos(angle)).cast<float>();
      }
      Eigen::AlignedBox3f box;
      for (const Vec3f& at : bent.meshes[0].positions) box.extend(Eigen::Vector3f(at));
      SoftScene scene(std::move(bent), material, range / double{box.diagonal().norm()});
      const auto blade = [&](double x) {
        return Blade{{x, 0.003, radius + 0.1}, {x, 0.003, radius - 0.1}};
      };
      const std::array<Blade, 2> stroke = {blade(0.5 - kHalfLength), blade(0.5 + kHalfLength)};
      ChangeRecord change;
      ASSERT_TRUE(scene.model->tear(scene.pose, stroke, {}, &change));
      ASSERT_TRUE(scene.set->follow(*scene.model, {&change, 1}));
      ASSERT_TRUE(scene.body->set_tension({1.2, {}}));
      scene.run(20, 0.1);
      ASSERT_TRUE(scene.body->set_tension({kPulledTension, {}}));
      EXPECT_NEAR(
          std::sqrt(release_of_tips(*scene.body, *scene.set, *scene.model, scene.pose) / wanted), 1,
          0.06)
          << radius << " " << range;
    }
}

/// The forces on the points of a SlitSheet: of two patches on both sides of the slit, between its
/// tips and near them.
std::vector<Vec3d> pull_apart(const test::SlitSheet& sheet, std::uint32_t cells) {
  std::vector<Vec3d> forces;
  for (const Vec3f& at : sheet.set->positions()) {
    const double x = std::abs(double{at.x()} - 0.5), y = double{at.y()} - 0.503;
    const bool is_pulled = x < 0.15 && std::abs(y) > 0.04 && std::abs(y) < 0.12;
    forces.emplace_back(0, is_pulled ? std::copysign(20.0 / (cells * cells), y) : 0.0, 0);
  }
  return forces;
}

TEST(Toughness, is_exceeded_at_the_same_load_if_forces_pull_next_to_the_tips) {
  constexpr double kHalfLength = 0.2;
  const SoftMaterial material = tough(400);
  const double wanted = release_by_energies(
      kHalfLength, material, [](const test::SlitSheet& sheet) { return pull_apart(sheet, 160); });
  for (const double range : {0.2, 0.1, 0.05})
    for (const std::uint32_t cells : {80u, 160u}) {
      test::SlitSheet sheet(cells, kHalfLength, range, material);
      const std::vector<Vec3d> at_points = pull_apart(sheet, cells);
      std::vector<Vec3d> forces(sheet.set->particle_count(), Vec3d::Zero());
      for (std::uint32_t p = 0; p < at_points.size(); ++p)
        if (const std::uint32_t owner = sheet.set->owners()[p]; owner != kNone)
          forces[owner] += at_points[p];
      for (const double part : {0.9, 1.0}) {  // at the end it is awake
        for (std::uint32_t p = 0; p < forces.size(); ++p)
          ASSERT_TRUE(sheet.body->set_force(p, part * forces[p]));
        for (int i = 0; part < 1 && i < 100; ++i)
          ASSERT_TRUE(sheet.body->step(*sheet.model, sheet.pose, 0.1));
      }
      EXPECT_NEAR(
          std::sqrt(release_of_tips(*sheet.body, *sheet.set, *sheet.model, sheet.pose) / wanted), 1,
          0.12)
          << range << " " << cells;
    }
}

TEST(Toughness, is_exceeded_at_about_the_same_load_at_the_blunt_ends_of_a_gap) {
  const SoftMaterial material = tough(400);
  const double wanted = release_under_tension(0.2, material);
  for (const double range : {0.2, 0.1, 0.05})
    for (const std::uint32_t cells : {80u, 160u}) {
      SoftScene scene(make_sheet(cells), material, range / kDiagonal);
      const std::array<Blade, 2> stroke = {down_at(0.503, 0.3012), down_at(0.503, 0.6987)};
      TearOptions options;
      options.width = 0.01;
      ChangeRecord change;
      ASSERT_TRUE(scene.model->tear(scene.pose, stroke, options, &change));
      ASSERT_TRUE(scene.set->follow(*scene.model, {&change, 1}));
      ASSERT_TRUE(scene.body->set_tension({1.1, {}}));
      scene.run(20, 0.1);
      ASSERT_TRUE(scene.body->set_tension({kPulledTension, {}}));
      EXPECT_NEAR(
          std::sqrt(release_of_tips(*scene.body, *scene.set, *scene.model, scene.pose) / wanted), 1,
          0.3)
          << range << " " << cells;
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

/// Newtons per square metre on a round patch in the middle of a sheet, fading to its edge.
Vec3d pull_of_patch(const Vec3f& at) {
  const double x = double{at.x()} - 0.5, y = double{at.y()} - 0.5;
  const double rest = std::max(0.0, 1 - (x * x + y * y) / (0.45 * 0.45));
  return {40 * rest * rest, 0, 0};
}

/// The greatest stretch of a sheet whose patch is pulled, by finite elements.
double greatest_stretch_by_elements(const SoftMaterial& material) {
  constexpr std::uint32_t kCells = 160;
  const SoftScene scene(make_sheet(kCells), material, 0.2);
  const std::span<const Vec3f> at = scene.set->positions();
  std::vector<Vec3d> forces;
  for (const Vec3f& place : at) forces.push_back(pull_of_patch(place) / (kCells * kCells));
  const std::vector<Vec3d> moved = test::solve_membrane(*scene.model, at, material, forces);
  double greatest = 1;
  for (const Triangle& face : scene.character->meshes[0].triangles) {
    // The points of a sheet are its vertices.
    Eigen::Matrix2d edges, changed;
    for (int k = 0; k < 2; ++k) {
      const std::uint32_t a = face[0], b = face[static_cast<std::size_t>(k) + 1];
      edges.col(k) = (at[b] - at[a]).head<2>().cast<double>();
      changed.col(k) = edges.col(k) + (moved[b] - moved[a]).head<2>();
    }
    const Eigen::Matrix2d map = changed * edges.inverse();
    greatest = std::max(greatest, Eigen::JacobiSVD<Eigen::Matrix2d>(map).singularValues()[0]);
  }
  return greatest;
}

TEST(Strength, is_exceeded_at_the_same_load_at_any_range_and_on_any_mesh) {
  SoftMaterial material;
  const double wanted = greatest_stretch_by_elements(material);
  EXPECT_GT(wanted, 1.1);
  for (const double range : {0.2, 0.1, 0.05})
    for (const std::uint32_t cells : {80u, 160u}) {
      material.strength = 100;
      SoftScene scene(make_sheet(cells), material, range / kDiagonal);
      std::vector<Vec3d> forces(scene.count(), Vec3d::Zero());
      for (std::uint32_t p = 0; p < scene.set->point_count(); ++p)
        forces[scene.set->owners()[p]] +=
            pull_of_patch(scene.set->positions()[p]) / (cells * cells);
      for (std::uint32_t p = 0; p < scene.count(); ++p)
        ASSERT_TRUE(scene.body->set_force(p, forces[p]));
      scene.run(0.4);  // nothing sleeps yet
      const auto tear = [&] {
        const auto report = tear_overstretched(*scene.body, *scene.set, *scene.model, scene.pose);
        EXPECT_TRUE(report);
        return *report;
      };
      const double stretch = tear().greatest_stretch;
      EXPECT_NEAR((stretch - 1) / (wanted - 1), 1, 0.15) << range << " " << cells;
      for (const bool is_strong : {true, false}) {
        material.strength = 1 + (is_strong ? 1.01 : 0.99) * (stretch - 1);
        ASSERT_TRUE(scene.body->change_material(0, material));
        EXPECT_NE(tear().has_torn, is_strong);
      }
    }
}

TEST(Strength, a_slit_as_long_as_the_flaws_runs_on_at_the_strength) {
  for (const double range : {0.1, 0.05})
    for (const double over : {0.85, 1.15}) {
      SoftMaterial material = tissue(1.2);
      material.flaw_length = 0.2;
      test::SlitSheet sheet(160, 0.1, range, material);
      // A membrane without foundation, under the tension that stretches it to its strength.
      material.return_frequency = test::frequency_of(1);
      ASSERT_TRUE(sheet.body->change_material(0, material));
      const double tension = over * material.membrane_stiffness * (material.strength - 1);
      ASSERT_TRUE(sheet.body->set_tension({tension, {}}));
      for (int i = 0; i < 100; ++i) ASSERT_TRUE(sheet.body->step(*sheet.model, sheet.pose, 0.1));
      ASSERT_TRUE(sheet.body->set_tension({1.001 * tension, {}}));
      ASSERT_TRUE(sheet.body->step(*sheet.model, sheet.pose, 0.1));
      const auto report = tear_overstretched(*sheet.body, *sheet.set, *sheet.model, sheet.pose);
      ASSERT_TRUE(report);
      EXPECT_EQ(report->has_torn, over > 1) << range;
      EXPECT_EQ(report->is_from_tip, over > 1) << range;
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
