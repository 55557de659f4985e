// Operations of every kind on one model.

#include <sunder/skinning/pose.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "bench/stress/families.h"
#include "bench/stress/steps.h"
#include "support/models/cracked_bodies.h"
#include "support/models/hard_operations.h"
#include "support/models/random_operations.h"
#include "support/models/rigs.h"

namespace sunder::stress {
namespace {

using test::Random;

void operate_hard(TornSubject& subject, const ModelPose& pose, Random& random) {
  const test::Target target = test::target_of(subject.model().character(), pose);
  if (target.faces.empty()) return;
  switch (random.index(4)) {
    case 0: return subject.operate(CutOperation{pose, test::hard_cut(target, random)});
    case 1: return subject.operate(DrillOperation{pose, test::hard_bore(target, random)});
    default: break;
  }
  TearOperation tear;
  tear.pose = pose;
  tear.stroke = test::hard_stroke(target, random);
  tear.options = test::hard_options(target, random);
  if (random.index(3) == 0) return subject.tear_in_steps(tear);
  subject.operate(tear);
}

void move(Character& character, double scale, const Vec3d& offset) {
  const auto moved = [&](const Vec3d& place) { return Vec3d(scale * place + offset); };
  for (Mesh& mesh : character.meshes) {
    for (Vec3f& position : mesh.positions) position = moved(position.cast<double>()).cast<float>();
    for (MorphTarget& target : mesh.morph_targets)
      for (Vec3f& delta : target.position_deltas) delta *= static_cast<float>(scale);
  }
}

/// A finite pose with some numbers that are not.
ModelPose damaged(ModelPose pose, Random& random) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  Affine3d& bone =
      pose.model_from_bone[random.index(static_cast<std::uint32_t>(pose.model_from_bone.size()))];
  const std::uint32_t row = random.index(3), column = random.index(4);
  bone.matrix()(row, column) =
      random.index(2) == 0 ? kInfinity : std::numeric_limits<double>::quiet_NaN();
  return pose;
}

ModelPose with_half_turns(ModelPose pose, Random& random) {
  for (Affine3d& bone : pose.model_from_bone)
    if (random.index(2) == 0)
      bone.linear() =
          bone.linear() *
          Eigen::AngleAxisd(std::numbers::pi, Vec3d::Unit(random.index(3))).toRotationMatrix();
  return pose;
}

}  // namespace

void random_operations(std::uint64_t seed, const Steps& steps, CaseReport& report) {
  Random random = random_of(seed, 0);
  TornSubject subject(test::random_character(random), report);
  run_steps(subject, seed, steps, 8, [](TornSubject& of, Random& numbers, std::uint32_t) {
    of.operate(test::random_operation(of.model(), numbers));
  });
}

void hard_operations(std::uint64_t seed, const Steps& steps, CaseReport& report) {
  Random random = random_of(seed, 0);
  TornSubject subject(test::hard_character(random), report);
  run_steps(subject, seed, steps, 5, [](TornSubject& of, Random& numbers, std::uint32_t) {
    operate_hard(of, test::hard_pose(of.model().source(), numbers), numbers);
  });
}

void cracked_bodies(std::uint64_t seed, const Steps& steps, CaseReport& report) {
  Random random = random_of(seed, 0);
  TornSubject subject(
      random.index(2) == 0 ? test::cracked_body(random) : test::coarsely_weighted_body(random),
      report);
  run_steps(subject, seed, steps, 5, [](TornSubject& of, Random& numbers, std::uint32_t) {
    if (numbers.index(2) == 0)
      operate_hard(of, test::random_pose(of.model().source(), numbers), numbers);
    else
      of.operate(test::random_operation(of.model(), numbers));
  });
}

void scaled_and_shifted(std::uint64_t seed, const Steps& steps, CaseReport& report) {
  Random random = random_of(seed, 0);
  Character character =
      random.index(2) == 0 ? test::hard_character(random) : test::random_character(random);
  const double scale = test::any_scale(random, 1e-4, 1e4);
  // Beyond a few thousand units in the last place of a float the model itself falls apart.
  const Vec3d offset =
      random.index(2) == 0 ? Vec3d::Zero() : Vec3d(scale * test::any_vector(random, 1, 100));
  move(character, scale, offset);
  TornSubject subject(std::move(character), report);
  run_steps(subject, seed, steps, 5, [](TornSubject& of, Random& numbers, std::uint32_t) {
    // Bones of the rig stay where they are; the poses turn the moved surface about them.
    operate_hard(of, *bind_pose(of.model().source()), numbers);
  });
}

void hard_poses(std::uint64_t seed, const Steps& steps, CaseReport& report) {
  Random random = random_of(seed, 0);
  TornSubject subject(test::random_character(random), report);
  subject.accept(StatusCode::non_finite_value);
  run_steps(subject, seed, steps, 6, [](TornSubject& of, Random& numbers, std::uint32_t) {
    const ModelPose pose = with_half_turns(test::hard_pose(of.model().source(), numbers), numbers);
    if (numbers.index(4) > 0) return operate_hard(of, pose, numbers);
    TearOperation tear = test::random_tear(of.model(), numbers, numbers.index(2) == 0);
    tear.pose = damaged(pose, numbers);
    const std::uint64_t refused = of.report().refused;
    of.operate(tear);
    if (of.report().refused == refused)
      of.report().violate("refusal", "a pose with numbers that are not finite was accepted");
  });
}

}  // namespace sunder::stress
