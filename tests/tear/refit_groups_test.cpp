// A refit is worse than barycentric weights over no group of poses, on rigs it has not seen.

#include <sunder/skinning/pose.h>
#include <sunder/tear/refit_job.h>
#include <sunder/tear/torn_weights.h>

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "support/machine/stress.h"
#include "support/models/animated_rig.h"
#include "support/models/rigs.h"
#include "support/oracles/refit_gains.h"
#include "support/oracles/torn_invariants.h"

namespace sunder {
namespace {

WeightsOperation refit_over(PoseSetSpec poses) {
  WeightsOperation wanted;
  wanted.weights = {WeightPolicy::refit, 4};
  wanted.refit.poses = std::move(poses);
  return wanted;
}

/// A random rig, torn three times.
struct TornRig {
  explicit TornRig(std::uint64_t seed, const test::AnimatedRig& rig) : random(seed) {
    source = std::make_shared<const Character>(test::make_animated_rig(rig, random));
    model.emplace(std::move(*TornModel::create(source)));
    for (int i = 0; i < 3; ++i) {
      const ModelPose pose = *make_pose(*source, ClipPose{0u, random.uniform(0, 1)});
      EXPECT_TRUE(model->tear(pose, test::random_stroke(*source, pose, random, 0.3, 3)));
    }
  }

