// Bounds of deviations, against points that are posed directly.

#include <sunder/certificate/certificate.h>

#include <algorithm>
#include <cmath>
#include <thread>

#include <gtest/gtest.h>

#include "support/machine/allocation_count.h"
#include "support/machine/stress.h"
#include "validation/random_rig.h"

namespace sunder {
namespace {

using test::Random;
using test::RandomRig;
using test::RandomRigKind;
using test::RandomWeights;

constexpr double kRounding = 1e-12;  // of points within a few metres, posed in double

/// A difference of two skinned points, kept as what it is made of so that it can be posed.
struct Pair {
  std::vector<RandomWeights> weights;
  std::vector<Vec3d> positions;
  std::vector<double> factors;

  void add(const RandomWeights& of, const Vec3d& position, double factor) {
    weights.push_back(of);
    positions.push_back(position);
    factors.push_back(factor);
  }
  [[nodiscard]] std::vector<SkinTerm> terms() const {
    std::vector<SkinTerm> terms;
    for (std::size_t i = 0; i < weights.size(); ++i)
      test::add_terms(weights[i], positions[i], factors[i], terms);
    return terms;
  }
  [[nodiscard]] double deviation(const RandomRig& rig, const std::vector<Affine3d>& pose) const {
    Vec3d sum = Vec3d::Zero();
    for (std::size_t i = 0; i < weights.size(); ++i)
      sum += factors[i] * test::posed_point(rig, pose, weights[i], positions[i]);
    return sum.norm();
  }
};

Vec3d random_point(Random& random) { return random.uniform(0, 1) * random.direction(); }

/// Changed weights; a point off its edge; a vertex against a point of a triangle.
Pair random_pair(Random& random, std::uint32_t bones) {
  Pair pair;
  const Vec3d p = random_point(random);
  switch (random.index(3)) {
    case 0:
      pair.add(test::random_weights(random, bones), p, 1);
      pair.add(test::random_weights(random, bones), p, -1);
      break;
    case 1: {
      const Vec3d q = random_point(random);
      const RandomWeights a = test::random_weights(random, bones),
                          b = test::random_weights(random, bones);
      const double t = random.uniform(0, 1);
      for (const auto* of : {&a, &b}) pair.add(*of, (1 - t) * p + t * q, of == &a ? 1 - t : t);
      pair.add(a, p, t - 1);
      pair.add(b, q, -t);
      break;
    }
    default:
      pair.add(test::random_weights(random, bones), p, 1);
      for (const double part : {0.2, 0.5, 0.3})
        pair.add(test::random_weights(random, bones), Vec3d(p + 0.1 * random_point(random)), -part);
  }
  return pair;
}

struct Scene {
  RandomRig rig;
  std::vector<Pair> pairs;
  SkinDifferences rows;

