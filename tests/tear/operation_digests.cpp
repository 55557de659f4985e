// Prints digests of torn models, one per line. tests/CMakeLists.txt builds this program twice, with
// and without Eigen's vector instructions, and compares the outputs.

#include <sunder/tear/torn_model.h>

#include <cstdio>
#include <memory>
#include <utility>
#include <vector>

#include "support/machine/random.h"
#include "support/models/rigs.h"

namespace sunder {
namespace {

using test::Random;

constexpr std::uint32_t kBones = 3;

/// Matrices with random entries near those at rest. Their computation must not depend on the build,
/// so they consist of random bits only.
ModelPose make_pose(const Character& character, Random& random) {
  ModelPose pose{{character.skeleton.bones.size(), Affine3d::Identity()},
                 character.rest_morph_weights};
  for (std::size_t bone = 0; bone < pose.model_from_bone.size(); ++bone) {
    Affine3d& matrix = pose.model_from_bone[bone];
    matrix(1, 3) = static_cast<double>(bone);
    for (int column = 0; column < 4; ++column)
      for (int row = 0; row < 3; ++row) matrix(row, column) += random.uniform(-0.1, 0.1);
  }
  for (float& weight : pose.morph_weights) weight = static_cast<float>(random.uniform(0, 1));
  return pose;
}

/// The tube stands on the origin, of radius 0.5 and height kBones, and goes up along y.
Blade make_blade(double angle, double height) {
  const Vec3d outside(2 * angle, height, 2), inside(0.1 * angle, height + 0.05, -0.125);
  return {outside, inside};
}

std::vector<Operation> make_operations(const Character& character, Random& random) {
  std::vector<Operation> operations;
  const auto stroke = [&] {
    const double angle = random.uniform(-0.2, 0.2), height = random.uniform(0.5, 2.5);
    Stroke blades;
    for (int i = 0; i < 4; ++i)
      blades.push_back(make_blade(angle + 0.125 * i, height + random.uniform(-0.1, 0.1)));
    return blades;
  };
  for (const double width : {0.0, 0.03, 0.06})
    for (const double wall_depth : {0.0, 0.02})
      for (const Layers layers : {Layers::nearest, Layers::all}) {
        ModelPose pose = make_pose(character, random);
        operations.emplace_back(
            TearOperation{std::move(pose), stroke(), {}, {width, layers, wall_depth, {}}});
      }
  for (const bool is_lined : {false, true}) {
    Bore bore;
    bore.origin = {random.uniform(-0.1, 0.1), random.uniform(0.5, 2.5), 2};
    bore.direction = {random.uniform(-0.1, 0.1), random.uniform(-0.1, 0.1), -0.75};
    bore.radius = random.uniform(0.1, 0.2);
    bore.depth = is_lined ? 4 : 2;
    bore.wall = is_lined;
    operations.emplace_back(DrillOperation{make_pose(character, random), bore});
  }
  PlaneCut cut;
  cut.point = {0, random.uniform(1, 2), 0};
  cut.normal = {random.uniform(-1, 1), 2, random.uniform(-1, 1)};
  cut.caps = true;
  operations.emplace_back(CutOperation{make_pose(character, random), cut});
  return operations;
}

void print(const char* what, std::size_t seed, const TornModel& model) {
  std::printf("%s %zu: %016llx\n", what, seed, static_cast<unsigned long long>(model.digest()));
}

/// Every operation on a model of its own, then all of them on one.
int run(std::size_t seed, const WeightOptions& weights, const char* name) {
  Random random(seed);
  const auto character = std::make_shared<const Character>(test::make_tube(14, 18, kBones));
  const std::vector<Operation> operations = make_operations(*character, random);
  auto all = TornModel::create(character);
  if (!all || !all->set_weights(weights)) return 1;
  const std::uint64_t source = all->digest();
  print("source", seed, *all);
  int torn = 0;
  for (const Operation& operation : operations) {
    auto one = TornModel::create(character);
    if (!one || !one->set_weights(weights)) return 1;
    const auto report = apply_operation(*one, operation);
    if (!report) std::fprintf(stderr, "%s\n", report.error().text().data());
    torn += report && one->digest() != source ? 1 : 0;
    print(name, seed, *one);
    (void)apply_operation(*all, operation);
    print("  of all", seed, *all);
  }
  WeightsOperation refit;
  refit.weights = {WeightPolicy::refit, 4};
  refit.refit.poses.range_of_motion = true;
  const bool is_fitted = static_cast<bool>(apply_operation(*all, refit));
  print("  refit", seed, *all);
  return torn > 10 && is_fitted ? 0 : 1;
}

}  // namespace
}  // namespace sunder

int main() {
  int failures = 0;
  for (std::size_t seed = 1; seed <= 3; ++seed) failures += sunder::run(seed, {}, "barycentric");
  failures += sunder::run(4, {sunder::WeightPolicy::pose_exact, 0}, "pose_exact");
  if (failures != 0) std::printf("%d runs did not tear or fit as they should\n", failures);
  return failures;
}
