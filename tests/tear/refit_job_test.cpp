// Weights fitted in the background.

#include <sunder/skinning/pose.h>
#include <sunder/tear/refit_job.h>
#include <sunder/tear/torn_model.h>
#include <sunder/tear/torn_weights.h>

#include <thread>

#include <gtest/gtest.h>

#include "support/models/make_model.h"
#include "support/models/rigs.h"
#include "support/oracles/coupled.h"
#include "support/oracles/torn_invariants.h"

namespace sunder {
namespace {

using State = RefitJob::State;

WeightsOperation refit_over_clips(bool moves_bind = true) {
  WeightsOperation wanted;
  wanted.weights = {WeightPolicy::refit, 4};
  wanted.refit.moves_bind = moves_bind;
  return wanted;
}

/// A tube with a bending clip, torn twice.
struct Torn {
  explicit Torn(std::uint64_t seed)
      : random(seed),
        source(std::make_shared<const Character>(test::make_tube(24, 24, 6))),
        model(std::move(*TornModel::create(source))) {
    tear();
    tear();
  }

  void tear() {
    const ModelPose pose = test::random_pose(*source, random, 0.5);
    TearOptions options;
    options.weights = WeightOptions{WeightPolicy::refit, 4};
    ASSERT_TRUE(model.tear(pose, test::random_stroke(*source, pose, random, 0.4, 4), options));
  }

  test::Random random;
  std::shared_ptr<const Character> source;
  TornModel model;
};

std::vector<ModelPose> all_poses(const std::shared_ptr<const Character>& source,
                                 const PoseSetSpec& spec, PoseSet::Role role) {
  const auto set = PoseSet::create(source, spec);
  std::vector<ModelPose> poses(set->size(role));
  for (std::size_t i = 0; i < poses.size(); ++i) EXPECT_TRUE(set->compute(role, i, poses[i]));
  return poses;
}

TEST(RefitJob, is_never_worse_than_interpolation_over_the_poses_that_it_was_fitted_to) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed)
    for (const bool sweeps : {false, true}) {
      Torn torn(seed);
      WeightsOperation wanted = refit_over_clips(seed % 2 == 0);
      if (sweeps) wanted.refit.poses = {0, true, {}, {}};
      const auto poses = all_poses(torn.source, wanted.refit.poses, PoseSet::Role::fit);
      const auto before = measure_weight_errors(torn.model, 0, kNone, poses);
      const auto report = torn.model.reweigh(wanted);
      ASSERT_TRUE(report) << report.error().text();
      const auto after = measure_weight_errors(torn.model, 0, 2, poses);
      ASSERT_TRUE(before && after);
      ASSERT_EQ(report->points, before->points.size());
      std::uint32_t better = 0;
      for (std::size_t i = 0; i < before->points.size(); ++i) {
        // Stored positions are floats.
        ASSERT_LE(after->points[i].rms, before->points[i].rms + 1e-7);
        better += after->points[i].rms < before->points[i].rms ? 1 : 0;
      }
      EXPECT_GE(report->refitted, 1u);
      EXPECT_GE(better + 2, report->refitted);
      EXPECT_LT(after->metres.rms, before->metres.rms);
    }
}

TEST(RefitJob, in_the_background_gives_the_same_bits) {
  Torn beside(3), at_once(3);
  const auto job = RefitJob::create(beside.model, refit_over_clips());
  ASSERT_TRUE(job) << job.error().text();
  EXPECT_EQ(job->poll(), State::waiting);
  const auto digest = beside.model.digest();
  std::thread worker([job = *job] { job.run(); });
  worker.join();
  EXPECT_EQ(job->poll(), State::done);
  EXPECT_EQ(beside.model.digest(), digest) << "nothing changes before it is swapped in";
  ChangeRecord change;
  const auto report = job->swap_in(beside.model, &change);
  ASSERT_TRUE(report) << report.error().text();
  EXPECT_EQ(job->poll(), State::swapped_in);
  ASSERT_TRUE(at_once.model.reweigh(refit_over_clips()));
  EXPECT_EQ(beside.model.digest(), at_once.model.digest());
  ASSERT_EQ(change.meshes.size(), 1u);
  EXPECT_EQ(change.meshes[0].vertex_count, 0u);
  EXPECT_FALSE(change.meshes[0].dirty_vertices.empty());
  EXPECT_TRUE(change.meshes[0].dirty_triangles.empty());
  EXPECT_FALSE(job->swap_in(beside.model)) << "once is enough";
}

TEST(RefitJob, the_model_may_be_torn_on_meanwhile) {
  Torn torn(4);
  const auto job = RefitJob::create(torn.model, refit_over_clips());
  ASSERT_TRUE(job);
  std::thread worker([job = *job] { job.run(); });
  torn.tear();
  torn.tear();
  worker.join();
  ASSERT_TRUE(job->swap_in(torn.model));
  EXPECT_EQ(test::broken_laws(torn.model), std::vector<std::string>());
  EXPECT_EQ(test::broken_surface(torn.model), std::vector<std::string>());
  auto again = TornModel::create(torn.source);
  for (const Operation& operation : *torn.model.history())
    ASSERT_TRUE(apply_operation(*again, operation));
  EXPECT_EQ(again->digest(), torn.model.digest())
      << "the history says what was fitted, and when it came";
  ASSERT_TRUE(torn.model.undo());
  ASSERT_TRUE(torn.model.redo());
  EXPECT_EQ(again->digest(), torn.model.digest());
}

