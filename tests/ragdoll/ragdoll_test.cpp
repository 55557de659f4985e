// Contract of ragdolls: include/sunder/ragdoll/ragdoll.h.

#include <sunder/ragdoll/ragdoll.h>
#include <sunder/skinning/pose.h>
#include <sunder/tear/detached_piece.h>

#include <cmath>
#include <limits>
#include <numbers>

#include <gtest/gtest.h>

#include "support/machine/random.h"
#include "support/machine/stress.h"
#include "support/models/animated_rig.h"
#include "support/models/random_operations.h"
#include "support/models/rigs.h"
#include "support/oracles/ragdoll_laws.h"

namespace sunder::test {
namespace {

constexpr double kPi = std::numbers::pi;

Ragdoll ragdoll_of(const Character& character, const ModelPose& pose,
                   const RagdollOptions& options = {}) {
  Result<Ragdoll> made = make_ragdoll(character, pose, options);
  EXPECT_TRUE(made) << made.error().text();
  return made ? *std::move(made) : Ragdoll{};
}

std::vector<Affine3d> places_in(const Ragdoll& ragdoll, const ModelPose& pose) {
  std::vector<Affine3d> places(ragdoll.bodies.size());
  EXPECT_TRUE(place_bodies(ragdoll, pose, places));
  return places;
}

TEST(Ragdoll, keeps_its_laws_for_tubes_in_random_poses) {
  for (int seed = 0; seed < stressed(60, 20); ++seed) {
    SCOPED_TRACE(seed);
    Random random(seed);
    const Character tube = make_tube(12, 12, 2 + random.index(6));
    const ModelPose pose = random_pose(tube, random, 0.8, random.index(2) == 0 ? 1.0 : 1.2);
    expect_ragdoll_laws(tube, pose, ragdoll_of(tube, pose), random);
  }
}

TEST(Ragdoll, keeps_its_laws_for_random_rigs_and_options) {
  for (int seed = 0; seed < stressed(80, 50); ++seed) {
    SCOPED_TRACE(seed);
    Random random(seed);
    const Character rig = seed % 2 == 0 ? make_animated_rig(any_animated_rig(random), random)
                                        : random_character(random);
    const ModelPose pose = random_pose(rig, random, 0.8, 1.0);
    RagdollOptions options;
    options.maximum_bodies = 1 + random.index(12);
    options.least_share = random.index(3) == 0 ? 0.0 : random.uniform(0, 0.3);
    const Ragdoll ragdoll = ragdoll_of(rig, pose, options);
    EXPECT_LE(ragdoll.bodies.size(), options.maximum_bodies);
    expect_ragdoll_laws(rig, pose, ragdoll, random);
  }
}

TEST(Ragdoll, weighs_what_the_whole_weighs_and_turns_as_it_does) {
  const Character tube = make_tube(24, 16, 4);
  Random random(3);
  const ModelPose pose = random_pose(tube, random, 0.5, 1.0);
  const Ragdoll ragdoll = ragdoll_of(tube, pose);
  ASSERT_EQ(ragdoll.bodies.size(), 4u);
  const auto whole = compute_mass(posed_positions(tube, 0, pose), tube.meshes[0].triangles);
  ASSERT_TRUE(whole);
  // The sum of the bodies by the parallel axis theorem. The fans that close neighbours at their
  // common border are the same, so that the parts fill the whole.
  double mass = 0;
  Vec3d moment = Vec3d::Zero();
  for (const RagdollBody& body : ragdoll.bodies) {
    mass += body.mass;
    moment += body.mass * body.model_from_body.translation();
  }
  EXPECT_NEAR(mass, whole->mass, 1e-9 * mass);
  EXPECT_LT((moment / mass - whole->centre).norm(), 1e-6);
  Mat3d inertia = Mat3d::Zero();
  for (const RagdollBody& body : ragdoll.bodies) {
    const Mat3d axes = body.model_from_body.linear();
    const Vec3d away = body.model_from_body.translation() - whole->centre;
    inertia += axes * body.moments.asDiagonal() * axes.transpose() +
               body.mass * (away.squaredNorm() * Mat3d::Identity() - away * away.transpose());
  }
  EXPECT_LT((inertia - whole->inertia).norm(), 1e-5 * whole->inertia.norm());
}

TEST(Ragdoll, joints_lie_at_the_bones_and_hang_on_the_nearest_body_above) {
  const Character tube = make_tube(24, 16, 5);
  const ModelPose pose = *rest_pose(tube);
  RagdollOptions options;
  options.maximum_bodies = 3;
  const Ragdoll ragdoll = ragdoll_of(tube, pose, options);
  ASSERT_EQ(ragdoll.bodies.size(), 3u);
  EXPECT_EQ(ragdoll.bodies[0].parent, kNone);
  for (std::uint32_t i = 1; i < 3; ++i) {
    EXPECT_EQ(ragdoll.bodies[i].parent, i - 1);
    EXPECT_LT((ragdoll.bodies[i].model_from_body * ragdoll.bodies[i].body_from_joint.translation() -
               pose.model_from_bone[ragdoll.bodies[i].bone].translation())
                  .norm(),
              1e-12);
  }
  for (const std::uint32_t body : ragdoll.body_of_bone) EXPECT_LT(body, 3u);
}

/// A chain in which the second of three bones turns about its z axis alone.
Character make_knee() {
  Character tube = make_tube(24, 16, 3);
  Clip clip;
  clip.name = "knee";
  clip.duration = 2.0f;
  Channel channel;
  channel.target = ChannelTarget::rotation;
  channel.index = tube.skins[0].bones[1];
  channel.width = 4;
  for (int k = 0; k <= 4; ++k) {
    const double angle = 0.4 * k;
    channel.times.push_back(0.5f * static_cast<float>(k));
    const Quatd turn(tube.skeleton.bones[channel.index].rest.rotation.cast<double>() *
                     Eigen::Quaterniond(Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitZ())));
    for (int i = 0; i < 4; ++i) channel.values.push_back(static_cast<float>(turn.coeffs()[i]));
  }
  clip.channels = {channel};
  tube.clips = {clip};
  return tube;
}

TEST(Ragdoll, a_knee_is_a_hinge_and_what_no_clip_turns_has_a_cone) {
  const Character knee = make_knee();
  const Ragdoll ragdoll = ragdoll_of(knee, *rest_pose(knee));
  ASSERT_EQ(ragdoll.bodies.size(), 3u);
  const BoneLimit& hinge = ragdoll.bodies[1].limit;
  EXPECT_EQ(hinge.kind, BoneLimit::Kind::hinge);
  const double sign = hinge.axis.z();
  EXPECT_NEAR(std::abs(sign), 1.0, 1e-5);
  // 0.2 beyond the poses of the clip that were looked at, which leave out its last moment.
  const double upper = sign > 0 ? hinge.upper : -hinge.lower;
  EXPECT_GE(upper, 1.6);
  EXPECT_LE(upper, 1.8 + 1e-4);
  EXPECT_NEAR(sign > 0 ? hinge.lower : -hinge.upper, -0.2, 0.06);
  const BoneLimit& still = ragdoll.bodies[2].limit;
  EXPECT_EQ(still.kind, BoneLimit::Kind::cone);
  EXPECT_EQ(still.cone, 0.5);
  EXPECT_EQ(still.lower, -0.5);
}

TEST(Ragdoll, a_turned_hinge_shows_in_its_joint_as_a_turn_about_x) {
  const Character knee = make_knee();
  const Ragdoll ragdoll = ragdoll_of(knee, *rest_pose(knee));
  ASSERT_EQ(ragdoll.bodies.size(), 3u);
  const RagdollBody& shin = ragdoll.bodies[1];
  ASSERT_EQ(shin.limit.kind, BoneLimit::Kind::hinge);
  for (const double time : {0.0, 0.7, 1.3, 2.0}) {
    const ModelPose pose = *make_pose(knee, ClipPose{"knee", time});
    std::vector<Quatd> turns(3);
    ASSERT_TRUE(joint_turns(ragdoll, places_in(ragdoll, pose), turns));
    const double angle = 2.0 * std::atan2(turns[1].x(), turns[1].w());
    EXPECT_NEAR(std::abs(angle), 0.8 * time, 1e-5) << time;
    EXPECT_NEAR(turns[1].y(), 0.0, 1e-5);
    EXPECT_NEAR(turns[1].z(), 0.0, 1e-5);
    EXPECT_GE(angle, shin.limit.lower - 1e-9);
    EXPECT_LE(angle, shin.limit.upper + 1e-9);
    EXPECT_NEAR(turns[2].w(), 1.0, 1e-6);  // at rest
  }
}

TEST(Ragdoll, given_limits_count_before_those_of_clips_and_are_widened_to_the_pose) {
  const Character knee = make_knee();
  const std::uint32_t bone = knee.skins[0].bones[1];
  const BoneLimit given{BoneLimit::Kind::hinge, bone, Vec3d(0, 0, 2), -0.25, 0.5, 0.0};
  RagdollOptions options;
  options.limits = {&given, 1};
  EXPECT_EQ(ragdoll_of(knee, *rest_pose(knee), options).bodies[1].limit.upper, 0.5);
  const Ragdoll bent = ragdoll_of(knee, *make_pose(knee, ClipPose{"knee", 2.0}), options);
  EXPECT_EQ(bent.bodies[1].limit.lower, -0.25);
  EXPECT_NEAR(bent.bodies[1].limit.upper, 1.6, 1e-5);
}

TEST(Ragdoll, limits_of_the_whole_serve_its_pieces) {
  const Character knee = make_knee();
  const ModelPose pose = *rest_pose(knee);
  const Ragdoll whole = ragdoll_of(knee, pose);
  std::vector<BoneLimit> limits;
  for (const RagdollBody& body : whole.bodies)
    if (body.parent != kNone) limits.push_back(body.limit);
  Character without_clips = knee;
  without_clips.clips.clear();
  RagdollOptions options;
  options.limits = limits;
  const Ragdoll again = ragdoll_of(without_clips, pose, options);
  ASSERT_EQ(again.bodies.size(), whole.bodies.size());
  for (std::size_t i = 1; i < whole.bodies.size(); ++i) {
    EXPECT_EQ(again.bodies[i].limit.kind, whole.bodies[i].limit.kind);
    EXPECT_NEAR(again.bodies[i].limit.lower, whole.bodies[i].limit.lower, 1e-9);
    EXPECT_NEAR(again.bodies[i].limit.upper, whole.bodies[i].limit.upper, 1e-9);
    EXPECT_LT((again.bodies[i].body_from_joint.matrix() - whole.bodies[i].body_from_joint.matrix())
                  .norm(),
              1e-6);
  }
}

TEST(Ragdoll, a_severed_limb_becomes_bodies_of_its_bones_alone) {
  const auto tube = std::make_shared<const Character>(make_tube(24, 16, 5));
  auto model = TornModel::create(tube);
  ASSERT_TRUE(model);
  Random random(5);
  const ModelPose pose = random_pose(*tube, random, 0.3, 1.0);
  PlaneCut cut;
  cut.point = pose.model_from_bone[tube->skins[0].bones[2]].translation();
  cut.normal = pose.model_from_bone[tube->skins[0].bones[2]].linear().col(1);
  cut.caps = true;
  ASSERT_TRUE(model->cut(pose, cut));
  DetachOptions animated;
  animated.motion = PieceMotion::animated;
  const Vec3d hand = pose.model_from_bone[tube->skins[0].bones[4]].translation();
  const auto piece = detach(*model, pose, PieceNear{hand}, animated);
  ASSERT_TRUE(piece) << piece.error().text();
  const Ragdoll ragdoll = ragdoll_of(*piece->character, pose);
  EXPECT_GE(ragdoll.bodies.size(), 2u);
  EXPECT_LE(ragdoll.bodies.size(), 4u);
  double mass = 0;
  for (const RagdollBody& body : ragdoll.bodies) mass += body.mass;
  EXPECT_NEAR(mass, piece->mass.mass, 1e-6 * mass);  // rounded weights
  expect_ragdoll_laws(*piece->character, pose, ragdoll, random);
}

TEST(Ragdoll, mirrored_bones_keep_their_joints) {
  for (int seed = 0; seed < 20; ++seed) {
    SCOPED_TRACE(seed);
    Random random(seed);
    Character tube = make_tube(16, 12, 4);
    tube.skeleton.bones[tube.skins[0].bones[random.index(3)]].rest.scale[random.index(3)] = -1.0f;
    const ModelPose pose = random_pose(tube, random, 0.5, 1.0);
    expect_ragdoll_laws(tube, pose, ragdoll_of(tube, pose), random);
  }
}

TEST(Ragdoll, parts_on_mirrored_bones_weigh_as_much) {
  const Character figure = make_block_figure();
  ASSERT_EQ(figure.meshes.size(), 2u);
  const auto mass_of = [&](std::uint32_t mesh, const ModelPose& pose) {
    return compute_mass(posed_positions(figure, mesh, pose), figure.meshes[mesh].triangles)->mass;
  };
  const ModelPose rest = *rest_pose(figure);
  for (const double scale : {1.0, -1.0, -2.0, -0.5}) {
    ModelPose pose = rest;
    Affine3d& head = pose.model_from_bone[figure.skins[0].bones[1]];
    head = head * Eigen::Scaling(scale, 1.0, 1.0);
    double mass = 0;
    for (const RagdollBody& body : ragdoll_of(figure, pose).bodies) mass += body.mass;
    EXPECT_NEAR(mass, mass_of(0, rest) + std::abs(scale) * mass_of(1, rest), 1e-6 * mass) << scale;
  }
}

TEST(Ragdoll, parts_without_a_common_bone_are_not_tied) {
  Character two = make_two_tubes(8, 8);
  const Ragdoll ragdoll = ragdoll_of(two, *rest_pose(two));
  std::size_t roots = 0, trees = 0;
  for (const RagdollBody& body : ragdoll.bodies) roots += body.parent == kNone;
  for (const Bone& bone : two.skeleton.bones) trees += bone.parent == kNone;
  EXPECT_EQ(roots, trees);
}

TEST(Ragdoll, faults_are_named_and_nothing_is_written) {
  const Character tube = make_tube(8, 8, 3);
  const ModelPose pose = *rest_pose(tube);
  const auto fault = [&](auto change) {
    RagdollOptions options;
    change(options);
    const auto made = make_ragdoll(tube, pose, options);
    return made ? StatusCode::ok : made.error().code();
  };
  EXPECT_EQ(fault([](auto& o) { o.maximum_bodies = 0; }), StatusCode::invalid_argument);
  EXPECT_EQ(fault([](auto& o) { o.least_share = -1; }), StatusCode::invalid_argument);
  EXPECT_EQ(fault([](auto& o) { o.least_share = std::nan(""); }), StatusCode::invalid_argument);
  EXPECT_EQ(fault([](auto& o) { o.mass.density = 0; }), StatusCode::invalid_argument);
  const BoneLimit none{BoneLimit::Kind::cone, 99, Vec3d(1, 0, 0), 0, 0, 0};
  EXPECT_EQ(fault([&](auto& o) { o.limits = {&none, 1}; }), StatusCode::index_out_of_range);
  ModelPose short_pose = pose;
  short_pose.model_from_bone.pop_back();
  EXPECT_EQ(make_ragdoll(tube, short_pose).error().code(), StatusCode::size_mismatch);
  EXPECT_EQ(make_ragdoll(Character{}, ModelPose{}).error().code(), StatusCode::empty_input);

  const Ragdoll ragdoll = ragdoll_of(tube, pose);
  std::vector<Affine3d> places(ragdoll.bodies.size(), Affine3d::Identity());
  EXPECT_EQ(place_bodies(ragdoll, short_pose, places).code(), StatusCode::size_mismatch);
  ModelPose flat = pose;
  flat.model_from_bone[ragdoll.bodies.back().bone].linear().setZero();
  EXPECT_EQ(place_bodies(ragdoll, flat, places).code(), StatusCode::non_finite_value);
  EXPECT_TRUE(places[0].matrix() == Affine3d::Identity().matrix());
  places[1].translation().x() = std::numeric_limits<double>::infinity();
  ModelPose kept = pose;
  EXPECT_EQ(pose_of_bodies(ragdoll, places, kept).code(), StatusCode::non_finite_value);
  EXPECT_TRUE(kept.model_from_bone[0].matrix() == pose.model_from_bone[0].matrix());
}

}  // namespace
}  // namespace sunder::test
