// A suture ties threads between the lips of wounds, and changes no surface.

#include <sunder/skinning/pose.h>
#include <sunder/tear/torn_model.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <set>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/machine/checked.h"
#include "support/models/random_operations.h"
#include "support/models/rigs.h"
#include "support/oracles/posed_points.h"
#include "support/oracles/torn_invariants.h"

namespace sunder {
namespace {

using test::checked;
using test::Random;
using testing::IsEmpty;

TEST(Suture, TiesPointsThatAreApartButAtOnePlace) {
  std::size_t threads = 0;
  for (std::uint64_t seed = 0; seed < 150; ++seed) {
    SCOPED_TRACE(seed);
    Random random(seed);
    auto model = checked(
        TornModel::create(std::make_shared<const Character>(test::random_character(random))));
    for (std::uint32_t i = 0; i < 3; ++i)
      (void)checked(test::play(model, test::random_lossless_operation(model, random, i % 2 == 1)));
    const std::uint64_t torn = model.digest();
    const ModelPose pose = test::random_pose(model.source(), random);
    Suture suture;
    suture.spacing = random.uniform(0.01, 0.2);
    suture.strength = 2;
    ChangeRecord change;
    const TearReport report = checked(sunder::suture(model, pose, suture, &change));
    EXPECT_THAT(change.meshes, IsEmpty());
    EXPECT_EQ(change.point_count, 0u);
    EXPECT_EQ(report.runs > 0, !threads_of(model).empty());
    threads += threads_of(model).size();
    if (report.runs == 0) continue;
    const std::vector<SutureThread> tied(threads_of(model).begin(), threads_of(model).end());
    const auto places = test::posed_points(model, test::random_pose(model.source(), random));
    for (const SutureThread& thread : tied) {
      EXPECT_NE(thread.left, thread.right);
      EXPECT_LT((places.at(thread.left) - places.at(thread.right)).norm(),
                1e-5 * test::posed_diagonal(model.source(), pose));
      EXPECT_EQ(thread.strength, 2);
    }
    EXPECT_THAT(test::broken_laws(model), IsEmpty());
    const std::uint64_t sewn = model.digest();
    EXPECT_NE(sewn, torn);
    ASSERT_TRUE(model.undo());
    EXPECT_EQ(model.digest(), torn);
    EXPECT_THAT(threads_of(model), IsEmpty());
    ASSERT_TRUE(model.redo());
    EXPECT_EQ(model.digest(), sewn);
    EXPECT_TRUE(std::ranges::equal(threads_of(model), tied));
    // A replay of the history gives the same threads.
    auto again = checked(TornModel::create(
        std::shared_ptr<const Character>(std::shared_ptr<void>(), &model.source())));
    for (const Operation& operation : checked(model.history()))
      (void)checked(apply_operation(again, operation));
    EXPECT_EQ(again.digest(), sewn);
    ASSERT_TRUE(model.pack());
    EXPECT_TRUE(std::ranges::equal(threads_of(model), tied));
  }
  EXPECT_GT(threads, 500u);
}

/// A sheet in the square from 0 to 1 with a slit of 0.8.
TornModel slit_sheet(std::uint32_t cells, const ModelPose& pose) {
  auto model =
      checked(TornModel::create(std::make_shared<const Character>(test::make_sheet(cells))));
  (void)checked(model.tear(pose, Stroke{test::down_at(0.1, 0.503), test::down_at(0.9, 0.503)}, {}));
  return model;
}

std::vector<double> places_along(const TornModel& model, const ModelPose& pose) {
  std::vector<double> along;
  const auto places = test::posed_points(model, pose);
  for (const SutureThread& thread : threads_of(model)) along.push_back(places.at(thread.left).x());
  std::sort(along.begin(), along.end());
  return along;
}

TEST(Suture, SpacesThreadsEvenlyAlongTheWound) {
  const ModelPose pose = checked(rest_pose(test::make_sheet(4)));
  for (const std::uint32_t cells : {50u, 100u, 200u}) {
    TornModel model = slit_sheet(cells, pose);
    Suture suture;
    suture.spacing = 0.1;
    const TearReport report = checked(sunder::suture(model, pose, suture));
    EXPECT_EQ(report.runs, 1u);
    EXPECT_EQ(threads_of(model).size(), 8u);
    EXPECT_NEAR(report.length_posed, 0.8, 1e-6);
    const std::vector<double> along = places_along(model, pose);
    ASSERT_EQ(along.size(), 8u);
    for (std::size_t i = 0; i < along.size(); ++i)
      EXPECT_NEAR(along[i], 0.15 + 0.1 * static_cast<double>(i), 0.51 / cells);
  }
}

TEST(Suture, TiesEveryPointOfALipWhereTheSpacingIsFiner) {
  const ModelPose pose = checked(rest_pose(test::make_sheet(4)));
  TornModel model = slit_sheet(8, pose);
  Suture suture;
  suture.spacing = 1e-20;
  (void)checked(sunder::suture(model, pose, suture));
  std::set<std::uint32_t> tied;
  for (const SutureThread& thread : threads_of(model)) tied.insert({thread.left, thread.right});
  EXPECT_EQ(tied.size(), 2 * threads_of(model).size());
  EXPECT_GT(threads_of(model).size(), 6u);
}

TEST(Suture, OfAPlaceReachesOnlySoFarAlongTheWound) {
  const ModelPose pose = checked(rest_pose(test::make_sheet(4)));
  TornModel model = slit_sheet(100, pose);
  Suture suture;
  suture.spacing = 0.02;
  suture.places = {Vec3d(0.5, 0.5, 0)};
  suture.reach = 0.1;
  (void)checked(sunder::suture(model, pose, suture));
  EXPECT_GT(threads_of(model).size(), 6u);
  for (const double x : places_along(model, pose)) EXPECT_NEAR(x, 0.5, 0.12);
}

TEST(Suture, OfAClosedCutGoesAllAround) {
  auto model =
      checked(TornModel::create(std::make_shared<const Character>(test::make_bumpy_ball(2000))));
  const ModelPose pose = checked(rest_pose(model.source()));
  (void)checked(model.cut(pose, PlaneCut{Vec3d(0, 0.01, 0), Vec3d(0, 1, 0), {}, true}));
  Suture suture;
  suture.spacing = 0.3;
  const TearReport report = checked(sunder::suture(model, pose, suture));
  EXPECT_EQ(report.runs, 1u);
  EXPECT_NEAR(double(threads_of(model).size()), report.length_posed / 0.3, 1);
}

TEST(Suture, RefusesBadOptionsAndChangesNothing) {
  const ModelPose pose = checked(rest_pose(test::make_sheet(4)));
  TornModel model = slit_sheet(8, pose);
  const std::uint64_t before = model.digest();
  const auto refused = [&](auto change, const char* text) {
    Suture suture;
    change(suture);
    const auto report = sunder::suture(model, pose, suture);
    ASSERT_FALSE(report);
    EXPECT_THAT(std::string(report.error().text()), testing::HasSubstr(text));
    EXPECT_EQ(model.digest(), before);
  };
  const double kNan = std::numeric_limits<double>::quiet_NaN();
  refused([](Suture& of) { of.spacing = 0; }, "spacing is 0 m");
  refused([kNan](Suture& of) { of.spacing = kNan; }, "spacing");
  refused([](Suture& of) { of.stiffness = -1; }, "stiffness is -1 N/m");
  refused([](Suture& of) { of.tension = -1; }, "tension is -1 N");
  refused([](Suture& of) { of.strength = 1e13; }, "strength is 1e+13 N");
  refused([](Suture& of) { of.reach = -1; }, "reach is -1 m");
  refused([kNan](Suture& of) { of.places = {Vec3d(0, kNan, 0)}; },
          "place 0 near the wounds to sew");
}

TEST(Suture, OfAnUntornModelDoesNothing) {
  auto model = checked(TornModel::create(std::make_shared<const Character>(test::make_sheet(4))));
  const TearReport report = checked(sunder::suture(model, checked(rest_pose(model.source())), {}));
  EXPECT_EQ(report.runs, 0u);
  EXPECT_EQ(model.undo_count(), 0u);
}

}  // namespace
}  // namespace sunder