  Scene(Random& random, const RandomRigKind& kind, int count)
      : rig(test::make_random_rig(random, kind)) {
    for (int i = 0; i < count; ++i) {
      pairs.push_back(random_pair(random, static_cast<std::uint32_t>(rig.skeleton.bones.size())));
      test::append_row(pairs.back().terms(), rows);
    }
  }
};

DeviationCertificate certify(const RandomRig& rig, const SkinDifferences& rows,
                             const CertificateOptions& options = {}) {
  auto certificate = certify_deviation(test::make_tree(rig), rows, options);
  EXPECT_TRUE(certificate) << certificate.error().text();
  return *certificate;
}

/// The deviation of a pair in a found pose, measured by this file.
double deviation_in(const RandomRig& rig, const Pair& pair, const FoundPose& pose) {
  return pair.deviation(rig, pose.pose.model_from_bone);
}

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values.empty() ? 0.0 : values[values.size() / 2];
}

TEST(DeviationBound, no_random_pose_exceeds_it) {
  Random random(7);
  double closest = 0;
  for (int rigs = 0; rigs < test::stressed(2'000, 10); ++rigs) {
    RandomRigKind kind;
    kind.has_roots = rigs % 3 == 0;
    kind.has_slides = rigs % 2 == 0;
    kind.has_scales = rigs % 4 == 1;
    kind.most_angle = rigs % 5 == 0 ? 0.3 : 3.2;
    const Scene scene(random, kind, 10);
    const DeviationCertificate coarse = certify(scene.rig, scene.rows, {0, 0});
    const DeviationCertificate refined = certify(scene.rig, scene.rows, {0, 3});
    ASSERT_TRUE(refined.gaps.empty());
    for (int poses = 0; poses < 5; ++poses) {
      const auto pose = test::random_pose_within(random, scene.rig);
      for (std::size_t i = 0; i < scene.pairs.size(); ++i) {
        const double deviation = scene.pairs[i].deviation(scene.rig, pose);
        ASSERT_LE(deviation, refined.bound[i] + kRounding) << "rig " << rigs << ", pair " << i;
        ASSERT_LE(refined.bound[i], coarse.bound[i]);
        closest = std::max(closest, deviation / refined.bound[i]);
      }
    }
  }
  EXPECT_GT(closest, 0.98) << "random poses reach it, so that a lower bound would fail";
}

TEST(DeviationBound, no_searched_pose_exceeds_it_and_most_come_close) {
  Random random(8);
  std::vector<double> ratios, of_rigid;
  for (int rigs = 0; rigs < test::stressed(600, 10); ++rigs) {
    RandomRigKind kind;
    kind.has_roots = rigs % 5 == 0;
    kind.has_slides = kind.has_scales = kind.has_hinges = rigs % 2 == 0;
    const Scene scene(random, kind, 2);
    const JointTree tree = test::make_tree(scene.rig);
    const DeviationCertificate certificate = certify(scene.rig, scene.rows);
    for (std::uint32_t i = 0; i < scene.pairs.size(); ++i) {
      const auto pose = find_worst_pose(tree, scene.rows, i);
      ASSERT_TRUE(pose) << pose.error().text();
      const double deviation = deviation_in(scene.rig, scene.pairs[i], *pose);
      ASSERT_NEAR(deviation, pose->found, kRounding) << "the pose is what it says";
      ASSERT_LE(deviation, certificate.bound[i] + kRounding) << "rig " << rigs << ", pair " << i;
      if (certificate.bound[i] < 1e-9) continue;
      (rigs % 2 == 0 ? ratios : of_rigid).push_back(deviation / certificate.bound[i]);
    }
  }
  EXPECT_GT(median(of_rigid), 0.95);
  EXPECT_GT(median(ratios), 0.85);
  EXPECT_LT(*std::min_element(ratios.begin(), ratios.end()), 1.0);
}

/// A rig of two bones, the second at (0, 1, 0), bind frames turned, with a range for the second.
RandomRig two_bones(const JointRange& range) {
  RandomRig rig;
  rig.skeleton.bones.resize(2);
  rig.skeleton.bones[1].parent = 0;
  rig.bind.model_from_bone.assign(2, Affine3d::Identity());
  rig.bind.model_from_bone[1].linear() =
      Eigen::AngleAxisd(std::numbers::pi / 2, Vec3d(0, 0, 1)).toRotationMatrix();
  rig.bind.model_from_bone[1].translation() = Vec3d(0, 1, 0);
  rig.limits.of_bone = {JointRange{}, range};
  return rig;
}

/// A quarter of the weight at (0, 3, 1) moves from bone 0 to bone 1.
SkinDifferences quarter_moved() {
  SkinDifferences rows;
  const Vec3d p(0, 3, 1);
  test::append_row({{0, -0.25, Vec3d(-0.25 * p)}, {1, 0.25, Vec3d(0.25 * p)}}, rows);
  return rows;
}

/// The bound of one joint is attained, and has the value that geometry gives.
void expect_attained(const JointRange& range, double expected) {
  const RandomRig rig = two_bones(range);
  const SkinDifferences rows = quarter_moved();
  const auto certificate = certify(rig, rows);
  EXPECT_NEAR(certificate.maximum, expected, 1e-8 * expected);
  const auto pose = find_worst_pose(test::make_tree(rig), rows, 0);
  ASSERT_TRUE(pose);
  EXPECT_NEAR(pose->found, expected, 1e-6 * expected);
  EXPECT_LE(pose->found, certificate.maximum);
  ASSERT_EQ(pose->motions.size(), 1u);
  EXPECT_EQ(pose->motions[0].bone, 1u);
}

TEST(DeviationBound, one_joint_is_exact) {
  const double arm = std::sqrt(5.0);  // from (0, 1, 0) to (0, 3, 1)
  for (const double angle : {0.01, 0.5, 1.5, 2.5, std::numbers::pi, 4.0}) {
    JointRange ball;
    ball.angle = angle;
    expect_attained(ball, 0.25 * 2 * std::sin(std::min(angle, std::numbers::pi) / 2) * arm);
    JointRange hinge;  // the bone's y axis is -x of the model: the whole arm lies across
    hinge.turn = JointRange::Turn::hinge;
    hinge.axis = Vec3d(0, 3, 0);
    hinge.lower = -0.3 * angle;
    hinge.upper = angle;
    expect_attained(hinge, 0.25 * 2 * std::sin(std::min(angle, std::numbers::pi) / 2) * arm);
    hinge.axis = Vec3d(1, 0, 0);  // y of the model: only the part along z lies across
    expect_attained(hinge, 0.25 * 2 * std::sin(std::min(angle, std::numbers::pi) / 2) * 1.0);
  }
  JointRange slide;
  slide.angle = 0;
  slide.slide_to = Vec3d(0, 0.2, 0);
  expect_attained(slide, 0.25 * 0.2);
  slide.slide_to = Vec3d::Zero();
  slide.slide_radius = 0.3;
  expect_attained(slide, 0.25 * 0.3);
  JointRange scale;
  scale.angle = 0;
  scale.scale_upper = 1.5;
  expect_attained(scale, 0.25 * 0.5 * arm);
}

TEST(DeviationBound, equal_points_have_exactly_zero) {
  Random random(3);
  const RandomRig rig = test::make_random_rig(random, {});
  SkinDifferences rows;
  const RandomWeights weights = test::random_weights(random, 2);
  std::vector<SkinTerm> terms;
  test::add_terms(weights, Vec3d(0.1, 0.2, 0.3), 1, terms);
  test::add_terms(weights, Vec3d(0.1, 0.2, 0.3), -1, terms);
  test::append_row(terms, rows);
  const auto certificate = certify(rig, rows, {1e-3, 64});
  EXPECT_EQ(certificate.bound, std::vector<double>{0.0});
  EXPECT_EQ(certificate.maximum, 0.0);
  EXPECT_EQ(certificate.worst, kNone);
  const auto pose = find_worst_pose(test::make_tree(rig), rows, 0);
  ASSERT_TRUE(pose);
  EXPECT_EQ(pose->found, 0.0);
}

TEST(DeviationBound, what_skinning_rounds_is_added) {
  const RandomRig rig = two_bones({});
  const double without = certify(rig, quarter_moved()).maximum;
  EXPECT_DOUBLE_EQ(certify(rig, quarter_moved(), {0.5, 64}).maximum, without + 0.5);
}

TEST(DeviationBound, wider_limits_are_not_below_what_narrow_ones_reach) {
  Random random(11);
  for (int i = 0; i < 300; ++i) {
    RandomRigKind kind;
    kind.has_roots = i % 4 == 0;
    Scene scene(random, kind, 3);
    const auto narrow = certify(scene.rig, scene.rows);
    for (JointRange& range : scene.rig.limits.of_bone) {
      range.angle += random.uniform(0, 0.5);
      range.lower -= random.uniform(0, 0.5);
      range.upper += random.uniform(0, 0.5);
      range.slide_radius += random.uniform(0, 0.1);
      range.scale_lower *= random.uniform(0.8, 1);
      range.scale_upper *= random.uniform(1, 1.2);
    }
    const auto wide = certify(scene.rig, scene.rows);
    // s of each joint is searched, so that the minimum of wider limits may be found better.
    for (std::size_t k = 0; k < narrow.bound.size(); ++k)
      EXPECT_GE(wide.bound[k], 0.98 * narrow.bound[k]);
  }
}

TEST(DeviationBound, several_roots_are_children_of_a_root_that_rests) {
  Random random(12);
  for (int i = 0; i < 100; ++i) {
    RandomRigKind kind;
    kind.has_roots = true;
    Scene scene(random, kind, 3);
    const auto with_roots = certify(scene.rig, scene.rows);
    RandomRig below = scene.rig;  // the same below a bone that cannot move
    below.skeleton.bones.insert(below.skeleton.bones.begin(), Bone{});
    below.bind.model_from_bone.insert(below.bind.model_from_bone.begin(), Affine3d::Identity());
    JointRange rests;
    rests.angle = 0;
    below.limits.of_bone.insert(below.limits.of_bone.begin(), rests);
    for (std::size_t bone = 1; bone < below.skeleton.bones.size(); ++bone) {
      std::uint32_t& parent = below.skeleton.bones[bone].parent;
      parent = parent == kNone ? 0 : parent + 1;
    }
    SkinDifferences rows = scene.rows;
    for (SkinTerm& term : rows.terms) ++term.bone;
    EXPECT_EQ(certify(below, rows).bound, with_roots.bound);
  }
}

TEST(DeviationBound, a_slide_without_range_is_named_where_weight_crosses_it) {
  JointRange range;
  range.slide_radius = std::numeric_limits<double>::infinity();
  RandomRig rig = two_bones(range);
  const auto crossed = certify(rig, quarter_moved());
  ASSERT_EQ(crossed.gaps.size(), 1u);
  EXPECT_EQ(crossed.gaps[0].reason, CertificateGap::Reason::no_slide_range);
  EXPECT_EQ(crossed.gaps[0].bone, 1u);
  EXPECT_EQ(crossed.gaps[0].count, 1u);
  EXPECT_EQ(crossed.bound[0], std::numeric_limits<double>::infinity());
  EXPECT_EQ(crossed.maximum, 0.0);
  EXPECT_EQ(find_worst_pose(test::make_tree(rig), quarter_moved(), 0).error().code(),
            StatusCode::unsupported_feature);

  rig.limits.of_bone = {range, JointRange{}};  // above both bones: it carries both alike
  EXPECT_TRUE(certify(rig, quarter_moved()).gaps.empty());

  SkinDifferences bent;  // no weight crosses, but places do
  test::append_row({{0, 0.0, Vec3d(0.1, 0, 0)}, {1, 0.0, Vec3d(0, 0.1, 0)}}, bent);
  rig.limits.of_bone = {JointRange{}, range};
  const auto certificate = certify(rig, bent);
  EXPECT_TRUE(certificate.gaps.empty());
  EXPECT_NEAR(certificate.maximum, 0.2, 1e-9);
}

TEST(DeviationBound, a_scale_without_range_is_named) {
  JointRange range;
  range.scale_upper = std::numeric_limits<double>::infinity();
  RandomRig rig = two_bones(range);
  for (const std::uint32_t bone : {1u, 0u}) {
    rig.limits.of_bone = {JointRange{}, JointRange{}};
    rig.limits.of_bone[bone] = range;
    const auto certificate = certify(rig, quarter_moved());
    ASSERT_EQ(certificate.gaps.size(), 1u);
    EXPECT_EQ(certificate.gaps[0].reason, CertificateGap::Reason::no_scale_range);
    EXPECT_EQ(certificate.gaps[0].bone, bone);
  }
}

TEST(DeviationBound, unequal_sums_have_none) {
  SkinDifferences rows = quarter_moved();
  rows.terms[1].m += 1e-4;
  const auto certificate = certify(two_bones({}), rows);
  ASSERT_EQ(certificate.gaps.size(), 1u);
  EXPECT_EQ(certificate.gaps[0].reason, CertificateGap::Reason::unequal_sums);
  EXPECT_EQ(certificate.gaps[0].bone, kNone);
  rows = quarter_moved();
  rows.terms[1].m += 1e-7;  // rounding of floats
  EXPECT_NEAR(certify(two_bones({}), rows).sum_residual, 1e-7, 1e-12);
}

/// A bone that stretches, and two that slide without a range as its children.
RandomRig two_free_bones() {
  RandomRig rig = two_bones({});
  rig.skeleton.bones.push_back(rig.skeleton.bones[1]);
  rig.bind.model_from_bone.push_back(Affine3d::Identity());
  JointRange range;
  range.angle = 0.4;
  range.slide_radius = std::numeric_limits<double>::infinity();
  rig.limits.of_bone = {JointRange{}, range, range};
  rig.limits.of_bone[0].scale_upper = 1.5;
  return rig;
}

TEST(DeviationBound, holds_with_its_residuals_however_far_bones_slide) {
  const RandomRig rig = two_free_bones();
  const Vec3d p(0.1, 0.2, 0.3);
  const double least = 2e-6;  // less than what counts as a different sum
  SkinDifferences rows;
  test::append_row({{0, 0.0, Vec3d(1e-3, 0, 0)}, {1, 0.0, Vec3d(-1e-3, 0, 0)}}, rows);
  test::append_row({{0, -least, Vec3d(-least * p)},
                    {1, 2 * least, Vec3d(2 * least * p)},
                    {2, -least, Vec3d(-least * p)}},
                   rows);
  const auto certificate = certify(rig, rows);
  EXPECT_TRUE(certificate.gaps.empty());
  ASSERT_EQ(certificate.slide_residuals.size(), 2u);
  double moved = certificate.bound[1];
  const double slide = 1e3;
  for (std::uint32_t i = 0; i < 2; ++i) {
    const SlideResidual& residual = certificate.slide_residuals[i];
    EXPECT_EQ(residual.bone, i + 1);
    EXPECT_EQ(residual.point, 1u);
    EXPECT_NEAR(residual.weight, 1.5 * (2 - i) * least, 1e-15);
    moved += slide * residual.weight;
  }
  std::vector<Affine3d> pose = rig.bind.model_from_bone;  // apart, and stretched
  for (int bone = 0; bone < 3; ++bone) {
    pose[bone].matrix() *= 1.5;
    if (bone > 0) pose[bone].translation().x() += bone == 1 ? 1.5 * slide : -1.5 * slide;
  }
  double deviation = 0;
  for (const auto& [bone, factor] : {std::pair(0, -1.0), std::pair(1, 2.0), std::pair(2, -1.0)}) {
    const Affine3d matrix = pose[bone] * rig.bind.model_from_bone[bone].inverse();
    deviation += factor * least * (matrix * p).x();
  }
  EXPECT_GT(std::abs(deviation), 5e-3) << "far above the bound alone";
  EXPECT_LE(std::abs(deviation), moved);
  EXPECT_GE(std::abs(deviation), 0.99 * (moved - certificate.bound[1]));
}

/// The largest |rest + arm|, the arm turned by at most an angle.
double longest_sum(const Vec3d& rest, const Vec3d& arm, double angle) {
  const double between = std::acos(std::clamp(rest.normalized().dot(arm.normalized()), -1.0, 1.0));
  const double left = std::max(0.0, between - angle), g = rest.norm(), y = arm.norm();
  return std::sqrt(g * g + y * y + 2 * g * y * std::cos(left));
}

TEST(DeviationBound, is_attained_where_one_ball_joint_is_crossed) {
  Random random(21);
  for (int i = 0; i < test::stressed(2'000, 10); ++i) {
    JointRange ball;
    ball.angle = random.uniform(0.05, 3.1);
    const RandomRig rig = two_bones(ball);
    const double m = random.uniform(-1, 1);
    const Vec3d x0 = random_point(random), x1 = random_point(random);
    SkinDifferences rows;
    test::append_row({{0, -m, x0}, {1, m, x1}}, rows);
    const Vec3d centre(0, 1, 0);
    const double expected = longest_sum(Vec3d(x0 + m * centre), Vec3d(x1 - m * centre), ball.angle);
    for (const std::uint32_t refined : {0u, 1u})
      EXPECT_NEAR(certify(rig, rows, {0, refined}).maximum, expected, 1e-8 * expected)
          << i << ", angle " << ball.angle;
  }
}

TEST(WorstPose, is_not_below_random_poses_where_bones_stretch) {
  Random random(23);
  std::vector<double> ratios;
  for (int rigs = 0; rigs < test::stressed(150, 10); ++rigs) {
    RandomRigKind kind;
    kind.most_bones = 4;
    kind.has_hinges = rigs % 2 == 0;
    kind.most_angle = rigs % 3 == 0 ? 3.2 : 0.6;
    Scene scene(random, kind, 2);
    for (JointRange& range : scene.rig.limits.of_bone) {
      range.scale_lower = random.uniform(0.5, 1);
      range.scale_upper = random.uniform(1, 1.6);
    }
    const JointTree tree = test::make_tree(scene.rig);
    const DeviationCertificate certificate = certify(scene.rig, scene.rows);
    for (std::uint32_t i = 0; i < scene.pairs.size(); ++i) {
      const auto pose = find_worst_pose(tree, scene.rows, i);
      ASSERT_TRUE(pose);
      ASSERT_NEAR(deviation_in(scene.rig, scene.pairs[i], *pose), pose->found, kRounding);
      ASSERT_LE(pose->found, certificate.bound[i] + kRounding);
      if (certificate.bound[i] > 1e-9) ratios.push_back(pose->found / certificate.bound[i]);
      for (int k = 0; k < 200; ++k)
        ASSERT_LE(scene.pairs[i].deviation(scene.rig, test::random_pose_within(random, scene.rig)),
                  pose->found + kRounding)
            << "rig " << rigs << ", pair " << i;
    }
  }
  EXPECT_GT(median(ratios), 0.97);
}

TEST(DeviationBound, of_edges_is_close_at_small_angles) {
  Random random(22);
  std::vector<double> ratios;
  for (int rigs = 0; rigs < test::stressed(300, 10); ++rigs) {
    RandomRigKind kind;
    kind.most_bones = 5;
    kind.most_angle = 0.35;
    kind.has_slides = kind.has_scales = kind.has_hinges = false;
    const RandomRig rig = test::make_random_rig(random, kind);
    const auto bones = static_cast<std::uint32_t>(rig.skeleton.bones.size());
    const Vec3d p = random_point(random), q = p + 0.1 * random.direction();
    const RandomWeights common = test::random_weights(random, bones);
    std::vector<SkinTerm> terms;  // ends of an edge move nearly alike
    for (const auto& [end, sign] : {std::pair(p, 1.0), std::pair(q, -1.0)}) {
      test::add_terms(common, end, 0.97 * sign, terms);
      test::add_terms(test::random_weights(random, bones), end, 0.03 * sign, terms);
    }
    SkinDifferences rows;
    test::append_row(terms, rows);
    const double bound = certify(rig, rows, {0, 0}).maximum;  // as of all points but the worst
    const auto pose = find_worst_pose(test::make_tree(rig), rows, 0);
    ASSERT_TRUE(pose);
    EXPECT_LE(pose->found, bound + kRounding);
    ratios.push_back(bound / pose->found);
  }
  EXPECT_LT(median(ratios), 1.05);
}

TEST(DeviationBound, has_the_same_bits_at_any_number_of_threads) {
  Random random(13);
  RandomRigKind kind;
  kind.most_bones = 30;
  const Scene scene(random, kind, 5'000);
  const JointTree tree = test::make_tree(scene.rig);
  ParallelFor parallel;
  parallel.threads = 3;
  parallel.run = [](void*, std::uint32_t count, ParallelFor::Task task, const void* work) {
    std::vector<std::thread> threads;
    for (std::uint32_t i = count; i-- > 0;) threads.emplace_back([=] { task(work, i); });
    for (std::thread& thread : threads) thread.join();
  };
  const auto alone = certify_deviation(tree, scene.rows),
             spread = certify_deviation(tree, scene.rows, {}, parallel);
  ASSERT_TRUE(alone);
  ASSERT_TRUE(spread);
  EXPECT_EQ(alone->bound, spread->bound);
  const auto worst = worst_points(*alone, 20);
  ASSERT_EQ(worst.size(), 20u);
  EXPECT_EQ(worst[0], alone->worst);
  EXPECT_TRUE(std::is_sorted(worst.begin(), worst.end(), [&](std::uint32_t a, std::uint32_t b) {
    return alone->bound[a] > alone->bound[b];
  }));
}

/// No exception leaves the API.
TEST(DeviationBound, worst_points_are_none_without_memory) {
  if (!test::FailingAllocations::are_possible()) GTEST_SKIP();
  DeviationCertificate certificate;
  certificate.bound = {0.5, 0.25, 1.0};
  std::vector<std::uint32_t> worst;
  EXPECT_NO_THROW({
    const test::FailingAllocations failing(0);
    worst = worst_points(certificate, 2);
  });
  EXPECT_TRUE(worst.empty());
  EXPECT_EQ(worst_points(certificate, 2), (std::vector<std::uint32_t>{2, 0}));
}

TEST(DeviationBound, faults_of_the_input_are_named) {
  RandomRig rig = two_bones({});
  const JointTree tree = test::make_tree(rig);
  SkinDifferences rows = quarter_moved();
  rows.terms[1].bone = 2;
  EXPECT_EQ(certify_deviation(tree, rows).error().code(), StatusCode::index_out_of_range);
  rows = quarter_moved();
  rows.terms[0].m = std::nan("");
  EXPECT_EQ(certify_deviation(tree, rows).error().code(), StatusCode::non_finite_value);
  rows = quarter_moved();
  rows.first.push_back(7);
  EXPECT_EQ(certify_deviation(tree, rows).error().code(), StatusCode::size_mismatch);
  EXPECT_EQ(certify_deviation(tree, quarter_moved(), {-1, 0}).error().code(),
            StatusCode::invalid_argument);
  EXPECT_EQ(find_worst_pose(tree, quarter_moved(), 1).error().code(),
            StatusCode::index_out_of_range);
  const auto code_of = [&](const JointRange& range) {
    rig.limits.of_bone[1] = range;
    return JointTree::create(rig.skeleton, rig.bind, rig.limits).error().code();
  };
  JointRange range;
  range.angle = -1;
  EXPECT_EQ(code_of(range), StatusCode::invalid_argument);
  range = {};
  range.turn = JointRange::Turn::hinge;
  range.axis = Vec3d::Zero();
  EXPECT_EQ(code_of(range), StatusCode::invalid_argument);
  range.axis = Vec3d::UnitX();
  range.lower = 4;
  EXPECT_EQ(code_of(range), StatusCode::invalid_argument);
  range = {};
  range.scale_lower = 2;
  EXPECT_EQ(code_of(range), StatusCode::invalid_argument);
  range = {};
  range.slide_radius = std::nan("");
  EXPECT_EQ(code_of(range), StatusCode::non_finite_value);
  rig.limits.of_bone.pop_back();
  EXPECT_EQ(JointTree::create(rig.skeleton, rig.bind, rig.limits).error().code(),
            StatusCode::size_mismatch);
}

}  // namespace
}  // namespace sunder