TEST(RefitJob, undo_of_a_fitted_operation_cancels_it) {
  Torn torn(5);
  const auto job = RefitJob::create(torn.model, refit_over_clips());
  ASSERT_TRUE(job);
  ASSERT_TRUE(torn.model.undo());
  EXPECT_EQ(job->poll(), State::cancelled);
  job->run();
  EXPECT_EQ(job->poll(), State::cancelled);
  EXPECT_FALSE(job->swap_in(torn.model));
  ASSERT_TRUE(torn.model.redo());
  EXPECT_FALSE(job->swap_in(torn.model));

  WeightsOperation of_first = refit_over_clips();
  of_first.operation_count = 1;
  const auto other = RefitJob::create(torn.model, of_first);
  ASSERT_TRUE(other);
  ASSERT_TRUE(torn.model.undo()) << "of the second operation, which it is not about";
  other->run();
  EXPECT_EQ(other->poll(), State::done);
  EXPECT_TRUE(other->swap_in(torn.model));
}

TEST(RefitJob, a_cancelled_one_changes_nothing) {
  Torn torn(8);
  const auto job = RefitJob::create(torn.model, refit_over_clips());
  ASSERT_TRUE(job);
  const auto digest = torn.model.digest();
  job->cancel();
  EXPECT_EQ(job->poll(), State::cancelled);
  job->run();
  EXPECT_EQ(job->poll(), State::cancelled);
  EXPECT_EQ(job->swap_in(torn.model).error().code(), StatusCode::invalid_argument);
  EXPECT_EQ(torn.model.digest(), digest);
}

TEST(RefitJob, of_another_model_is_refused) {
  Torn a(6), b(6);
  const auto job = RefitJob::create(a.model, refit_over_clips());
  ASSERT_TRUE(job);
  EXPECT_EQ(job->swap_in(a.model).error().code(), StatusCode::invalid_argument) << "it is not done";
  job->run();
  const auto digest = b.model.digest();
  EXPECT_EQ(job->swap_in(b.model).error().code(), StatusCode::invalid_argument);
  EXPECT_EQ(b.model.digest(), digest);
  ASSERT_TRUE(a.model.compact());
  EXPECT_FALSE(job->swap_in(a.model));
}

TEST(RefitJob, requests_that_cannot_be_fitted_are_refused) {
  Torn torn(7);
  WeightsOperation wanted = refit_over_clips();
  wanted.weights.policy = WeightPolicy::exact;
  EXPECT_EQ(RefitJob::create(torn.model, wanted).error().code(), StatusCode::invalid_argument);
  wanted = refit_over_clips();
  wanted.refit.poses.clip_samples = 0;
  EXPECT_EQ(RefitJob::create(torn.model, wanted).error().code(), StatusCode::empty_input);
  wanted = refit_over_clips();
  wanted.refit.smoothness = -1;
  EXPECT_EQ(RefitJob::create(torn.model, wanted).error().code(), StatusCode::invalid_argument);
  wanted = refit_over_clips();
  wanted.refit.is_coupled = true;
  if (!has_coupled_refit()) {
    EXPECT_EQ(torn.model.reweigh(wanted).error().code(), StatusCode::unsupported_feature);
  }
}

TEST(RefitJob, fits_neighbours_together) {
  if (!test::use_coupled_refit()) GTEST_SKIP() << "built without Ceres (SUNDER_CERES)";
  Torn coupled(8), single(8);
  WeightsOperation wanted = refit_over_clips();
  const auto poses = all_poses(single.source, wanted.refit.poses, PoseSet::Role::fit);
  const auto before = measure_weight_errors(single.model, 0, kNone, poses);
  ASSERT_TRUE(single.model.reweigh(wanted));
  wanted.refit.is_coupled = true;
  const auto report = coupled.model.reweigh(wanted);
  ASSERT_TRUE(report) << report.error().text();
  EXPECT_NE(single.model.digest(), coupled.model.digest());
  const auto of_single = measure_weight_errors(single.model, 0, 2, poses),
             of_coupled = measure_weight_errors(coupled.model, 0, 2, poses);
  ASSERT_TRUE(before && of_single && of_coupled);
  EXPECT_LT(of_coupled->metres.rms, before->metres.rms);
  EXPECT_NEAR(of_coupled->metres.rms, of_single->metres.rms, 0.05 * of_single->metres.rms);
  Torn stiff(8);
  wanted.refit.smoothness = 10;
  ASSERT_TRUE(stiff.model.reweigh(wanted));
  const auto of_stiff = measure_weight_errors(stiff.model, 0, 2, poses);
  ASSERT_TRUE(of_stiff);
  EXPECT_GT(of_stiff->metres.rms, 1.02 * of_coupled->metres.rms) << "little may change";
  EXPECT_LE(of_stiff->metres.rms, before->metres.rms);
  wanted.refit.smoothness = RefitOptions{}.smoothness;
  EXPECT_EQ(test::broken_laws(coupled.model), std::vector<std::string>());
  auto again = TornModel::create(coupled.source);
  for (const Operation& operation : *coupled.model.history())
    ASSERT_TRUE(apply_operation(*again, operation));
  EXPECT_EQ(again->digest(), coupled.model.digest());
}

}  // namespace
}  // namespace sunder
