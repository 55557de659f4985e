// Where memory runs out in a model that grows, a call says so and changes nothing.

#include <sunder/skinning/pose.h>
#include <sunder/tear/refit_job.h>
#include <sunder/tear/tear_stroke.h>
#include <sunder/tear/topology.h>
#include <sunder/tear/torn_weights.h>

#include <functional>
#include <optional>

#include <gtest/gtest.h>

#include "support/machine/starve.h"
#include "support/models/make_model.h"
#include "support/models/random_operations.h"
#include "support/models/rigs.h"
#include "support/oracles/model_state.h"

namespace sunder {
namespace {

using test::FailingAllocations;
using test::ModelState;
using test::starve;
using test::status_of;

/// A model, and what refers to it.
struct Subject {
  explicit Subject(std::shared_ptr<const Character> source)
      : model(*TornModel::create(std::move(source))), bind(*bind_pose(model.source())) {}

  TornModel model;
  ModelPose bind;
  std::optional<TearStroke> stroke;
  std::optional<RefitJob> job;
  ChangeRecord change;
  std::vector<ChangeRecord> changes;
};

/// All that a model tells, its history included.
struct Whole {
  explicit Whole(const Subject& of)
      : state(test::state_of(of.model)),
        undo_count(of.model.undo_count()),
        redo_count(of.model.redo_count()),
        newest(of.model.newest_operation()),
        is_in_stroke(of.model.is_in_stroke()),
        changes(of.changes.size()) {}

