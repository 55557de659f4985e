// Threads of sutures hold lips of soft tissue together, and break.

#include <algorithm>
#include <cmath>

#include <gmock/gmock.h>

#include "particles/soft_scene.h"
#include "support/machine/checked.h"
#include "support/models/random_operations.h"
#include "support/oracles/membrane.h"

namespace sunder {
namespace {

using test::checked;
using test::Random;

constexpr double kPull = 1.2;  // N/m

void undo(test::SlitSheet& sheet) {
  ChangeRecord change;
  test::check(sheet.model->undo(&change));
  test::check(sheet.set->follow(*sheet.model, {&change, 1}));
}

double gap_at(const test::SlitSheet& sheet, const SutureThread& thread) {
  return (sheet.body->point_displacement(thread.left) -
          sheet.body->point_displacement(thread.right))
      .norm();
}

TEST(SewnTissue, GapesBetweenThreadsAsFiniteElementsSay) {
  constexpr double kRange = 0.05;
  for (const double stiffness : {0.3, 3.0, 3e3})
    for (const double spacing : {0.1, 0.2}) {
      SCOPED_TRACE(testing::Message() << stiffness << " N/m, " << spacing << " m");
      test::SlitSheet sheet(160, 0.3, kRange, {});
      sheet.open(kPull);
      const double open = gap_of(sheet).widest();
      Suture suture;
      suture.spacing = spacing;
      suture.stiffness = stiffness;
      sheet.sew(suture);
      sheet.open(kPull);
      const test::GapProfile gap = gap_of(sheet),
                             wanted = reference_gap(sheet, kPull, 0.5 * kRange);
      EXPECT_LT(widest_between_threads(sheet, gap), 0.95 * open);
      EXPECT_NEAR(widest_between_threads(sheet, gap) / widest_between_threads(sheet, wanted), 1,
                  0.1);
      EXPECT_LT(rms_difference(gap, wanted), 0.15);
    }
}

TEST(SewnTissue, LoadsThreadsByTheirStiffnessTimesTheirLength) {
  test::SlitSheet sheet(60, 0.3, 0.1, {});
  Suture suture;
  suture.spacing = 0.1;
  suture.stiffness = 5;
  sheet.sew(suture);
  sheet.open(kPull);
  const auto threads = threads_of(*sheet.model);
  const auto loads = thread_loads(*sheet.body);
  ASSERT_EQ(loads.size(), threads.size());
  for (std::size_t i = 0; i < threads.size(); ++i) {
    EXPECT_GT(loads[i].newtons, 0);
    EXPECT_NEAR(loads[i].newtons, 5 * gap_at(sheet, threads[i]), 1e-12);
  }
}

TEST(SewnTissue, StaysClosedUnderLessThanTheTensionOfItsThreads) {
  test::SlitSheet sheet(60, 0.3, 0.1, {});
  sheet.open(kPull);
  Suture suture;
  suture.spacing = 0.1;
  suture.stiffness = 1;
  suture.tension = 10;  // more than the pull on the whole slit
  sheet.sew(suture);
  sheet.open(kPull);
  const auto threads = threads_of(*sheet.model);
  for (std::size_t i = 0; i < threads.size(); ++i) {
    EXPECT_LT(gap_at(sheet, threads[i]), 1e-3 * 0.1);
    EXPECT_LT(thread_loads(*sheet.body)[i].newtons, 10);
  }
}

/// Sews an open slit, pulls, and counts the threads that broke.
struct BrokenThreads {
  std::ptrdiff_t broken = 0, all = 0;
};
BrokenThreads break_threads(double strength) {
  test::SlitSheet sheet(60, 0.3, 0.1, {});
  sheet.open(kPull);
  const double open = gap_of(sheet).widest();
  Suture suture;
  suture.spacing = 0.1;
  suture.stiffness = 5;
  suture.strength = strength;
  sheet.sew(suture);
  sheet.open(kPull);
  const auto loads = thread_loads(*sheet.body);
  const BrokenThreads found = {std::count_if(loads.begin(), loads.end(),
                                             [](const ThreadLoad& load) { return load.is_broken; }),
                               std::ptrdiff_t(loads.size())};
  for (const ThreadLoad& load : loads) EXPECT_LE(load.newtons, strength);
  if (found.broken == found.all) {
    EXPECT_NEAR(gap_of(sheet).widest(), open, 1e-3 * open);
  }
  // Undone and tied anew.
  undo(sheet);
  sheet.open(kPull);
  EXPECT_TRUE(thread_loads(*sheet.body).empty());
  EXPECT_NEAR(gap_of(sheet).widest(), open, 0.02 * open);
  ChangeRecord again;
  test::check(sheet.model->redo(&again));
  test::check(sheet.set->follow(*sheet.model, {&again, 1}));
  (void)sheet.body->displacements();
  EXPECT_EQ(std::ptrdiff_t(thread_loads(*sheet.body).size()), found.all);
  for (const ThreadLoad& load : thread_loads(*sheet.body)) EXPECT_FALSE(load.is_broken);
  return found;
}

TEST(SewnTissue, BreaksThreadsThatBearTooMuch) {
  EXPECT_EQ(break_threads(1e6).broken, 0);
  const BrokenThreads weak = break_threads(1e-3);
  EXPECT_GT(weak.all, 3);
  EXPECT_EQ(weak.broken, weak.all);
}

TEST(SewnTissue, SleepsWhenItIsAtRestAndWakesWhenItIsUndone) {
  test::SlitSheet sheet(60, 0.3, 0.1, {});
  sheet.open(kPull);
  const double open = gap_of(sheet).widest();
  sheet.sew({});
  sheet.open(kPull);
  EXPECT_EQ(sheet.body->awake_count(), 0u);
  EXPECT_FALSE(sheet.body->needs_step());
  EXPECT_LT(gap_of(sheet).widest(), 0.3 * open);
  undo(sheet);
  EXPECT_TRUE(sheet.body->needs_step());
  for (int i = 0; i < 300; ++i) test::check(sheet.body->step(*sheet.model, sheet.pose, 1.0 / 30));
  EXPECT_NEAR(gap_of(sheet).widest(), open, 0.02 * open);
}

TEST(SewnTissue, IsSavedWithItsThreads) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    SCOPED_TRACE(seed);
    Random random(seed);
    const auto character = std::make_shared<const Character>(test::random_character(random));
    const ModelPose pose = *bind_pose(*character);
    auto model = checked(TornModel::create(character));
    const auto asset = checked(ParticleAsset::create(model, pose));
    auto set = checked(ParticleSet::create(asset, model));
    const SoftMaterial material;
    auto body = checked(SoftBody::create(set, pose, {&material, 1}));
    test::check(body.set_tension({20, {}}));
    const auto run = [&](SoftBody& of) {
      for (int i = 0; i < 20; ++i) test::check(of.step(model, pose, 1.0 / 60));
    };
    const auto play = [&](auto call) {
      ChangeRecord change;
      (void)checked(call(&change));
      test::check(set.follow(model, {&change, 1}));
      run(body);
    };
    play([&](ChangeRecord* change) {
      return test::play(model, test::random_tear(model, random, false), change);
    });
    Suture suture;
    suture.spacing = 0.05;
    suture.strength = random.uniform(0.01, 5);
    play([&](ChangeRecord* change) { return sunder::suture(model, pose, suture, change); });
    const StateArrays of_set = checked(set.save()), of_body = checked(body.save());
    auto set_again = checked(ParticleSet::restore(asset, model, of_set));
    auto body_again = checked(SoftBody::create(set_again, pose, {&material, 1}));
    test::check(body_again.restore(of_body));
    run(body);
    run(body_again);
    ASSERT_EQ(thread_loads(body).size(), threads_of(model).size());
    ASSERT_EQ(thread_loads(body_again).size(), threads_of(model).size());
    for (std::size_t i = 0; i < thread_loads(body).size(); ++i) {
      EXPECT_EQ(thread_loads(body)[i].is_broken, thread_loads(body_again)[i].is_broken);
      EXPECT_EQ(thread_loads(body)[i].newtons, thread_loads(body_again)[i].newtons);
    }
    for (std::uint32_t p = 0; p < body.particle_count(); ++p)
      EXPECT_EQ(body.displacement(p), body_again.displacement(p));
  }
}

}  // namespace
}  // namespace sunder
