// Contract of PosePuller: include/sunder/animation/pull.h.

#include <sunder/animation/edit_pose.h>
#include <sunder/animation/pull.h>
#include <sunder/skinning/pose.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <gtest/gtest.h>

#include "support/machine/allocation_count.h"
#include "support/machine/random.h"
#include "support/machine/stress.h"
#include "support/models/rigs.h"

namespace sunder::test {
namespace {

constexpr double kPi = std::numbers::pi;

Quatd about(const Vec3d& axis, double angle) {
  return Quatd(Eigen::AngleAxisd(angle, Eigen::Vector3d(axis.normalized())));
}

Quatf random_rotation(Random& random, double angle) {
  return Quatf(about(random.direction(), random.uniform(-angle, angle)).cast<float>());
}

/// A chain of bones, each at the end of the one before.
struct Chain {
  Skeleton skeleton;
  std::vector<std::uint32_t> bones;
  Pose pose;
  double reach = 0;

  void add(const Vec3d& offset, const Vec3f& scale = Vec3f::Ones(),
           const Quatf& rotation = Quatf::Identity()) {
    Bone bone;
    bone.name = "bone " + std::to_string(bones.size());
    bone.parent = bones.empty() ? kNone : bones.back();
    bone.rest.translation = offset.cast<float>();
    bone.rest.scale = scale;
    bone.rest.rotation = rotation;
    bones.push_back(static_cast<std::uint32_t>(skeleton.bones.size()));
    skeleton.bones.push_back(bone);
    pose.parent_from_bone.push_back(bone.rest);
  }
  [[nodiscard]] Vec3d point(const Pose& in, const PullHandle& handle) const {
    ModelPose model;
    EXPECT_TRUE(compute_model_pose(skeleton, in, model));
    Vec3d sum = Vec3d::Zero();
    for (const PullHandle::Part& part : handle.parts)
      sum += part.weight * (model.model_from_bone[part.bone] * Eigen::Vector3d(part.point));
    return sum;
  }
};

/// Bones of random lengths; `wild` ones are also of no length, mirrored and scaled.
Chain random_chain(Random& random, std::uint32_t count, bool wild) {
  Chain chain;
  for (std::uint32_t i = 0; i < count; ++i) {
    const double length = i == 0 || (wild && random.index(5) == 0) ? 0.0 : random.uniform(0.1, 1.0);
    Vec3f scale = Vec3f::Ones();
    if (wild && random.index(3) == 0)
      scale = Vec3f(static_cast<float>(random.uniform(0.5, 2.0)),
                    static_cast<float>(random.uniform(0.5, 2.0)),
                    static_cast<float>(random.uniform(0.5, 2.0)));
    if (wild && random.index(3) == 0) scale.x() = -scale.x();
    const Vec3d direction = random.direction();
    chain.add(length * direction, scale, random_rotation(random, 1.0));
    chain.reach += length;
  }
  return chain;
}

/// A limit on each second bone or so, with rest inside of it.
std::vector<BoneLimit> random_limits(Random& random, const Chain& chain) {
  std::vector<BoneLimit> limits;
  for (const std::uint32_t bone : chain.bones) {
    if (random.index(3) == 0) continue;
    BoneLimit limit;
    limit.bone = bone;
    limit.axis = random.uniform(0.1, 3.0) * random.direction();
    limit.lower = -random.uniform(0.2, 1.5);
    limit.upper = random.uniform(0.2, 1.5);
    limit.cone = random.uniform(0.2, 1.2);
    limit.kind = random.index(2) == 0 ? BoneLimit::Kind::hinge : BoneLimit::Kind::cone;
    limits.push_back(limit);
  }
  return limits;
}

/// A rotation within the limits of a bone, or any near rest.
Quatf random_valid(Random& random, const Quatf& rest, const BoneLimit* limit) {
  Quatd turn = about(random.direction(), random.uniform(-1.2, 1.2));
  if (limit != nullptr) {
    const Vec3d axis = limit->axis.normalized();
    turn = about(axis, random.uniform(limit->lower, limit->upper));
    if (limit->kind == BoneLimit::Kind::cone) {
      const Vec3d side = axis.cross(random.direction()).normalized();
      turn = about(side, random.uniform(0.0, limit->cone)) * turn;
    }
  }
  return Quatf((rest.cast<double>() * turn).normalized().cast<float>());
}

/// How far a rotation is outside of its limit, radians. By another way than the solver: the axis
/// that leaves its cone, and the turn that is left after the shortest turn that brings it back.
double violation(const BoneLimit& limit, const Quatf& rest, const Quatf& rotation) {
  const Quatd relative = (rest.cast<double>().conjugate() * rotation.cast<double>()).normalized();
  const Vec3d axis = limit.axis.normalized();
  const Eigen::Vector3d turned = relative * Eigen::Vector3d(axis);
  const double swing = std::atan2(axis.cross(Vec3d(turned)).norm(), axis.dot(Vec3d(turned)));
  const Quatd back = Quatd(Quatd::FromTwoVectors(turned, Eigen::Vector3d(axis)));
  const Quatd left = back * relative;
  double twist = 2 * std::atan2(left.vec().dot(axis), left.w());
  if (twist > kPi) twist -= 2 * kPi;
  if (twist < -kPi) twist += 2 * kPi;
  const double outside = std::max({0.0, limit.lower - twist, twist - limit.upper});
  const double cone = limit.kind == BoneLimit::Kind::hinge ? 0.0 : limit.cone;
  return std::max(outside, swing - cone);
}

double worst_violation(const Chain& chain, const std::vector<BoneLimit>& limits, const Pose& pose) {
  double worst = 0;
  for (const BoneLimit& limit : limits)
    worst = std::max(worst, violation(limit, chain.skeleton.bones[limit.bone].rest.rotation,
                                      pose.parent_from_bone[limit.bone].rotation));
  return worst;
}

TEST(Pull, reaches_what_a_free_chain_can_reach) {
  for (std::uint64_t seed = 0; seed < static_cast<std::uint64_t>(stressed(300, 10)); ++seed) {
    Random random(seed);
    const bool wild = seed % 2 == 1;
    Chain chain = random_chain(random, 3 + random.index(8), wild);
    const PullHandle handle =
        handle_on_bone(chain.bones.back(), random.uniform(0.1, 0.5) * random.direction());
    // Another pose of the chain gives a place that can be reached.
    Pose other = chain.pose;
    for (BoneTransform& bone : other.parent_from_bone) bone.rotation = random_rotation(random, 1.5);
    const Vec3d place = chain.point(other, handle);
    PullOptions options;
    options.iterations = 100;
    options.attempts = 12;
    const auto report = pull_point(chain.skeleton, chain.bones, handle, place, chain.pose, options);
    ASSERT_TRUE(report) << report.error().text();
    EXPECT_TRUE(report->is_reached) << "seed " << seed << ": " << report->error;
    EXPECT_NEAR((chain.point(chain.pose, handle) - place).norm(), report->error, 1e-5) << seed;
  }
}

TEST(Pull, keeps_limits_and_never_grows_the_error) {
  std::uint32_t reached = 0, count = 0;
  for (std::uint64_t seed = 0; seed < static_cast<std::uint64_t>(stressed(400, 10)); ++seed) {
    Random random(1000 + seed);
    Chain chain = random_chain(random, 2 + random.index(8), seed % 2 == 1);
    const auto limits = random_limits(random, chain);
    const auto limit_of = [&](std::uint32_t bone) -> const BoneLimit* {
      for (const BoneLimit& limit : limits)
        if (limit.bone == bone) return &limit;
      return nullptr;
    };
    const PullHandle handle = handle_on_bone(chain.bones.back(), 0.3 * random.direction());
    Pose other = chain.pose;
    for (const std::uint32_t bone : chain.bones)
      other.parent_from_bone[bone].rotation =
          random_valid(random, chain.skeleton.bones[bone].rest.rotation, limit_of(bone));
    ASSERT_LT(worst_violation(chain, limits, other), 2e-6) << seed;
    auto puller = PosePuller::create(chain.skeleton, chain.bones, limits);
    ASSERT_TRUE(puller) << puller.error().text();
    const PullTarget target = {&handle, chain.point(other, handle), 1.0};
    PullOptions options;
    options.iterations = 100;
    options.attempts = 12;
    const auto report = puller->pull({&target, 1}, chain.pose, options);
    ASSERT_TRUE(report) << report.error().text();
    EXPECT_LE(report->error, report->error_before);
    EXPECT_LT(worst_violation(chain, limits, chain.pose), 2e-6) << seed;
    reached += report->is_reached ? 1 : 0;
    ++count;
  }
  RecordProperty("reached", static_cast<int>(reached));
  EXPECT_GE(reached, 97 * count / 100) << reached << " of " << count;
}

TEST(Pull, puts_bones_that_are_outside_back_within_their_limits) {
  for (std::uint64_t seed = 0; seed < static_cast<std::uint64_t>(stressed(100, 10)); ++seed) {
    Random random(seed);
    Chain chain = random_chain(random, 5, false);
    const auto limits = random_limits(random, chain);
    for (BoneTransform& bone : chain.pose.parent_from_bone)
      bone.rotation = random_rotation(random, 3.0);
    auto puller = PosePuller::create(chain.skeleton, chain.bones, limits);
    ASSERT_TRUE(puller);
    const PullHandle handle = handle_on_bone(chain.bones.back(), 0.3 * random.direction());
    const PullTarget target = {&handle, 2.0 * random.direction(), 1.0};
    ASSERT_TRUE(puller->pull({&target, 1}, chain.pose));
    EXPECT_LT(worst_violation(chain, limits, chain.pose), 2e-6) << seed;
  }
}

Chain straight_chain(std::uint32_t count) {
  Chain chain;
  for (std::uint32_t i = 0; i < count; ++i) chain.add(Vec3d(0, i == 0 ? 0.0 : 1.0, 0));
  return chain;
}

TEST(Pull, stretches_towards_what_is_out_of_reach_and_stays_there) {
  for (const std::uint32_t count : {1u, 2u, 3u, 6u}) {
    Random random(count);
    Chain chain = straight_chain(count);
    const PullHandle handle = handle_on_bone(chain.bones.back(), Vec3d(0, 1, 0));
    for (int direction = 0; direction < 20; ++direction) {
      const Vec3d place =
          (static_cast<double>(count) + random.uniform(0.2, 50.0)) * random.direction();
      auto puller = PosePuller::create(chain.skeleton, chain.bones);
      ASSERT_TRUE(puller);
      const PullTarget target = {&handle, place, 1.0};
      double before = 0;
      for (int frame = 0; frame < 60; ++frame) {
        const auto report = puller->pull({&target, 1}, chain.pose);
        ASSERT_TRUE(report);
        if (frame > 0) {
          EXPECT_LE(report->error, before + 1e-6);
        }
        before = report->error;
      }
      EXPECT_NEAR(before, place.norm() - static_cast<double>(count), 1e-3 * count);
      // It stands still.
      const Pose pose = chain.pose;
      ASSERT_TRUE(puller->pull({&target, 1}, chain.pose));
      for (std::size_t bone = 0; bone < pose.parent_from_bone.size(); ++bone)
        EXPECT_LT(pose.parent_from_bone[bone].rotation.angularDistance(
                      chain.pose.parent_from_bone[bone].rotation),
                  2e-2f);
    }
  }
}

TEST(Pull, bends_a_straight_chain) {
  for (const std::uint32_t count : {2u, 3u, 7u})
    for (const double height : {0.9, 0.5, 0.2, -0.5}) {
      Chain chain = straight_chain(count);
      const PullHandle handle = handle_on_bone(chain.bones.back(), Vec3d(0, 1, 0));
      const Vec3d place(0, height * count, 0);
      const auto report = pull_point(chain.skeleton, chain.bones, handle, place, chain.pose);
      ASSERT_TRUE(report);
      EXPECT_TRUE(report->is_reached) << count << " bones, " << height << ": " << report->error;
    }
  // Hinges as of fingers, at the limit at which they are straight.
  Chain chain = straight_chain(3);
  std::vector<BoneLimit> limits;
  for (const std::uint32_t bone : chain.bones)
    limits.push_back({BoneLimit::Kind::hinge, bone, Vec3d(2, 0, 0), 0.0, 1.7, 0.0});
  auto puller = PosePuller::create(chain.skeleton, chain.bones, limits);
  ASSERT_TRUE(puller);
  const PullHandle handle = handle_on_bone(chain.bones.back(), Vec3d(0, 1, 0));
  Pose other = chain.pose;
  for (BoneTransform& bone : other.parent_from_bone)
    bone.rotation = Quatf(about(Vec3d(1, 0, 0), 1.0).cast<float>());
  const PullTarget target = {&handle, chain.point(other, handle), 1.0};
  const auto report = puller->pull({&target, 1}, chain.pose);
  ASSERT_TRUE(report);
  EXPECT_TRUE(report->is_reached) << report->error;
}

TEST(Pull, one_bone_points_at_its_target) {
  for (const double angle : {0.1, 1.5, 3.0, kPi}) {
    Chain chain = straight_chain(1);
    const PullHandle handle = handle_on_bone(0, Vec3d(0, 1, 0));
    const Vec3d place(std::sin(angle), std::cos(angle), 0);
    const auto report = pull_point(chain.skeleton, chain.bones, handle, place, chain.pose);
    ASSERT_TRUE(report);
    EXPECT_TRUE(report->is_reached) << angle << ": " << report->error;
  }
}

TEST(Pull, leaves_everything_but_the_rotations_of_its_bones) {
  Random random(5);
  Chain chain = random_chain(random, 6, true);
  const std::vector<std::uint32_t> bones = {3, 4};
  const Pose before = chain.pose;
  const PullHandle handle = handle_on_bone(5, Vec3d(0, 0.5, 0));
  ASSERT_TRUE(pull_point(chain.skeleton, bones, handle, Vec3d(0.3, 0.4, 0.5), chain.pose));
  for (std::size_t bone = 0; bone < 6; ++bone) {
    const BoneTransform &was = before.parent_from_bone[bone],
                        &is = chain.pose.parent_from_bone[bone];
    EXPECT_EQ(was.translation, is.translation);
    EXPECT_EQ(was.scale, is.scale);
    EXPECT_EQ(was.rotation.coeffs() == is.rotation.coeffs(), bone != 3 && bone != 4) << bone;
  }
}

TEST(Pull, a_point_that_is_where_it_should_be_changes_no_bit) {
  Random random(6);
  Chain chain = random_chain(random, 6, false);
  const Pose before = chain.pose;
  const PullHandle handle = handle_on_bone(5, Vec3d(0, 0.5, 0));
  const Vec3d place = chain.point(chain.pose, handle);
  const auto report = pull_point(chain.skeleton, chain.bones, handle, place, chain.pose);
  ASSERT_TRUE(report);
  EXPECT_EQ(report->iterations, 0u);
  EXPECT_EQ(before.parent_from_bone, chain.pose.parent_from_bone);
}

TEST(Pull, stiff_bones_turn_less) {
  const auto turn_of_first = [](float stiffness) {
    Chain chain = straight_chain(4);
    for (BoneTransform& bone : chain.pose.parent_from_bone)
      bone.rotation = Quatf(about(Vec3d(0, 0, 1), 0.3).cast<float>());
    const Pose before = chain.pose;
    const std::vector<float> each = {stiffness, 0, 0, 0};
    auto puller = PosePuller::create(chain.skeleton, chain.bones, {}, each);
    EXPECT_TRUE(puller);
    const PullHandle handle = handle_on_bone(3, Vec3d(0, 1, 0));
    const PullTarget target = {&handle, chain.point(chain.pose, handle) + Vec3d(0.5, -0.5, 0), 1.0};
    EXPECT_TRUE(puller->pull({&target, 1}, chain.pose)->is_reached);
    return before.parent_from_bone[0].rotation.angularDistance(
        chain.pose.parent_from_bone[0].rotation);
  };
  EXPECT_LT(turn_of_first(10), 0.5f * turn_of_first(0));
  EXPECT_LT(turn_of_first(1), turn_of_first(0));
}

TEST(Pull, two_hands_at_once) {
  // A spine with two arms.
  Chain chain = straight_chain(3);
  for (const double side : {-1.0, 1.0}) {
    std::uint32_t parent = 2;
    for (int i = 0; i < 3; ++i) {
      Bone bone;
      bone.name = "arm " + std::to_string(chain.skeleton.bones.size());
      bone.parent = parent;
      bone.rest.translation = Vec3f(static_cast<float>(side), 0.2f, 0);
      parent = static_cast<std::uint32_t>(chain.skeleton.bones.size());
      chain.bones.push_back(parent);
      chain.skeleton.bones.push_back(bone);
      chain.pose.parent_from_bone.push_back(bone.rest);
    }
  }
  const PullHandle left = handle_on_bone(5), right = handle_on_bone(8);
  auto puller = PosePuller::create(chain.skeleton, chain.bones);
  ASSERT_TRUE(puller);
  const std::vector<PullTarget> targets = {{&left, Vec3d(-1.5, 3, 1), 1.0},
                                           {&right, Vec3d(2.0, 2, -1), 3.0}};
  const auto report = puller->pull(targets, chain.pose);
  ASSERT_TRUE(report);
  EXPECT_TRUE(report->is_reached) << report->error;
  EXPECT_LT((chain.point(chain.pose, left) - targets[0].place).norm(), 5e-4);
  EXPECT_LT((chain.point(chain.pose, right) - targets[1].place).norm(), 5e-4);
}

TEST(Pull, pulls_a_place_of_the_skin) {
  const Character character = make_tube(12, 8, 5);
  Random random(3);
  for (int i = 0; i < 20; ++i) {
    Pose pose = *local_rest_pose(character);
    for (float& weight : pose.morph_weights) weight = static_cast<float>(random.uniform(0, 1));
    const std::uint32_t triangle = random.index(character.meshes[0].triangle_count());
    const Vec3d at(0.2, 0.3, 0.5);
    const auto handle = handle_on_surface(character, 0, triangle, at, pose.morph_weights);
    ASSERT_TRUE(handle) << handle.error().text();
    const auto place_in = [&](const Pose& in) {
      ModelPose model;
      EXPECT_TRUE(compute_model_pose(character.skeleton, in, model));
      const auto posed = posed_positions(character, 0, model);
      Vec3d sum = Vec3d::Zero();
      for (int corner = 0; corner < 3; ++corner)
        sum += at[corner] *
               posed[character.meshes[0].triangles[triangle][static_cast<std::size_t>(corner)]];
      return sum;
    };
    const auto chain = chain_between(character.skeleton, 0, handle->main_bone());
    ASSERT_TRUE(chain);
    // Somewhere the chain can bring it to.
    Pose other = pose;
    for (const std::uint32_t bone : *chain)
      ASSERT_TRUE(rotate_bone(character.skeleton, bone, about(random.direction(), 0.4),
                              EditSpace::bone, other));
    const Vec3d place = place_in(other);
    PullOptions options;
    options.attempts = 8;
    options.iterations = 100;
    const auto report = pull_point(character.skeleton, *chain, *handle, place, pose, options);
    ASSERT_TRUE(report);
    EXPECT_NEAR((place_in(pose) - place).norm(), report->error, 1e-5);
    EXPECT_TRUE(report->is_reached) << i << ": " << report->error;
  }
}

TEST(Pull, a_warm_puller_allocates_nothing) {
  Random random(9);
  Chain chain = random_chain(random, 8, false);
  auto puller = PosePuller::create(chain.skeleton, chain.bones);
  ASSERT_TRUE(puller);
  const PullHandle handle = handle_on_bone(7, Vec3d(0, 0.5, 0));
  PullTarget target = {&handle, Vec3d(1, 1, 0), 1.0};
  ASSERT_TRUE(puller->pull({&target, 1}, chain.pose));
  target.place = Vec3d(-1, 0.5, 0.2);
  const std::uint64_t before = allocation_count();
  ASSERT_TRUE(puller->pull({&target, 1}, chain.pose));
  EXPECT_EQ(allocation_count(), before);
}

TEST(Pull, gives_the_same_bits_again) {
  const auto run = [] {
    Random random(11);
    Chain chain = random_chain(random, 8, true);
    const PullHandle handle = handle_on_bone(7, Vec3d(0, 0.5, 0));
    PullOptions options;
    options.attempts = 5;
    EXPECT_TRUE(
        pull_point(chain.skeleton, chain.bones, handle, Vec3d(0.4, 0.1, 0.2), chain.pose, options));
    return chain.pose.parent_from_bone;
  };
  EXPECT_EQ(run(), run());
}

TEST(Pull, no_input_gives_nan) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  const double numbers[] = {0.0, 1e-300, 1e-30, 1.0, 1e20, 1e30, 1e154, 1e300, kInfinity, NAN};
  for (std::uint64_t seed = 0; seed < static_cast<std::uint64_t>(stressed(400, 10)); ++seed) {
    Random random(seed);
    Chain chain = random_chain(random, 1 + random.index(6), true);
    const auto number = [&] { return numbers[random.index(std::size(numbers))]; };
    const auto vector = [&] {
      const double x = number(), y = number(), z = number();
      return Vec3d(x, y, z);
    };
    for (BoneTransform& bone : chain.pose.parent_from_bone) {
      if (random.index(4) == 0) bone.scale = Vec3d(vector().cwiseMin(1e38)).cast<float>();
      if (random.index(4) == 0) bone.translation = Vec3d(vector().cwiseMin(1e38)).cast<float>();
      if (random.index(4) == 0) bone.rotation.coeffs().setZero();
    }
    const PullHandle handle = handle_on_bone(
        chain.bones.back(), random.index(2) == 0 ? vector() : Vec3d(random.direction()));
    const Vec3d place = random.index(2) == 0 ? vector() : Vec3d(random.direction());
    const Pose before = chain.pose;
    const auto report = pull_point(chain.skeleton, chain.bones, handle, place, chain.pose);
    for (std::size_t i = 0; i < before.parent_from_bone.size(); ++i) {
      const auto &was = before.parent_from_bone[i].rotation,
                 &is = chain.pose.parent_from_bone[i].rotation;
      if (!report) {
        EXPECT_TRUE((was.coeffs().array() == is.coeffs().array()).all()) << seed;
      } else {
        EXPECT_TRUE(is.coeffs().allFinite()) << seed;
      }
    }
    if (report) {
      EXPECT_TRUE(std::isfinite(report->error)) << seed;
      EXPECT_LE(report->error, report->error_before) << seed;
    }
  }
}

TEST(Pull, refuses_bad_arguments) {
  Chain chain = straight_chain(3);
  const std::vector<std::uint32_t> none, missing = {7}, twice = {1, 1};
  const auto code = [&](const std::vector<std::uint32_t>& bones, std::vector<BoneLimit> limits = {},
                        std::vector<float> stiffness = {}) {
    return PosePuller::create(chain.skeleton, bones, limits, stiffness).error().code();
  };
  EXPECT_EQ(code(none), StatusCode::empty_input);
  EXPECT_EQ(code(missing), StatusCode::index_out_of_range);
  EXPECT_EQ(code(twice), StatusCode::invalid_argument);
  EXPECT_EQ(code({0}, {}, {1, 2}), StatusCode::size_mismatch);
  EXPECT_EQ(code({0}, {}, {-1}), StatusCode::invalid_argument);
  EXPECT_EQ(code({0}, {{BoneLimit::Kind::hinge, 0, Vec3d(0, 0, 0), 0, 1, 0}}),
            StatusCode::invalid_argument);
  EXPECT_EQ(code({0}, {{BoneLimit::Kind::hinge, 0, Vec3d(0, 0, 1), 1, 0, 0}}),
            StatusCode::invalid_argument);
  EXPECT_EQ(code({0}, {{BoneLimit::Kind::cone, 0, Vec3d(0, 0, 1), 0, 1, NAN}}),
            StatusCode::invalid_argument);
  auto puller = PosePuller::create(chain.skeleton, chain.bones);
  ASSERT_TRUE(puller);
  const PullHandle handle = handle_on_bone(2), outside = handle_on_bone(9), empty;
  const auto pull = [&](const PullTarget& target, Pose pose) {
    return puller->pull({&target, 1}, pose).error().code();
  };
  EXPECT_EQ(puller->pull({}, chain.pose).error().code(), StatusCode::empty_input);
  EXPECT_EQ(pull({nullptr, Vec3d::Zero(), 1.0}, chain.pose), StatusCode::empty_input);
  EXPECT_EQ(pull({&empty, Vec3d::Zero(), 1.0}, chain.pose), StatusCode::empty_input);
  EXPECT_EQ(pull({&outside, Vec3d::Zero(), 1.0}, chain.pose), StatusCode::index_out_of_range);
  EXPECT_EQ(pull({&handle, Vec3d(NAN, 0, 0), 1.0}, chain.pose), StatusCode::non_finite_value);
  EXPECT_EQ(pull({&handle, Vec3d::Zero(), 0.0}, chain.pose), StatusCode::invalid_argument);
  EXPECT_EQ(pull({&handle, Vec3d::Zero(), 1.0}, Pose()), StatusCode::size_mismatch);
  EXPECT_EQ(chain_between(chain.skeleton, 2, 1).error().code(), StatusCode::not_found);
  EXPECT_EQ(*chain_between(chain.skeleton, 0, 2), (std::vector<std::uint32_t>{0, 1, 2}));
}

}  // namespace
}  // namespace sunder::test