  ModelState state;
  std::uint32_t undo_count, redo_count;
  std::uint64_t newest;
  bool is_in_stroke;
  std::size_t changes;
};

void expect_same(const Whole& a, const Whole& b) {
  EXPECT_EQ(test::difference(a.state, b.state), "");
  EXPECT_EQ(a.undo_count, b.undo_count);
  EXPECT_EQ(a.redo_count, b.redo_count);
  EXPECT_EQ(a.newest, b.newest);
  EXPECT_EQ(a.is_in_stroke, b.is_in_stroke);
  EXPECT_EQ(a.changes, b.changes);
}

using Prepare = std::function<void(Subject&)>;
using Call = std::function<Status(Subject&)>;

/// Starves a call on a prepared model. After a failure the model is as before, and the same call
/// gives what it gives to a model that never lacked memory. So does all that can be undone.
void starve_model(const std::shared_ptr<const Character>& source, const Prepare& prepare,
                  const Call& call) {
  Subject fed(source);
  prepare(fed);
  ASSERT_TRUE(call(fed));
  const ModelState after = test::state_of(fed.model);
  std::optional<Whole> before;
  starve(
      [&] {
        auto subject = std::make_unique<Subject>(source);
        prepare(*subject);
        before.emplace(*subject);
        return subject;
      },
      call,
      [&](Subject& subject, const Status& status) {
        if (!status) {
          ASSERT_NO_FATAL_FAILURE(expect_same(*before, Whole(subject)));
          const Status again = call(subject);
          ASSERT_TRUE(again) << again.text();
        }
        ASSERT_EQ(test::difference(after, test::state_of(subject.model)), "");
        if (subject.model.is_in_stroke()) return;
        subject.stroke.reset();
        const std::uint32_t count = subject.model.undo_count();
        while (subject.model.undo_count() > 0) ASSERT_TRUE(subject.model.undo());
        ASSERT_EQ(subject.model.character(), subject.model.source());
        while (subject.model.undo_count() < count) ASSERT_TRUE(subject.model.redo());
        ASSERT_EQ(test::difference(after, test::state_of(subject.model)), "");
      });
}

std::shared_ptr<const Character> sheet() {
  static const auto character = std::make_shared<const Character>(test::make_sheet(6));
  return character;
}
std::shared_ptr<const Character> tubes() {
  static const auto character = std::make_shared<const Character>(test::make_two_tubes(5, 7));
  return character;
}

const Stroke kAcross = {test::down_at(0.31, -0.1), test::down_at(0.36, 0.5),
                        test::down_at(0.63, 0.7)};
const Stroke kAlong = {test::down_at(0.05, 0.43), test::down_at(0.93, 0.52)};

void nothing(Subject&) {}

void torn_once(Subject& subject) {
  ASSERT_TRUE(subject.model.tear(subject.bind, kAlong, {.width = 0.04}));
}

Call tear_with(const TearOptions& options) {
  return [=](Subject& subject) {
    return status_of(subject.model.tear(subject.bind, kAcross, options, &subject.change));
  };
}

TEST(AllocationFailure, tears_change_nothing) {
  for (const Prepare& prepare : {Prepare(nothing), Prepare(torn_once)})
    for (const Layers layers : {Layers::nearest, Layers::all})
      for (const double width : {0.0, 0.06})
        for (const double wall_depth : {0.0, 0.05})
          ASSERT_NO_FATAL_FAILURE(starve_model(
              sheet(), prepare,
              tear_with({.width = width, .layers = layers, .wall_depth = wall_depth})));
}

TEST(AllocationFailure, tears_with_other_weights_change_nothing) {
  for (const WeightOptions& weights :
       {WeightOptions{WeightPolicy::barycentric, 1}, WeightOptions{WeightPolicy::pose_exact, 2},
        WeightOptions{WeightPolicy::exact, 0}})
    ASSERT_NO_FATAL_FAILURE(starve_model(
        sheet(), torn_once, tear_with({.width = 0.06, .wall_depth = 0.05, .weights = weights})));
}

TEST(AllocationFailure, cuts_and_bores_change_nothing) {
  PlaneCut whole;
  whole.point = Vec3d(0.0, 0.9, 0.0);
  whole.normal = Vec3d(0.2, 1.0, 0.1);
  whole.caps = true;
  PlaneCut limited = whole;
  const Vec3d x = whole.normal.unitOrthogonal(), y = whole.normal.normalized().cross(x);
  for (const auto& [right, up] : {std::pair(-9, -9), {9, -9}, {9, 9}, {-9, 9}})
    limited.bounds.push_back(whole.point + right * x + up * y);
  limited.bone = tubes()->skeleton.bones[0].name;
  for (const PlaneCut& plane : {whole, limited})
    ASSERT_NO_FATAL_FAILURE(starve_model(tubes(), nothing, [&](Subject& subject) {
      return status_of(subject.model.cut(subject.bind, plane, &subject.change));
    }));
  const auto drill = [](Subject& subject) {
    Bore bore;
    bore.origin = Vec3d(0.5, 0.5, 0.5);
    bore.radius = 0.2;
    bore.depth = 1.0;
    bore.wall = true;
    return status_of(subject.model.drill(subject.bind, bore, &subject.change));
  };
  ASSERT_NO_FATAL_FAILURE(starve_model(sheet(), torn_once, drill));
}

/// Three operations of different kinds, the last one with other weights.
void torn_thrice(Subject& subject) {
  torn_once(subject);
  ASSERT_TRUE(tear_with({.width = 0.06, .wall_depth = 0.05})(subject));
  WeightsOperation wanted;
  wanted.weights = {WeightPolicy::exact, 0};
  ASSERT_TRUE(subject.model.reweigh(wanted));
}

void undone_thrice(Subject& subject) {
  torn_thrice(subject);
  for (int i = 0; i < 3; ++i) ASSERT_TRUE(subject.model.undo());
}

TEST(AllocationFailure, undo_and_redo_change_nothing) {
  for (int undone = 0; undone < 3; ++undone) {
    const auto partly = [=](Subject& subject) {
      torn_thrice(subject);
      for (int i = 0; i < undone; ++i) ASSERT_TRUE(subject.model.undo());
    };
    ASSERT_NO_FATAL_FAILURE(starve_model(
        sheet(), partly, [](Subject& subject) { return subject.model.undo(&subject.change); }));
    const auto partly_redone = [=](Subject& subject) {
      undone_thrice(subject);
      for (int i = 0; i < undone; ++i) ASSERT_TRUE(subject.model.redo());
    };
    ASSERT_NO_FATAL_FAILURE(starve_model(sheet(), partly_redone, [](Subject& subject) {
      return subject.model.redo(&subject.change);
    }));
  }
}

TEST(AllocationFailure, several_undos_are_taken_back) {
  const auto play = [](const Operation& operation) {
    return [=](Subject& subject) {
      return status_of(apply_operation(subject.model, operation, &subject.changes));
    };
  };
  ASSERT_NO_FATAL_FAILURE(starve_model(sheet(), torn_thrice, play(UndoOperation{3})));
  ASSERT_NO_FATAL_FAILURE(starve_model(sheet(), undone_thrice, play(RedoOperation{3})));
  // Weights of operations that were undone before keep births that their redo refers to.
  const auto weighed_after_redo = [](Subject& subject) {
    torn_once(subject);
    ASSERT_TRUE(subject.model.undo());
    ASSERT_TRUE(subject.model.redo());
    WeightsOperation wanted;
    wanted.weights = {WeightPolicy::barycentric, 1};
    ASSERT_TRUE(subject.model.reweigh(wanted));
  };
  ASSERT_NO_FATAL_FAILURE(starve_model(sheet(), weighed_after_redo, play(UndoOperation{2})));
}

TEST(AllocationFailure, replay_changes_nothing) {
  TearOperation moving;
  moving.stroke = kAcross;
  moving.options = {.width = 0.05, .wall_depth = 0.04};
  test::Random random(3);
  moving.pose = test::random_pose(*sheet(), random, 0.1, 1.05);
  moving.pose_changes.push_back({2, test::random_pose(*sheet(), random, 0.1, 1.05)});
  const Operation operation = moving;
  ASSERT_NO_FATAL_FAILURE(starve_model(sheet(), torn_once, [&](Subject& subject) {
    return status_of(apply_operation(subject.model, operation, &subject.changes));
  }));
}

TEST(AllocationFailure, strokes_change_nothing) {
  const TearOptions options{.width = 0.05, .wall_depth = 0.04};
  const auto begin = [=](Subject& subject) -> Status {
    auto stroke = TearStroke::create(subject.model, subject.bind, kAcross[0], options);
    if (!stroke) return stroke.error();
    subject.stroke.emplace(std::move(*stroke));
    return {};
  };
  test::Random random(7);
  const ModelPose other = test::random_pose(*sheet(), random, 0.1, 1.05);
  const auto extend = [=](const ModelPose& pose, std::size_t blade) {
    return [=](Subject& subject) {
      return status_of(subject.stroke->extend(pose, kAcross[blade], 0, &subject.change));
    };
  };
  const ModelPose bind = *bind_pose(*sheet());
  const auto begun = [=](Subject& subject) {
    torn_once(subject);
    ASSERT_TRUE(begin(subject));
  };
  const auto extended = [=](Subject& subject) {
    begun(subject);
    ASSERT_TRUE(extend(bind, 1)(subject));
  };
  const auto nearly_ended = [=](Subject& subject) {
    extended(subject);
    ASSERT_TRUE(extend(other, 2)(subject));
  };
  ASSERT_NO_FATAL_FAILURE(starve_model(sheet(), torn_once, begin));
  ASSERT_NO_FATAL_FAILURE(starve_model(sheet(), begun, extend(bind, 1)));
  ASSERT_NO_FATAL_FAILURE(starve_model(sheet(), extended, extend(bind, 2)));
  ASSERT_NO_FATAL_FAILURE(starve_model(sheet(), extended, extend(other, 2)));
  ASSERT_NO_FATAL_FAILURE(starve_model(sheet(), nearly_ended, [](Subject& subject) {
    return status_of(subject.stroke->end(&subject.change));
  }));
  ASSERT_NO_FATAL_FAILURE(starve_model(sheet(), nearly_ended, [](Subject& subject) {
    return subject.stroke->cancel(&subject.change);
  }));
}

TEST(AllocationFailure, a_stroke_is_cancelled_without_memory) {
  if (!FailingAllocations::are_possible()) GTEST_SKIP();
  Subject subject(sheet());
  torn_once(subject);
  const Whole before(subject);
  auto stroke = TearStroke::create(subject.model, subject.bind, kAcross[0],
                                   {.width = 0.05, .wall_depth = 0.04});
  ASSERT_TRUE(stroke);
  for (std::size_t i = 1; i < kAcross.size(); ++i)
    ASSERT_TRUE(stroke->extend(subject.bind, kAcross[i]));
  {
    const FailingAllocations failing(0);
    EXPECT_TRUE(stroke->cancel());
  }
  expect_same(before, Whole(subject));
}

TEST(AllocationFailure, other_weights_change_nothing) {
  const auto torn = [](Subject& subject) {
    torn_once(subject);
    ASSERT_TRUE(tear_with({.width = 0.06})(subject));
  };
  for (const WeightPolicy policy : {WeightPolicy::barycentric, WeightPolicy::pose_exact,
                                    WeightPolicy::refit, WeightPolicy::exact}) {
    WeightsOperation wanted;
    wanted.weights = {policy, policy == WeightPolicy::exact ? 0u : 1u};
    wanted.refit.poses.range_of_motion = true;
    ASSERT_NO_FATAL_FAILURE(starve_model(sheet(), torn, [&](Subject& subject) {
      return status_of(subject.model.reweigh(wanted, &subject.change));
    }));
  }
}

TEST(AllocationFailure, compaction_changes_nothing) {
  ASSERT_NO_FATAL_FAILURE(starve_model(
      sheet(), torn_thrice, [](Subject& subject) { return status_of(subject.model.compact()); }));
}

TEST(AllocationFailure, accessors_say_so) {
  const auto made = [] {
    auto subject = std::make_unique<Subject>(sheet());
    torn_thrice(*subject);
    return subject;
  };
  const auto unchanged = [](Subject&, const Status&) {};
  starve(
      made, [](Subject& subject) { return subject.model.history(); }, unchanged);
  starve(
      made, [](Subject& subject) { return parent_blends(subject.model, 0); }, unchanged);
  starve(
      made, [](Subject& subject) { return count_topology(subject.model.character()); }, unchanged);
  const ModelPose pose = *bind_pose(*sheet());
  starve(
      made,
      [&](Subject& subject) {
        return measure_weight_errors(subject.model, 0, kNone, std::span(&pose, 1));
      },
      unchanged);
  const std::shared_ptr<const Character> source = tubes();
  starve(
      made, [&](Subject&) { return TornModel::create(source); }, unchanged);
  starve(
      made,
      [&](Subject&) {
        return TornModel::create(source, {100, 100, 2});
      },
      unchanged);
}

// Long enough that every array has to grow: one model lacks memory again and again, the other one
// never.
TEST(AllocationFailure, a_model_that_often_lacks_memory_ends_as_one_that_never_does) {
  if (!FailingAllocations::are_possible()) GTEST_SKIP();
  test::Random random(11);
  const auto source = std::make_shared<const Character>(test::make_two_tubes(12, 14));
  auto fed = TornModel::create(source), starved = TornModel::create(source);
  ASSERT_TRUE(fed && starved);
  const int operations = test::stressed(24, 6);
  std::uint32_t failures = 0;
  for (int i = 0; i < operations; ++i) {
    Operation operation = test::random_operation(*fed, random);
    if (i % 6 == 4) operation = UndoOperation{std::min(2u, fed->undo_count())};
    if (i % 6 == 5) operation = RedoOperation{std::min(2u, fed->redo_count())};
    const auto wanted = apply_operation(*fed, operation);
    for (std::uint64_t budget = 0;;
         budget = 1 + budget + random.index(1 + static_cast<std::uint32_t>(budget / 4))) {
      const std::uint64_t digest = starved->digest();
      Status status;
      ASSERT_NO_THROW({
        const FailingAllocations failing(budget);
        status = apply_operation(*starved, operation).error();
      });
      if (status.code() == wanted.error().code()) break;
      ASSERT_EQ(status.code(), StatusCode::limit_exceeded) << status.text();
      ASSERT_EQ(starved->digest(), digest) << "operation " << i << ", memory for " << budget;
      ++failures;
    }
    ASSERT_EQ(starved->digest(), fed->digest()) << "operation " << i;
  }
  EXPECT_EQ(test::difference(test::state_of(*starved), test::state_of(*fed)), "");
  EXPECT_GT(failures, 100u);
}

}  // namespace
}  // namespace sunder
