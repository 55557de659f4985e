// An operation in the background leaves the model as the call of the operation would.

#include <sunder/skinning/pose.h>
#include <sunder/tear/operation_job.h>

#include <thread>

#include <gtest/gtest.h>

#include "support/machine/stress.h"
#include "support/models/make_model.h"
#include "support/models/random_operations.h"
#include "support/models/rigs.h"
#include "support/oracles/model_state.h"

namespace sunder {
namespace {

using test::difference;
using test::make_model;
using test::Random;
using test::state_of;

Operation some_job_operation(const TornModel& model, Random& random) {
  if (random.index(4) > 0 || model.undo_count() == 0) return test::random_operation(model, random);
  WeightsOperation other;
  other.weights.policy = WeightPolicy::exact;
  return other;
}

PlaneCut job_cut_at(const Vec3d& point, const Vec3d& normal) {
  PlaneCut cut;
  cut.point = point;
  cut.normal = normal;
  return cut;
}

/// Two equal models, of which the second one has undone operations.
struct ModelPair {
  explicit ModelPair(std::uint64_t seed)
      : random(seed),
        character(test::random_character(random)),
        called(make_model(character)),
        swapped(make_model(character)) {
    for (std::uint32_t n = random.index(4); n > 0; --n) {
      const Operation operation = some_job_operation(called, random);
      EXPECT_TRUE(apply_operation(called, operation));
      EXPECT_TRUE(apply_operation(swapped, operation));
    }
    for (std::uint32_t n = random.index(3); n > 0; --n) {
      EXPECT_TRUE(test::play(swapped, test::random_operation(swapped, random)));
      if (swapped.undo_count() > called.undo_count()) {
        EXPECT_TRUE(swapped.undo());
      }
    }
  }
  Random random;
  Character character;
  TornModel called, swapped;
};

/// Operations with the weights of a new model in models that have others, before or after them.
TEST(OperationJob, a_history_keeps_the_weights_that_it_was_made_with) {
  for (const WeightPolicy policy : {WeightPolicy::pose_exact, WeightPolicy::refit})
    for (const bool are_set_before : {true, false}) {
      const Character character = test::make_tube(24, 16, 3);
      TornModel called = make_model(character), swapped = make_model(character);
      PlaneCut first = job_cut_at({0, 0.9, 0}, {0.1, 1, 0});
      first.weights = WeightOptions{};
      CutOperation next;
      next.pose = RestPose{};
      next.cut = job_cut_at({0, 0.4, 0}, {0, 1, 0.1});
      for (TornModel* const model : {&called, &swapped}) {
        if (are_set_before) {
          ASSERT_TRUE(model->set_weights({policy, 1}));
        }
        ASSERT_TRUE(model->cut(*rest_pose(character), first));
        ASSERT_TRUE(model->set_weights({policy, 1}));
      }
      ASSERT_TRUE(apply_operation(called, next));
      const auto job = OperationJob::create(swapped, next);
      ASSERT_TRUE(job) << job.error().text();
      job->run();
      ASSERT_TRUE(job->swap_in(swapped));
      EXPECT_EQ(difference(state_of(swapped), state_of(called)), "");
      // Both go on in the same way, from the births of the new vertices.
      Random random(1);
      for (int i = 0; i < 4; ++i) {
        const Operation more = test::random_operation(called, random);
        const auto expected = apply_operation(called, more), found = apply_operation(swapped, more);
        EXPECT_EQ(found.error().code(), expected.error().code());
        ASSERT_EQ(difference(state_of(swapped), state_of(called)), "") << i;
      }
      if (!are_set_before) continue;
      // Its history makes it again in a model that has the same weights, and in a new one.
      for (const bool has_weights : {true, false}) {
        TornModel again = make_model(character);
        if (has_weights) {
          ASSERT_TRUE(again.set_weights({policy, 1}));
        }
        for (const Operation& operation : *called.history())
          ASSERT_TRUE(apply_operation(again, operation));
        EXPECT_EQ(again.digest(), called.digest());
      }
    }
}

void expect_same_mesh(const MeshChange& found, const MeshChange& wanted) {
  EXPECT_EQ(found.mesh, wanted.mesh);
  EXPECT_EQ(found.first_vertex, wanted.first_vertex);
  EXPECT_EQ(found.vertex_count, wanted.vertex_count);
  EXPECT_EQ(found.first_triangle, wanted.first_triangle);
  EXPECT_EQ(found.triangle_count, wanted.triangle_count);
  EXPECT_EQ(found.births, wanted.births);
  EXPECT_EQ(found.rewritten, wanted.rewritten);
  EXPECT_EQ(found.retired, wanted.retired);
  EXPECT_EQ(found.dirty_vertices, wanted.dirty_vertices);
  EXPECT_EQ(found.dirty_triangles, wanted.dirty_triangles);
  EXPECT_EQ(found.released, wanted.released);
  EXPECT_EQ(found.returned, wanted.returned);
}

void expect_same_record(const ChangeRecord& found, const ChangeRecord& wanted) {
  EXPECT_EQ(found.first_point, wanted.first_point);
  EXPECT_EQ(found.point_count, wanted.point_count);
  EXPECT_EQ(found.lips, wanted.lips);
  EXPECT_EQ(found.rims.left, wanted.rims.left);
  EXPECT_EQ(found.rims.right, wanted.rims.right);
  EXPECT_EQ(found.welded, wanted.welded);
  ASSERT_EQ(found.meshes.size(), wanted.meshes.size());
  for (std::size_t i = 0; i < found.meshes.size(); ++i)
    expect_same_mesh(found.meshes[i], wanted.meshes[i]);
}

TEST(OperationJob, gives_the_bits_and_the_record_of_the_call) {
  for (int seed = 1; seed <= test::stressed(40, 400); ++seed) {
    SCOPED_TRACE(seed);
    ModelPair pair(static_cast<std::uint64_t>(seed));
    const Operation operation = some_job_operation(pair.called, pair.random);
    std::vector<ChangeRecord> wanted;
    const auto expected = apply_operation(pair.called, operation, &wanted);
    const auto job = OperationJob::create(pair.swapped, operation);
    ASSERT_TRUE(job) << job.error().text();
    std::thread worker([job] { job->run(); });
    worker.join();
    ASSERT_EQ(job->poll(), expected ? OperationJob::State::done : OperationJob::State::failed);
    if (!expected) continue;
    ChangeRecord change;
    const std::uint32_t done = pair.swapped.undo_count(), undone = pair.swapped.redo_count();
    const auto report = job->swap_in(pair.swapped, &change);
    ASSERT_TRUE(report) << report.error().text();
    EXPECT_EQ(report->faces_crossed, expected->faces_crossed);
    EXPECT_EQ(report->pieces.size(), expected->pieces.size());
    EXPECT_EQ(difference(state_of(pair.swapped), state_of(pair.called)), "");
    EXPECT_EQ(pair.swapped.undo_count(), pair.called.undo_count());
    // An operation that changes nothing is not recorded, and leaves what was undone.
    EXPECT_EQ(pair.swapped.redo_count(), pair.swapped.undo_count() == done ? undone : 0);
    ASSERT_EQ(wanted.size(), 1u);
    expect_same_record(change, wanted[0]);
    // Both go on in the same way.
    while (pair.called.undo_count() > 0) {
      ASSERT_TRUE(pair.called.undo());
      ASSERT_TRUE(pair.swapped.undo());
      ASSERT_EQ(pair.swapped.digest(), pair.called.digest());
    }
    while (pair.called.redo_count() > 0) {
      ASSERT_TRUE(pair.called.redo(&wanted[0]));
      ASSERT_TRUE(pair.swapped.redo(&change));
      ASSERT_EQ(pair.swapped.digest(), pair.called.digest());
      expect_same_record(change, wanted[0]);
    }
  }
}

TEST(OperationJob, that_misses_changes_nothing) {
  TornModel model = make_model(test::make_sheet(8));
  const ModelPose rest = *rest_pose(model.source());
  ChangeRecord change;
  ASSERT_TRUE(model.cut(rest, job_cut_at(Vec3d(0.5, 0.5, 0), Vec3d::UnitX()), &change));
  ASSERT_FALSE(change.lips.empty());
  const auto torn = state_of(model);
  const auto job =
      OperationJob::create(model, CutOperation{rest, job_cut_at(Vec3d(9, 9, 9), Vec3d::UnitX())});
  ASSERT_TRUE(job);
  job->run();
  const auto report = job->swap_in(model, &change);
  ASSERT_TRUE(report) << report.error().text();
  EXPECT_EQ(report->runs, 0u);
  EXPECT_TRUE(change.lips.empty());
  EXPECT_EQ(difference(state_of(model), torn), "");
  EXPECT_EQ(model.undo_count(), 1u);
}

TEST(OperationJob, is_refused_where_it_does_not_fit) {
  TornModel model = make_model(test::make_sheet(8));
  const ModelPose rest = *rest_pose(model.source());
  const CutOperation cut = {rest, job_cut_at(Vec3d(0.5, 0.5, 0), Vec3d::UnitX())};
  EXPECT_EQ(OperationJob::create(model, UndoOperation{}).error().code(),
            StatusCode::invalid_argument);
  const auto job = OperationJob::create(model, cut);
  ASSERT_TRUE(job);
  EXPECT_EQ(job->swap_in(model).error().code(), StatusCode::invalid_argument);  // not run yet
  job->run();
  TornModel other = make_model(test::make_sheet(8));
  EXPECT_EQ(job->swap_in(other).error().code(), StatusCode::invalid_argument);
  ASSERT_TRUE(model.cut(rest, job_cut_at(Vec3d(0.25, 0.5, 0), Vec3d::UnitX())));
  const auto torn = state_of(model);
  EXPECT_EQ(job->swap_in(model).error().code(), StatusCode::invalid_argument);
  EXPECT_EQ(difference(state_of(model), torn), "");
  ASSERT_TRUE(model.undo());
  ASSERT_TRUE(job->swap_in(model));
  EXPECT_EQ(job->poll(), OperationJob::State::swapped_in);
  EXPECT_EQ(job->swap_in(model).error().code(), StatusCode::invalid_argument);

  const auto bad =
      OperationJob::create(model, CutOperation{rest, job_cut_at(Vec3d::Zero(), Vec3d::Zero())});
  ASSERT_TRUE(bad);
  bad->run();
  EXPECT_EQ(bad->poll(), OperationJob::State::failed);
  EXPECT_FALSE(bad->failure());
}

TEST(OperationJob, without_room_nothing_changes_and_it_can_wait) {
  const auto sheet = std::make_shared<const Character>(test::make_sheet(8));
  TornModel model = *TornModel::create(sheet, {20, 20, 4});
  const ModelPose rest = *rest_pose(*sheet);
  const auto before = state_of(model);
  const auto job = OperationJob::create(
      model, CutOperation{rest, job_cut_at(Vec3d(0.5, 0.5, 0), Vec3d(1, 0.1, 0))});
  ASSERT_TRUE(job);
  job->run();
  ASSERT_EQ(job->poll(), OperationJob::State::done);
  EXPECT_EQ(job->swap_in(model).error().code(), StatusCode::capacity_exceeded);
  EXPECT_EQ(difference(state_of(model), before), "");
  EXPECT_EQ(job->poll(), OperationJob::State::done);
  EXPECT_EQ(job->swap_in(model).error().code(), StatusCode::capacity_exceeded);
}

}  // namespace
}  // namespace sunder