  test::Random random;
  std::shared_ptr<const Character> source;
  std::optional<TornModel> model;
};

double rms_over_clip(const TornRig& torn, std::uint32_t clip) {
  std::vector<ModelPose> poses;
  for (int i = 0; i < 40; ++i)
    poses.push_back(*make_pose(
        *torn.source,
        ClipPose{clip, (i + 0.5) / 40 * static_cast<double>(torn.source->clips[clip].duration)}));
  const auto errors = measure_weight_errors(*torn.model, 0, 3, poses);
  EXPECT_TRUE(errors);
  return errors->metres.rms;
}

TEST(RefitGroups, nothing_is_worse_in_poses_that_were_not_fitted) {
  int gained = 0, rigs = 0;
  for (int seed = 0; seed < test::stressed(12, 17); ++seed) {
    test::Random random(static_cast<std::uint64_t>(seed));
    const test::AnimatedRig rig = test::any_animated_rig(random);
    const auto character = std::make_shared<const Character>(test::make_animated_rig(rig, random));
    ASSERT_TRUE(validate_character(*character));
    const auto gains =
        test::measure_refit_gains("rig", character, static_cast<std::uint64_t>(seed));
    ASSERT_FALSE(gains.groups.empty());
    EXPECT_GE(gains.least(), 0.99) << "seed " << seed;
    gained += gains.median(test::GroupGain::Kind::clip) > 1.05 ? 1 : 0;
    ++rigs;
  }
  EXPECT_GT(2 * gained, rigs) << "and most rigs gain";
}

TEST(RefitGroups, points_that_gain_nothing_keep_their_bits) {
  // Over a rest pose that is bind, points of two bones or more are exact, so none may move.
  TornRig torn(2, {6, 4, 3, 1.5, false});
  TornRig barycentric(2, {6, 4, 3, 1.5, false});
  ASSERT_TRUE(torn.model->reweigh(refit_over({})));
  WeightsOperation wanted;
  wanted.weights = {WeightPolicy::barycentric, 4};
  ASSERT_TRUE(barycentric.model->reweigh(wanted));
  const Mesh &fitted = torn.model->character().meshes[0],
             &start = barycentric.model->character().meshes[0];
  ASSERT_EQ(fitted.vertex_count(), start.vertex_count());
  for (std::uint32_t v = 0; v < fitted.vertex_count(); ++v)
    ASSERT_EQ(fitted.positions[v], start.positions[v]) << "vertex " << v;
}

TEST(RefitGroups, moved_points_turn_no_face_over) {
  int moved = 0;
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    TornRig torn(seed, {12, 6, 4, 0.4, true});
    const std::vector<Vec3f> before = torn.model->character().meshes[0].positions;
    ASSERT_TRUE(torn.model->reweigh(refit_over({})));
    const Mesh& mesh = torn.model->character().meshes[0];
    for (const Triangle& triangle : mesh.triangles) {
      const auto normal = [&](const std::vector<Vec3f>& positions) -> Eigen::Vector3d {
        const Eigen::Vector3d a = positions[triangle[0]].cast<double>(),
                              b = positions[triangle[1]].cast<double>(),
                              c = positions[triangle[2]].cast<double>();
        return (b - a).cross(c - a);
      };
      const Eigen::Vector3d was = normal(before), is = normal(mesh.positions);
      if (was.norm() > 1e-9) {
        EXPECT_GT(was.dot(is), 0);
      }
      for (const std::uint32_t vertex : triangle)
        moved += mesh.positions[vertex] != before[vertex] ? 1 : 0;
    }
    EXPECT_EQ(test::broken_laws(*torn.model), std::vector<std::string>());
  }
  EXPECT_GT(moved, 0) << "some points moved";
}

TEST(RefitGroups, the_clip_that_counts_gains_more_than_if_another_one_counted) {
  double if_it_counts = 0, if_another_counts = 0;
  for (std::uint64_t seed = 1; seed <= 6; ++seed)
    for (const bool counts : {false, true}) {
      TornRig torn(seed, {10, 6, 3, 1.0, true});
      WeightsOperation wanted = refit_over({});
      wanted.refit.importance.of_clip = {{counts ? "clip0" : "clip1", 0}, {"clip2", 0}};
      ASSERT_TRUE(torn.model->reweigh(wanted));
      (counts ? if_it_counts : if_another_counts) += rms_over_clip(torn, 1);
    }
  EXPECT_LT(if_it_counts, 0.95 * if_another_counts);
}

TEST(RefitGroups, the_certified_deviation_grows_by_the_bound_at_most) {
  for (std::uint64_t seed = 1; seed <= 6; ++seed)
    for (const double bound : {1.0, 1.25}) {
      TornRig torn(seed, {10, 6, 3, 1.0, true});
      WeightsOperation wanted = refit_over({});
      wanted.refit.bound = bound;
      const auto report = torn.model->reweigh(wanted);
      ASSERT_TRUE(report) << report.error().text();
      EXPECT_EQ(report->uncertified, 0u);
      EXPECT_GT(report->certified_barycentric, 0);
      EXPECT_LE(report->certified, bound * report->certified_barycentric * (1 + 1e-12));
      // It holds in every pose: in random ones, too. Stored positions are floats.
      std::vector<ModelPose> poses;
      for (int i = 0; i < 20; ++i)
        poses.push_back(test::random_pose(*torn.source, torn.random, 3.1, 1.0));
      const auto errors = measure_weight_errors(*torn.model, 0, 3, poses);
      ASSERT_TRUE(errors);
      EXPECT_LE(errors->metres.maximum, report->certified + 2e-6);
    }
}

TEST(RefitGroups, options_that_cannot_be_kept_are_refused) {
  TornRig torn(1, {});
  const auto refused = [&](const auto& change, StatusCode code, const char* word) {
    WeightsOperation wanted = refit_over({});
    change(wanted.refit);
    const auto digest = torn.model->digest();
    const auto report = torn.model->reweigh(wanted);
    ASSERT_FALSE(report) << word;
    EXPECT_EQ(report.error().code(), code) << report.error().text();
    EXPECT_NE(report.error().text().find(word), std::string_view::npos) << report.error().text();
    EXPECT_EQ(torn.model->digest(), digest);
  };
  refused([](RefitOptions& refit) { refit.bound = 0.5; }, StatusCode::invalid_argument, "0.5");
  refused([](RefitOptions& refit) { refit.bound = std::nan(""); }, StatusCode::non_finite_value,
          "bound");
  refused([](RefitOptions& refit) { refit.importance.clips = -1; }, StatusCode::invalid_argument,
          "clips");
  refused([](RefitOptions& refit) { refit.importance.range_of_motion = std::nan(""); },
          StatusCode::non_finite_value, "range of motion");
  refused(
      [](RefitOptions& refit) {
        refit.importance.of_clip = {{"clip0", -2}};
      },
      StatusCode::invalid_argument, "clip0");
  refused(
      [](RefitOptions& refit) {
        refit.importance.of_clip = {{"Wlak", 2}};
      },
      StatusCode::not_found, "Wlak");
}

}  // namespace
}  // namespace sunder
