// The certificate and the searched pose beside the true maximum, on trees small enough for branch
// and bound. bench_certificate [SEEDS]; 20 by default. Prints the tables of
// docs/method/evaluation.md.

#include <sunder/certificate/certificate.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <numbers>
#include <vector>

#include "bench/certificate/longest_sum.h"
#include "support/machine/random.h"

namespace {

using namespace sunder;

constexpr double kAccuracy = 0.003;
constexpr std::uint64_t kMostCells = 400'000;
constexpr double kDegree = std::numbers::pi / 180;

/// Bones and their parents; all but the first turn.
struct Shape {
  const char* name;
  bool has_hinges;
  std::vector<std::uint32_t> parents;
};

/// Points of two kinds: the same place with other weights, or the ends of an edge.
enum class Rows { weights, edge };

struct Rig {
  Skeleton skeleton;
  ModelPose bind;
  JointLimits limits;
  std::vector<SkinTerm> terms;
};

Rig make_rig(test::Random& random, const Shape& shape, Rows rows, double angle) {
  Rig rig;
  for (std::size_t i = 0; i < shape.parents.size(); ++i) {
    Bone bone;
    if (i > 0) bone.parent = shape.parents[i];
    rig.skeleton.bones.push_back(bone);
    Affine3d place = Affine3d::Identity();
    if (i > 0) {
      const Vec3d step = random.uniform(0.2, 0.4) * random.direction();
      place.translation() = rig.bind.model_from_bone[bone.parent].translation() + step;
    }
    rig.bind.model_from_bone.push_back(place);
    JointRange range;
    range.angle = i == 0 ? 0.0 : angle;
    if (shape.has_hinges && i > 0) {
      range.turn = JointRange::Turn::hinge;
      range.axis = random.direction();
      range.lower = -angle;
      range.upper = angle;
    }
    rig.limits.of_bone.push_back(range);
  }
  const Vec3d place = random.uniform(0, 1) * random.direction();
  const Vec3d step = 0.1 * random.direction();
  const std::array<Vec3d, 2> ends = {place, rows == Rows::edge ? Vec3d(place + step) : place};
  rig.terms.resize(shape.parents.size());
  for (std::uint32_t i = 0; i < rig.terms.size(); ++i) rig.terms[i].bone = i;
  for (std::size_t end = 0; end < 2; ++end) {
    std::vector<double> weights;
    double sum = 0;
    for (std::size_t i = 0; i < rig.terms.size(); ++i) {
      weights.push_back(random.uniform(0.05, 1));
      sum += weights.back();
    }
    for (std::size_t i = 0; i < rig.terms.size(); ++i) {
      const double m = (end == 0 ? 1 : -1) * weights[i] / sum;
      rig.terms[i].m += m;
      rig.terms[i].x += m * ends[end];
    }
  }
  return rig;
}

/// The same sum as arms of joints, each seen from the centre of its joint.
std::vector<bench::SumJoint> sum_joints(const Rig& rig, const Shape& shape) {
  std::vector<bench::SumJoint> joints(rig.terms.size());
  std::vector<double> m(rig.terms.size());
  for (std::size_t i = joints.size(); i-- > 0;) {
    const Vec3d centre = rig.bind.model_from_bone[i].translation();
    bench::SumJoint& joint = joints[i];
    m[i] += rig.terms[i].m;
    joint.own += rig.terms[i].x - rig.terms[i].m * centre;
    joint.is_hinge = shape.has_hinges;
    joint.angle = shape.has_hinges ? rig.limits.of_bone[i].upper : rig.limits.of_bone[i].angle;
    joint.axis = rig.limits.of_bone[i].axis;
    if (i == 0) continue;
    joint.parent = shape.parents[i];
    const Vec3d of_parent = rig.bind.model_from_bone[joint.parent].translation();
    joints[joint.parent].own += m[i] * (centre - of_parent);
    m[joint.parent] += m[i];
  }
  return joints;
}

/// Values of one line of the table.
struct Ratios {
  std::vector<double> coarse, refined, found, gap;
  int unfinished = 0, broken = 0;
};

void add_case(const Rig& rig, const Shape& shape, Ratios& ratios) {
  const auto tree = JointTree::create(rig.skeleton, rig.bind, rig.limits);
  if (!tree) std::exit(1);
  const SkinDifferences rows{{0, static_cast<std::uint32_t>(rig.terms.size())}, rig.terms, 0.0};
  const auto coarse = certify_deviation(*tree, rows, {0, 0}),
             refined = certify_deviation(*tree, rows, {0, 1});
  const auto pose = find_worst_pose(*tree, rows, 0);
  if (!coarse || !refined || !pose) std::exit(1);
  const bench::LongestSum truth = bench::longest_sum(sum_joints(rig, shape), kAccuracy, kMostCells);
  if (truth.most > (1 + kAccuracy) * truth.least) ++ratios.unfinished;
  if (truth.least > refined->maximum * (1 + 1e-9) || pose->found > truth.most * (1 + 1e-9))
    ++ratios.broken;
  // The truth is at least what either search reached.
  const double reached = std::max(truth.least, pose->found);
  ratios.coarse.push_back(coarse->maximum / reached);
  ratios.refined.push_back(refined->maximum / reached);
  ratios.found.push_back(pose->found / reached);
  ratios.gap.push_back(truth.most / reached);
}

double quantile(std::vector<double> values, double part) {
  std::sort(values.begin(), values.end());
  return values[static_cast<std::size_t>(part * static_cast<double>(values.size() - 1) + 0.5)];
}

void print_line(const Shape& shape, Rows rows, double degrees, const Ratios& ratios) {
  std::printf("| %s, %s, %.0f° |", shape.name, rows == Rows::edge ? "edge" : "weights", degrees);
  for (const auto* values : {&ratios.coarse, &ratios.refined})
    std::printf(" %.3f, %.3f, %.3f; %.3f |", quantile(*values, 0.25), quantile(*values, 0.5),
                quantile(*values, 0.75), quantile(*values, 1));
  std::printf(" %.4f | %.4f | %d | %d |\n", quantile(ratios.found, 0), quantile(ratios.gap, 1),
              ratios.unfinished, ratios.broken);
}

}  // namespace

int main(int argc, char** argv) {
  const int seeds = argc > 1 ? std::atoi(argv[1]) : 20;
  const std::vector<Shape> shapes = {{"chain of 2 balls", false, {0, 0, 1}},
                                     {"chain of 3 balls", false, {0, 0, 1, 2}},
                                     {"fork of 3 balls", false, {0, 0, 1, 1}},
                                     {"chain of 4 hinges", true, {0, 0, 1, 2, 3}}};
  std::printf(
      "| joints, points, angle | coarse | refined | found | proved | unfinished | broken |\n"
      "|---|---|---|---|---|---|---|\n");
  int broken = 0;
  for (const Shape& shape : shapes)
    for (const Rows rows : {Rows::weights, Rows::edge})
      for (const double degrees : {20.0, 60.0, 120.0}) {
        Ratios ratios;
        for (int seed = 1; seed <= seeds; ++seed) {
          test::Random random(static_cast<std::uint64_t>(seed));
          add_case(make_rig(random, shape, rows, degrees * kDegree), shape, ratios);
        }
        print_line(shape, rows, degrees, ratios);
        std::fflush(stdout);
        broken += ratios.broken;
      }
  return broken == 0 ? 0 : 1;
}
