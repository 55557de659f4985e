// Weights fitted over poses that determine little or nothing.

#include <sunder/skinning/pose.h>

#include <array>

#include "bench/stress/families.h"
#include "bench/stress/steps.h"
#include "support/models/hard_operations.h"
#include "support/models/random_operations.h"
#include "support/models/rigs.h"

namespace sunder::stress {
namespace {

using test::Random;

/// Poses that are all the same, all collapsed, or contradict one another.
WeightsOperation singular_fit(const Character& source, Random& random) {
  WeightsOperation wanted;
  // Not pose_exact, which may turn small faces over in bind space to meet such poses.
  constexpr std::array kPolicies = {WeightPolicy::barycentric, WeightPolicy::refit,
                                    WeightPolicy::exact};
  wanted.weights.policy = kPolicies[random.index(3)];
  wanted.weights.maximum_influences = random.index(5);
  const ModelPose pose = test::hard_pose(source, random);
  wanted.pose = pose;
  wanted.refit.poses.clip_samples = random.index(2) * 4;
  wanted.refit.poses.range_of_motion = random.index(2) == 0;
  wanted.refit.moves_bind = random.index(2) == 0;
  for (std::uint32_t n = random.index(6); n > 0; --n)
    wanted.refit.poses.poses.emplace_back(random.index(2) == 0 ? pose
                                                               : test::hard_pose(source, random));
  return wanted;
}

}  // namespace

void singular_refits(std::uint64_t seed, const Steps& steps, CaseReport& report) {
  Random random = random_of(seed, 0);
  TornSubject subject(test::random_character(random), report);
  subject.accept(StatusCode::empty_input);  // no pose to fit over
  run_steps(subject, seed, steps, 3, [](TornSubject& of, Random& numbers, std::uint32_t) {
    of.operate(test::random_operation(of.model(), numbers));
    of.reweigh(singular_fit(of.model().source(), numbers));
  });
}

}  // namespace sunder::stress
