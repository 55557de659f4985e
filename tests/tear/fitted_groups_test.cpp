// A refit loses over no group of poses that it was fitted to: neither an operation's points over
// the rest pose, nor over a clip, the range of motion, random poses or the poses of the operation.

#include "support/oracles/fitted_groups.h"

#include <sunder/skinning/pose.h>

#include <algorithm>
#include <cstdio>
#include <memory>

#include <gtest/gtest.h>

#include "support/machine/stress.h"
#include "support/models/animated_rig.h"
#include "support/models/rigs.h"
#include "support/oracles/coupled.h"

namespace sunder {
namespace {

constexpr int kTears = 3;
/// Errors below this share of the diagonal are rounding: positions are stored in float.
constexpr double kNothing = 2e-7;

struct Outcome {
  std::size_t groups = 0, lost = 0;
  double least = 1e300;
};

/// Tears a random rig three times, fits, and counts the groups that lose.
Outcome refit_rig(std::uint64_t seed, const RefitOptions& options, std::uint32_t influences) {
  test::Random random(seed);
  const test::AnimatedRig rig = test::any_animated_rig(random);
  const auto source = std::make_shared<const Character>(test::make_animated_rig(rig, random));
  TornModel model = std::move(*TornModel::create(source));
  for (int i = 0; i < kTears; ++i) {
    const auto clips = static_cast<std::uint32_t>(source->clips.size());
    const std::uint32_t clip = random.index(clips);
    const double time = random.uniform(0, 1) * static_cast<double>(source->clips[clip].duration);
    const ModelPose pose = *make_pose(*source, ClipPose{clip, time});
    EXPECT_TRUE(model.tear(pose, test::random_stroke(*source, pose, random)));
  }
  WeightsOperation wanted;
  wanted.weights = {WeightPolicy::refit, influences};
  wanted.refit = options;
  const double nothing = kNothing * test::posed_diagonal(*source, *rest_pose(*source));
  const auto groups = test::refit_and_measure(model, wanted);
  Outcome result{groups.size(), test::count_lost(groups, nothing)};
  for (const test::FittedGroup& group : groups) {
    const double gain = group.gain(nothing);
    if (gain < result.least) result.least = gain;
    if (gain < 1 - 1e-9)
      ADD_FAILURE() << "seed " << seed << ", bound " << options.bound << ", operation "
                    << group.operation << ", group " << group.group << ": gain " << gain << ", "
                    << 1e3 * group.barycentric << " mm to " << 1e3 * group.fitted << " mm";
  }
  return result;
}

/// Over clips and range of motion, as the command fits.
RefitOptions with_bound(double bound) {
  RefitOptions options;
  options.poses.range_of_motion = true;
  options.bound = bound;
  return options;
}

TEST(FittedGroups, rigs_that_came_close_to_a_loss_lose_nothing) {
  for (const std::uint64_t seed : {118u, 162u, 184u, 230u, 246u, 248u, 1017u, 1108u})
    for (const double bound : {0.0, 1.0, 1.25}) refit_rig(seed, with_bound(bound), 4);
  for (const std::uint64_t seed : {230u, 1017u, 1108u}) {
    RefitOptions clips_alone;
    refit_rig(seed, clips_alone, 0);
  }
}

TEST(FittedGroups, no_random_rig_loses) {
  Outcome all;
  const int rigs = test::stressed(40, 250);
  for (int seed = 0; seed < rigs; ++seed) {
    constexpr double kBounds[] = {1.25, 0.0, 1.0};
    const Outcome of =
        refit_rig(static_cast<std::uint64_t>(seed), with_bound(kBounds[seed % 3]), 4);
    all.groups += of.groups;
    all.lost += of.lost;
    all.least = std::min(all.least, of.least);
    if (seed % 250 == 249 || seed + 1 == rigs) {
      std::printf("%d rigs: %zu groups, of which %zu lost; least gain %.12f\n", seed + 1,
                  all.groups, all.lost, all.least);
      std::fflush(stdout);
    }
  }
  EXPECT_GT(all.groups, 100u);
}

TEST(FittedGroups, points_fitted_together_lose_nothing_either) {
  if (!test::use_coupled_refit()) GTEST_SKIP() << "coupled refits were not built";
  for (int seed = 0; seed < test::stressed(6, 10); ++seed)
    for (const double bound : {1.0, 1.25}) {
      RefitOptions options = with_bound(bound);
      options.is_coupled = true;
      refit_rig(static_cast<std::uint64_t>(seed), options, 4);
    }
}

}  // namespace
}  // namespace sunder
