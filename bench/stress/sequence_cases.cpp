// Long sequences of operations on one model.

#include <sunder/skinning/pose.h>

#include "bench/stress/families.h"
#include "bench/stress/steps.h"
#include "support/models/random_operations.h"
#include "support/models/rigs.h"

namespace sunder::stress {

using test::Random;

void many_cuts(std::uint64_t seed, const Steps& steps, CaseReport& report) {
  Random random = random_of(seed, 0);
  TornSubject subject(test::make_tube(8 + random.index(8), 12, 4), report);
  subject.check_every(30);
  run_steps(subject, seed, steps, 300, [](TornSubject& of, Random& numbers, std::uint32_t) {
    const Character& source = of.model().source();
    const ModelPose pose = test::random_pose(source, numbers, 0.3);
    const auto positions = test::posed_positions(source, 0, pose);
    PlaneCut cut;
    cut.point = positions[numbers.index(static_cast<std::uint32_t>(positions.size()))];
    cut.normal = numbers.direction();
    of.operate(CutOperation{pose, cut});
  });
}

void one_region(std::uint64_t seed, const Steps& steps, CaseReport& report) {
  Random random = random_of(seed, 0);
  TornSubject subject(test::make_bumpy_ball(3485), report);
  subject.check_every(250);
  const Vec3d side = random.direction();
  run_steps(subject, seed, steps, 1000, [&](TornSubject& of, Random& numbers, std::uint32_t) {
    const Character& source = of.model().source();
    TearOperation tear;
    const ModelPose pose = test::random_pose(source, numbers, 0.3);
    tear.pose = pose;
    // Strokes are tried until one begins in the region, on one side of the ball.
    for (int tries = 0; tries < 50; ++tries) {
      tear.stroke = test::random_stroke(source, pose, numbers, 0.1, 3);
      if (tear.stroke[0].base.normalized().dot(side) > 0.9) break;
    }
    of.operate(tear);
  });
}

void welded_wounds(std::uint64_t seed, const Steps& steps, CaseReport& report) {
  Random random = random_of(seed, 0);
  TornSubject subject(test::random_character(random), report);
  run_steps(subject, seed, steps, 12, [](TornSubject& of, Random& numbers, std::uint32_t) {
    if (numbers.index(3) == 0)
      of.operate(test::random_weld(of.model(), numbers));
    else if (numbers.index(4) == 0)
      of.operate(test::random_suture(of.model(), numbers));
    else if (numbers.index(4) == 0)
      of.operate(test::random_operation(of.model(), numbers));
    else
      of.operate(test::random_lossless_operation(of.model(), numbers, true));
  });
}

}  // namespace sunder::stress
