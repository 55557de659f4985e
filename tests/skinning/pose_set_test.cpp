#include <sunder/skinning/deform.h>
#include <sunder/skinning/pose.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <numbers>

#include <gtest/gtest.h>

#include "support/machine/allocation_count.h"
#include "support/models/rigs.h"

namespace sunder {
namespace {

using Role = PoseSet::Role;

constexpr double kDegree = std::numbers::pi / 180;
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

std::shared_ptr<const Character> share(Character character) {
  return std::make_shared<const Character>(std::move(character));
}

/// A tube whose bones are rotated, shifted and, if requested, scaled unevenly at rest.
Character make_crooked_tube(std::uint32_t bone_count, bool is_scaled = true) {
  Character character = test::make_tube(8, 4, bone_count);
  test::Random random(3);
  for (Bone& bone : character.skeleton.bones) {
    bone.rest.rotation =
        Quatf(Quatd(Eigen::AngleAxisd{random.uniform(-2, 2), random.direction()}).cast<float>());
    bone.rest.translation += 0.3f * random.direction().cast<float>();
    for (int axis = 0; is_scaled && axis < 3; ++axis)
      bone.rest.scale[axis] = static_cast<float>(random.uniform(0.7, 1.4));
  }
  character.rest_morph_weights = {0.25f};
  return character;
}

PoseSetSpec sweeps_only() {
  PoseSetSpec spec;
  spec.clip_samples = 0;
  spec.range_of_motion = true;
  return spec;
}

PoseSetSpec limits_only(std::vector<JointLimit> limits) {
  PoseSetSpec spec;
  spec.clip_samples = 0;
  spec.joint_limits = std::move(limits);
  return spec;
}

PoseSet make_set(const std::shared_ptr<const Character>& character, const PoseSetSpec& spec) {
  Result<PoseSet> set = PoseSet::create(character, spec);
  EXPECT_TRUE(set) << set.error().text();
  return *set;
}

Status fault_of(const Character& character, const PoseSetSpec& spec) {
  return PoseSet::create(share(character), spec).error();
}

std::vector<ModelPose> poses_of(const PoseSet& set, Role role) {
  std::vector<ModelPose> poses(set.size(role));
  for (std::size_t i = 0; i < poses.size(); ++i) EXPECT_TRUE(set.compute(role, i, poses[i]));
  return poses;
}

bool is_same(const ModelPose& a, const ModelPose& b) {
  if (a.model_from_bone.size() != b.model_from_bone.size() || a.morph_weights != b.morph_weights)
    return false;
  for (std::size_t i = 0; i < a.model_from_bone.size(); ++i)
    if (a.model_from_bone[i].matrix() != b.model_from_bone[i].matrix()) return false;
  return true;
}

ModelPose posed(const Character& character, const PoseSpec& spec) {
  const Result<ModelPose> pose = make_pose(character, spec);
  EXPECT_TRUE(pose);
  return *pose;
}

/// The largest difference between the matrices of two poses.
double distance(const ModelPose& a, const ModelPose& b) {
  double most = 0;
  for (std::size_t i = 0; i < a.model_from_bone.size(); ++i)
    most = std::max(
        most,
        (a.model_from_bone[i].matrix() - b.model_from_bone[i].matrix()).cwiseAbs().maxCoeff());
  return most;
}

/// No pose is both fitted and held out.
void expect_disjoint(const PoseSet& set) {
  const auto fit = poses_of(set, Role::fit), held_out = poses_of(set, Role::held_out);
  for (std::size_t i = 0; i < fit.size(); ++i)
    for (std::size_t j = 0; j < held_out.size(); ++j)
      EXPECT_GT(distance(fit[i], held_out[j]), 1e-3) << i << " and " << j;
}

struct Turned {
  std::uint32_t bone = 0;
  Vec3d axis = Vec3d::Zero();
  double angle = 0;
};
using Turns = std::vector<Turned>;

/// The rotation of each bone relative to rest, computed from the matrices of a pose.
std::vector<Mat3d> read_turns(const Character& character, const ModelPose& pose) {
  std::vector<Mat3d> turns;
  for (std::size_t i = 0; i < character.skeleton.bones.size(); ++i) {
    const Bone& bone = character.skeleton.bones[i];
    const Affine3d& model_from_bone = pose.model_from_bone[i];
    const Affine3d parent_from_bone =
        bone.parent == kNone
            ? model_from_bone
            : Affine3d(pose.model_from_bone[bone.parent].inverse() * model_from_bone);
    EXPECT_TRUE(parent_from_bone.translation().isApprox(bone.rest.translation.cast<double>(), 1e-9))
        << "a turn moves no joint";
    const Mat3d rest = bone.rest.rotation.cast<double>().toRotationMatrix();
    const Mat3d stretch = bone.rest.scale.cast<double>().cwiseInverse().asDiagonal();
    turns.push_back(rest.transpose() * parent_from_bone.linear() * stretch);
  }
  return turns;
}

bool is_turned_by(const std::vector<Mat3d>& found, const Turns& wanted) {
  std::vector<Mat3d> rotations(found.size(), Mat3d::Identity());
  for (const Turned& turned : wanted)
    rotations[turned.bone] =
        Eigen::AngleAxisd(turned.angle, Eigen::Vector3d(turned.axis)).toRotationMatrix();
  for (std::size_t i = 0; i < found.size(); ++i)
    if (!((found[i] - rotations[i]).cwiseAbs().maxCoeff() < 1e-6)) return false;
  return true;
}

/// The poses are the expected ones, each once, in any order. Bones that are neither rotated nor
/// below a rotated one are at rest, bit for bit.
void expect_sweeps(const Character& character, const PoseSet& set, Role role,
                   const std::vector<Turns>& wanted) {
  const auto& bones = character.skeleton.bones;
  const ModelPose rest = posed(character, RestPose{});
  std::vector<int> hits(wanted.size(), 0);
  for (const ModelPose& pose : poses_of(set, role)) {
    const auto found = read_turns(character, pose);
    std::size_t match = 0;
    while (match < wanted.size() && !is_turned_by(found, wanted[match])) ++match;
    ASSERT_LT(match, wanted.size()) << "nobody asked for this pose";
    ++hits[match];
    EXPECT_EQ(pose.morph_weights, character.rest_morph_weights);
    std::vector<bool> moves(bones.size(), false);
    for (const Turned& turned : wanted[match]) moves[turned.bone] = true;
    for (std::size_t i = 0; i < bones.size(); ++i) {
      if (bones[i].parent != kNone && moves[bones[i].parent]) moves[i] = true;
      EXPECT_EQ(pose.model_from_bone[i].matrix() != rest.model_from_bone[i].matrix(), moves[i])
          << "bone " << i;
    }
  }
  for (std::size_t i = 0; i < wanted.size(); ++i)
    EXPECT_EQ(hits[i], 1) << "pose " << i << " of those wanted";
}

void add_free_bone(std::uint32_t bone, std::vector<Turns>& fit, std::vector<Turns>& held_out) {
  for (int axis = 0; axis < 3; ++axis)
    for (const int sign : {-1, 1}) {
      for (const int degrees : {30, 60, 90})
        fit.push_back({{bone, Vec3d::Unit(axis), sign * degrees * kDegree}});
      for (const int degrees : {45, 75})
        held_out.push_back({{bone, Vec3d::Unit(axis), sign * degrees * kDegree}});
    }
}

void add_free_pair(std::uint32_t bone, std::uint32_t parent, std::vector<Turns>& fit,
                   std::vector<Turns>& held_out) {
  for (int axis = 0; axis < 3; ++axis) {
    for (const int degrees : {60, -60})
      fit.push_back({{bone, Vec3d::Unit(axis), 60 * kDegree},
                     {parent, Vec3d::Unit(axis), degrees * kDegree}});
    held_out.push_back({{bone, Vec3d::Unit(axis), 45 * kDegree},
                        {parent, Vec3d::Unit((axis + 1) % 3), 45 * kDegree}});
  }
}

// Clips

Channel rotation_of(std::uint32_t bone, std::vector<float> times, float angle) {
  Channel channel{ChannelTarget::rotation, bone, 4, Interpolation::linear, std::move(times), {}};
  for (const float time : channel.times)
    channel.values.insert(channel.values.end(),
                          {0, 0, std::sin(angle * time), std::cos(angle * time)});
  return channel;
}

/// The times of the poses of a clip, found among many.
std::vector<double> times_of(const Character& character, std::uint32_t clip, const PoseSet& set,
                             Role role, double step) {
  std::vector<double> times;
  for (std::size_t i = 0; i < set.size(role); ++i) {
    if (set.group_of(role, i) != PoseSet::Group{PoseSet::Source::clip, clip}) continue;
    ModelPose found;
    EXPECT_TRUE(set.compute(role, i, found));
    double nearest = 0, least = 1e300;
    for (double time = 0; time <= static_cast<double>(character.clips[clip].duration);
         time += step) {
      const double away = distance(found, posed(character, ClipPose{clip, time}));
      if (away < least) least = away, nearest = time;
    }
    times.push_back(nearest);
  }
  return times;
}

TEST(PoseSet, clips_are_sampled_at_equal_steps_of_their_motion) {
  // One bone turns by 3 radians in the first second, stands still for two, and turns by 1.5 radians
  // in the last one: 258 degrees are 18 steps of 15.
  Character character = test::make_tube(8, 4, 3);
  const auto turn = [](float angle) {
    return std::array<float, 4>{0, 0, std::sin(angle / 2), std::cos(angle / 2)};
  };
  Channel channel{ChannelTarget::rotation, 1, 4, Interpolation::linear, {0, 1, 3, 4}, {}};
  for (const float angle : {0.0f, 3.0f, 3.0f, 4.5f})
    for (const float value : turn(angle)) channel.values.push_back(value);
  character.clips = {{"turn", 4.0f, {channel}}};
  ASSERT_TRUE(validate_character(character));
  const PoseSet set = make_set(share(character), {});
  ASSERT_EQ(set.size(Role::fit), 18u);
  ASSERT_EQ(set.size(Role::held_out), 18u);
  const auto angle_at = [](double time) {
    return time <= 1 ? 3 * time : time <= 3 ? 3.0 : 3 + 1.5 * (time - 3);
  };
  const auto fit = times_of(character, 0, set, Role::fit, 0.004),
             held_out = times_of(character, 0, set, Role::held_out, 0.004);
  double weights = 0;
  for (std::size_t i = 0; i < 18; ++i) {
    EXPECT_NEAR(angle_at(fit[i]), (static_cast<double>(i) + 0.5) * 0.25, 0.02);
    EXPECT_NEAR(angle_at(held_out[i]), static_cast<double>(i) * 0.25, 0.02);
    weights += set.weight_of(i);
  }
  EXPECT_NEAR(weights, 18, 1e-9);
  EXPECT_NEAR(set.weight_of(0), 18 * (1.0 / 12) / 4, 0.02) << "a twelfth of the first second";
  expect_disjoint(set);
}

TEST(PoseSet, a_clip_gives_at_most_as_many_poses_as_requested_and_all_clips_768) {
  const Character tube = make_crooked_tube(4);
  for (const std::uint32_t most : {1u, 2u, 3u}) {
    PoseSetSpec spec;
    spec.clip_samples = most;
    const PoseSet set = make_set(share(tube), spec);
    EXPECT_LE(set.size(Role::fit), most);
    EXPECT_GE(set.size(Role::fit), std::min(most, 2u));
    EXPECT_EQ(set.size(Role::held_out), set.size(Role::fit));
    expect_disjoint(set);
  }
  Character many = tube;
  Clip spin{"spin", 4.0f, {rotation_of(1, {0, 1, 2, 3, 4}, 1.4f)}};
  many.clips.assign(200, spin);
  const PoseSet set = make_set(share(many), {});
  EXPECT_LE(set.size(Role::fit), 768u);
  for (std::uint32_t clip = 0; clip < 200; ++clip) {
    int count = 0;
    for (std::size_t i = 0; i < set.size(Role::fit); ++i)
      count += set.group_of(Role::fit, i).clip == clip ? 1 : 0;
    EXPECT_GE(count, 2);
  }
}

TEST(PoseSet, poses_of_clips_have_the_bits_of_a_sampled_clip) {
  Character character = make_crooked_tube(4);
  // Bones in random order, two channels with the same target, of which the later one applies, and
  // morph weights between them.
  Clip wild{"wild", 3.0f, {}};
  wild.channels.push_back(rotation_of(3, {0, 1, 3}, 0.4f));
  wild.channels.push_back(
      {ChannelTarget::morph_weights, 0, 1, Interpolation::linear, {0, 3}, {0, 1}});
  wild.channels.push_back(rotation_of(1, {0.5f, 2}, 0.3f));
  wild.channels.push_back(
      {ChannelTarget::scale, 3, 3, Interpolation::step, {0, 1}, {1, 2, 1, 2, 1, 1}});
  wild.channels.push_back(rotation_of(1, {0, 3}, -0.2f));
  wild.channels.push_back(
      {ChannelTarget::translation, 0, 3, Interpolation::linear, {0, 3}, {0, 0, 0, 1, 2, 3}});
  character.clips = {wild};
  ASSERT_TRUE(validate_character(character));
  const PoseSet set = make_set(share(character), {});
  ASSERT_GE(set.size(Role::held_out), 2u);
  ModelPose first;
  ASSERT_TRUE(set.compute(Role::held_out, 0, first));
  EXPECT_TRUE(is_same(first, posed(character, ClipPose{0u, 0.0})));
}

TEST(PoseSet, a_clip_that_only_moves_roots_is_one_pose) {
  Character character = make_crooked_tube(3);
  character.clips = {{"walk", 2.0f, {rotation_of(0, {0, 1, 2}, 1)}}};
  const PoseSet set = make_set(share(character), {});
  EXPECT_EQ(set.size(Role::fit), 1u);
  EXPECT_EQ(set.size(Role::held_out), 0u);
}

TEST(PoseSet, a_clip_that_does_not_last_is_one_pose) {
  Character character = make_crooked_tube(3);
  character.clips = {{"still", 0.0f, {rotation_of(1, {0}, 1)}}, {"empty", 0.0f, {}}};
  const PoseSet set = make_set(share(character), {});
  ASSERT_EQ(set.size(Role::fit), 2u);
  EXPECT_EQ(set.size(Role::held_out), 0u);
  const auto poses = poses_of(set, Role::fit);
  EXPECT_TRUE(is_same(poses[0], posed(character, ClipPose{0u, 0.0})));
  EXPECT_TRUE(is_same(poses[1], posed(character, RestPose{})));
}

// Joints

TEST(PoseSet, a_range_of_motion_turns_each_joint_alone_and_with_its_parent) {
  for (const bool is_scaled : {false, true}) {
    const auto character = share(make_crooked_tube(4, is_scaled));
    const PoseSet set = make_set(character, sweeps_only());
    std::vector<Turns> fit, held_out;
    for (const std::uint32_t bone : {1u, 2u, 3u})
      add_free_bone(bone, fit, held_out);  // with bone 0 everything would rotate
    for (const std::uint32_t bone : {2u, 3u}) add_free_pair(bone, bone - 1, fit, held_out);
    EXPECT_EQ(set.size(Role::fit), 3u * 18 + 2 * 6);
    EXPECT_EQ(set.size(Role::held_out), 3u * 12 + 2 * 3);
    expect_sweeps(*character, set, Role::fit, fit);
    expect_sweeps(*character, set, Role::held_out, held_out);
    expect_disjoint(set);
  }
}

TEST(PoseSet, a_range_of_motion_comes_after_clips_and_before_given_poses) {
  const auto character = share(make_crooked_tube(3));
  PoseSetSpec spec;
  spec.range_of_motion = true;
  spec.poses = {BindPose{}};
  const PoseSet set = make_set(character, spec);
  const std::size_t clips = make_set(character, {}).size(Role::fit);
  ASSERT_EQ(set.size(Role::fit), clips + 2 * 18 + 6 + 1);
  ASSERT_EQ(set.size(Role::held_out), clips + 2 * 12 + 3);
  const auto sweeps = poses_of(make_set(character, sweeps_only()), Role::fit);
  const auto all = poses_of(set, Role::fit);
  for (std::size_t i = 0; i < sweeps.size(); ++i) EXPECT_TRUE(is_same(all[clips + i], sweeps[i]));
  EXPECT_TRUE(is_same(all.back(), posed(*character, BindPose{})));
  EXPECT_EQ(set.group_of(Role::fit, 0), (PoseSet::Group{PoseSet::Source::clip, 0}));
  EXPECT_EQ(set.group_of(Role::fit, clips).source, PoseSet::Source::joints);
  EXPECT_EQ(set.turned_bones(Role::fit, clips)[0], 1u);
  EXPECT_EQ(set.group_of(Role::fit, all.size() - 1).source, PoseSet::Source::given);
}

TEST(PoseSet, joints_side_by_side_have_no_pairs) {
  Character character = make_crooked_tube(4);
  for (Bone& bone : character.skeleton.bones)
    if (bone.parent != kNone) bone.parent = 0;
  const PoseSet set = make_set(share(character), sweeps_only());
  std::vector<Turns> fit, held_out;
  for (const std::uint32_t bone : {1u, 2u, 3u}) add_free_bone(bone, fit, held_out);
  expect_sweeps(character, set, Role::fit, fit);
  expect_sweeps(character, set, Role::held_out, held_out);
}

TEST(PoseSet, bones_that_change_no_shape_do_not_turn) {
  // Bone 0 is above all bones; bone 1 moves no vertex; no bone is below bone 4.
  Character character = test::make_tube(8, 4, 5);
  const std::vector<Influence> influences[] = {{{2, 1.0f}}, {{3, 0.5f}, {2, 0.5f}}, {{0, 1.0f}}};
  SkinWeights weights;
  for (std::uint32_t v = 0; v < character.meshes[0].vertex_count(); ++v)
    weights.append(influences[v % 3]);
  character.meshes[0].weights = weights;
  std::vector<Turns> fit, held_out;
  for (const std::uint32_t bone : {2u, 3u}) add_free_bone(bone, fit, held_out);
  add_free_pair(3, 2, fit, held_out);
  const PoseSet set = make_set(share(character), sweeps_only());
  expect_sweeps(character, set, Role::fit, fit);
  expect_sweeps(character, set, Role::held_out, held_out);
}

TEST(PoseSet, a_mesh_that_turns_as_a_whole_keeps_its_shape) {
  // Two rigs in one skeleton, each with a mesh: each root rotates all of one mesh and nothing of
  // the other.
  Character character = test::make_two_tubes(4, 4);
  for (std::uint32_t bone = 0; bone < 3; ++bone) {
    Bone copy = character.skeleton.bones[bone];
    copy.name += " of upper";
    if (copy.parent != kNone) copy.parent += 3;
    character.skeleton.bones.push_back(copy);
    character.skins[1].bones[bone] = bone + 3;
  }
  ASSERT_TRUE(validate_character(character));
  std::vector<Turns> fit, held_out;
  for (const std::uint32_t bone : {1u, 2u, 4u, 5u}) add_free_bone(bone, fit, held_out);
  for (const std::uint32_t bone : {2u, 5u}) add_free_pair(bone, bone - 1, fit, held_out);
  expect_sweeps(character, make_set(share(character), sweeps_only()), Role::fit, fit);
}

TEST(PoseSet, three_hundred_bones_are_thousands_of_poses) {
  const auto character = share(test::make_tube(300, 4, 300));
  const PoseSet set = make_set(character, sweeps_only());
  EXPECT_EQ(set.size(Role::fit), 299u * 18 + 298 * 6);
  EXPECT_EQ(set.size(Role::held_out), 299u * 12 + 298 * 3);
}

// Limits

TEST(PoseSet, a_limited_joint_turns_about_its_axis_within_its_limits) {
  const Character character = make_crooked_tube(4);
  const Vec3d axis = Vec3d(1, 2, -2) / 3;
  const PoseSet set = make_set(share(character), limits_only({{2, 5 * axis, -0.4, 1.2}}));
  const auto alone = [&](std::initializer_list<double> angles) {
    std::vector<Turns> wanted;
    for (const double angle : angles) wanted.push_back({{2, axis, angle}});
    return wanted;
  };
  expect_sweeps(character, set, Role::fit, alone({-0.4, -0.2, 0.6, 1.2}));
  expect_sweeps(character, set, Role::held_out, alone({-0.3, -0.1, 0.3, 0.9}));
  expect_disjoint(set);
}

TEST(PoseSet, limits_that_do_not_reach_to_both_sides_of_rest_are_kept) {
  const Character character = make_crooked_tube(4);
  struct Case {
    double lower, upper;
    std::vector<double> fit, held_out;
  };
  for (const Case& of :
       {Case{0, 1.2, {0.6, 1.2}, {0.3, 0.9}}, Case{-1.2, 0, {-1.2, -0.6}, {-0.9, -0.3}},
        Case{0.4, 1.2, {0.4, 0.8, 1.2}, {0.6, 1.0}},
        Case{-1.2, -0.4, {-1.2, -0.8, -0.4}, {-1.0, -0.6}}, Case{0.5, 0.5, {0.5}, {}}}) {
    const PoseSet set =
        make_set(share(character), limits_only({{3, Vec3d::UnitZ(), of.lower, of.upper}}));
    std::vector<Turns> fit, held_out;
    for (const double angle : of.fit) fit.push_back({{3, Vec3d::UnitZ(), angle}});
    for (const double angle : of.held_out) held_out.push_back({{3, Vec3d::UnitZ(), angle}});
    expect_sweeps(character, set, Role::fit, fit);
    expect_sweeps(character, set, Role::held_out, held_out);
    expect_disjoint(set);
  }
}

TEST(PoseSet, limits_hold_with_a_rotating_neighbour_too) {
  // A knee below a hip: the knee bends one way, the hip about two axes.
  const Character character = make_crooked_tube(4);
  const Vec3d x = Vec3d::UnitX(), y = Vec3d::UnitY();
  const PoseSet set =
      make_set(share(character), limits_only({{2, x, -1.6, 0}, {1, y, -0.4, 0.8}, {1, x, 0, 1.0}}));
  std::vector<Turns> fit, held_out;
  for (const double angle : {-0.4, -0.2, 0.4, 0.8}) fit.push_back({{1, y, angle}});
  for (const double angle : {0.5, 1.0}) fit.push_back({{1, x, angle}});
  for (const double angle : {-1.6, -0.8}) fit.push_back({{2, x, angle}});
  for (const double angle : {0.8, -0.4}) fit.push_back({{2, x, -1.6}, {1, y, angle}});
  fit.push_back({{2, x, -1.6}, {1, x, 1.0}});
  for (const double angle : {-0.3, -0.1, 0.2, 0.6}) held_out.push_back({{1, y, angle}});
  for (const double angle : {0.25, 0.75}) held_out.push_back({{1, x, angle}});
  for (const double angle : {-1.2, -0.4}) held_out.push_back({{2, x, angle}});
  held_out.push_back({{2, x, -1.2}, {1, x, 0.75}});
  held_out.push_back({{2, x, -1.2}, {1, y, 0.6}});
  expect_sweeps(character, set, Role::fit, fit);
  expect_sweeps(character, set, Role::held_out, held_out);
  expect_disjoint(set);
}

TEST(PoseSet, limits_replace_the_free_range_of_their_bone_alone) {
  const Character character = make_crooked_tube(4);
  PoseSetSpec spec = sweeps_only();
  spec.joint_limits = {{2, Vec3d::UnitY(), -0.4, 0.8},
                       {3, Vec3d::UnitX(), 0, 0}};  // bone 3 cannot rotate
  std::vector<Turns> fit, held_out;
  add_free_bone(1, fit, held_out);
  for (const double angle : {-0.4, -0.2, 0.4, 0.8}) fit.push_back({{2, Vec3d::UnitY(), angle}});
  for (const double angle : {-0.3, -0.1, 0.2, 0.6})
    held_out.push_back({{2, Vec3d::UnitY(), angle}});
  for (int axis = 0; axis < 3; ++axis) {
    for (const int degrees : {60, -60})
      fit.push_back({{2, Vec3d::UnitY(), 0.8}, {1, Vec3d::Unit(axis), degrees * kDegree}});
    held_out.push_back({{2, Vec3d::UnitY(), 0.6}, {1, Vec3d::Unit(axis), 45 * kDegree}});
  }
  const PoseSet set = make_set(share(character), spec);
  expect_sweeps(character, set, Role::fit, fit);
  expect_sweeps(character, set, Role::held_out, held_out);
  expect_disjoint(set);
}

TEST(PoseSet, two_joints_of_one_angle_each_have_one_pose_together) {
  const Character character = make_crooked_tube(3);
  const Vec3d x = Vec3d::UnitX();
  const PoseSet set =
      make_set(share(character), limits_only({{1, x, 0.5, 0.5}, {2, x, -0.5, -0.5}}));
  expect_sweeps(character, set, Role::fit,
                {{{1, x, 0.5}}, {{2, x, -0.5}}, {{1, x, 0.5}, {2, x, -0.5}}});
  EXPECT_EQ(set.size(Role::held_out), 0u);
}

TEST(PoseSet, limits_of_bones_that_change_no_shape_are_ignored) {
  const Character character = make_crooked_tube(3);
  const PoseSet set = make_set(
      share(character), limits_only({{0, Vec3d::UnitX(), -1, 1}, {2, Vec3d::UnitX(), -1, 1}}));
  EXPECT_EQ(set.size(Role::fit), 4u);
  EXPECT_EQ(set.size(Role::held_out), 4u);
}

// Given poses

TEST(PoseSet, every_fourth_given_pose_is_held_out) {
  const Character character = make_crooked_tube(3);
  test::Random random(4);
  std::vector<PoseSpec> given = {
      RestPose{}, BindPose{}, ClipPose{0u, 0.3},
      BonesPose{{{character.skeleton.bones[1].name, Vec3f(1, 2, 3), {}, {}}}}};
  while (given.size() < 11) given.emplace_back(test::random_pose(character, random));
  for (std::size_t count = 1; count <= given.size(); ++count) {
    PoseSetSpec spec = limits_only({});
    spec.poses.assign(given.begin(), given.begin() + static_cast<std::ptrdiff_t>(count));
    const PoseSet set = make_set(share(character), spec);
    ASSERT_EQ(set.size(Role::fit) + set.size(Role::held_out), count);
    ModelPose found;
    std::size_t fit = 0, held_out = 0;
    for (std::size_t i = 0; i < count; ++i) {
      if (i % 4 == 3)
        ASSERT_TRUE(set.compute(Role::held_out, held_out++, found));
      else
        ASSERT_TRUE(set.compute(Role::fit, fit++, found));
      EXPECT_TRUE(is_same(found, posed(character, given[i]))) << "pose " << i << " of " << count;
    }
    EXPECT_EQ(set.size(Role::fit), fit);
  }
}

// All

PoseSetSpec everything(const Character& character) {
  PoseSetSpec spec;
  spec.range_of_motion = true;
  spec.joint_limits = {{2, Vec3d(1, 1, 0), -0.5, 1}};
  test::Random random(5);
  for (int i = 0; i < 5; ++i) spec.poses.emplace_back(test::random_pose(character, random));
  return spec;
}

TEST(PoseSet, the_same_bits_into_new_and_used_memory_from_each_set_and_copy) {
  const Character character = make_crooked_tube(4);
  const PoseSet set = make_set(share(character), everything(character));
  const PoseSet other = make_set(share(character), everything(character));
  const PoseSet copy = set;
  for (const Role role : {Role::fit, Role::held_out}) {
    const auto poses = poses_of(set, role);
    ModelPose used{std::vector<Affine3d>(99, Affine3d(Eigen::Scaling(kNaN))),
                   std::vector<float>(9, 7.0f)};
    for (std::size_t i = poses.size(); i-- > 0;) {
      ASSERT_TRUE(set.compute(role, i, used));
      EXPECT_TRUE(is_same(used, poses[i]));
      ASSERT_TRUE(other.compute(role, i, used));
      EXPECT_TRUE(is_same(used, poses[i]));
      ASSERT_TRUE(copy.compute(role, i, used));
      EXPECT_TRUE(is_same(used, poses[i]));
    }
  }
}

TEST(PoseSet, computing_a_pose_into_memory_that_fits_allocates_nothing) {
  const Character character = make_crooked_tube(4);
  const PoseSet set = make_set(share(character), everything(character));
  ModelPose pose;
  ASSERT_TRUE(set.compute(Role::fit, 0, pose));
  const std::uint64_t before = test::allocation_count();
  for (const Role role : {Role::fit, Role::held_out})
    for (std::size_t i = 0; i < set.size(role); ++i) ASSERT_TRUE(set.compute(role, i, pose));
  EXPECT_EQ(test::allocation_count(), before);
}

TEST(PoseSet, a_set_keeps_its_character) {
  auto character = share(make_crooked_tube(3));
  const PoseSet set = make_set(character, sweeps_only());
  const auto poses = poses_of(set, Role::fit);
  const std::weak_ptr<const Character> watched = character;
  character.reset();
  EXPECT_FALSE(watched.expired());
  EXPECT_TRUE(is_same(poses_of(set, Role::fit)[7], poses[7]));
}

// Refusals

TEST(PoseSet, refuses_faulty_characters) {
  EXPECT_EQ(PoseSet::create(nullptr, {}).error().code(), StatusCode::empty_input);
  Character character = make_crooked_tube(3);
  character.clips[0].channels[0].times.clear();
  EXPECT_EQ(fault_of(character, {}).code(), StatusCode::empty_input);
  character = make_crooked_tube(3);
  character.clips.push_back({"endless", std::numeric_limits<float>::infinity(), {}});
  const Status fault = fault_of(character, {});
  EXPECT_EQ(fault.code(), StatusCode::non_finite_value);
  EXPECT_EQ(fault.index(), 1u);
}

TEST(PoseSet, refuses_faulty_limits_and_names_them) {
  const Character character = make_crooked_tube(3);
  const JointLimit good{1, Vec3d::UnitX(), -1, 1};
  const Vec3d x = Vec3d::UnitX();
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  struct Case {
    JointLimit limit;
    StatusCode code;
  };
  for (const Case& of : {Case{{3, x, -1, 1}, StatusCode::index_out_of_range},
                         Case{{kNone, x, -1, 1}, StatusCode::index_out_of_range},
                         Case{{1, Vec3d(0, kNaN, 0), -1, 1}, StatusCode::non_finite_value},
                         Case{{1, x, kNaN, 1}, StatusCode::non_finite_value},
                         Case{{1, x, -1, kInfinity}, StatusCode::non_finite_value},
                         Case{{1, x, 1, -1}, StatusCode::invalid_argument},
                         Case{{1, Vec3d::Zero(), -1, 1}, StatusCode::invalid_argument}}) {
    const Status fault = fault_of(character, limits_only({good, of.limit}));
    EXPECT_EQ(fault.code(), of.code) << fault.text();
    EXPECT_EQ(fault.index(), 1u);
    EXPECT_NE(fault.text().find("joint limit 1"), std::string_view::npos) << fault.text();
  }
}

TEST(PoseSet, refuses_faulty_given_poses_and_names_them) {
  const Character character = make_crooked_tube(3);
  ModelPose other = posed(test::make_sheet(1), RestPose{});
  ModelPose no_number = posed(character, RestPose{});
  no_number.model_from_bone[1].translation().y() = kNaN;
  ModelPose no_weight = posed(character, RestPose{});
  no_weight.morph_weights[0] = std::numeric_limits<float>::quiet_NaN();
  struct Case {
    PoseSpec pose;
    StatusCode code;
  };
  for (const Case& of :
       {Case{ClipPose{"none", 0}, StatusCode::not_found},
        Case{ClipPose{7u, 0}, StatusCode::not_found},
        Case{ClipPose{0u, kNaN}, StatusCode::non_finite_value},
        Case{BonesPose{{{"none", {}, {}, {}}}}, StatusCode::not_found},
        Case{other, StatusCode::size_mismatch}, Case{no_number, StatusCode::non_finite_value},
        Case{no_weight, StatusCode::non_finite_value}}) {
    PoseSetSpec spec;
    spec.poses = {RestPose{}, BindPose{}, of.pose};
    const Status fault = fault_of(character, spec);
    EXPECT_EQ(fault.code(), of.code) << fault.text();
    EXPECT_EQ(fault.index(), 2u);
    EXPECT_NE(fault.text().find("given pose 2: "), std::string_view::npos) << fault.text();
  }
}

TEST(PoseSet, refuses_a_set_without_a_pose_to_fit_over) {
  Character character = make_crooked_tube(3);
  EXPECT_EQ(fault_of(character, limits_only({})).code(), StatusCode::empty_input);
  EXPECT_EQ(fault_of(character, limits_only({{1, Vec3d::UnitX(), 0, 0}})).code(),
            StatusCode::empty_input);
  character.clips.clear();
  EXPECT_EQ(fault_of(character, {}).code(), StatusCode::empty_input);
  EXPECT_EQ(fault_of(test::make_tube(2, 4, 1), sweeps_only()).code(), StatusCode::empty_input)
      << "one bone has no neighbour";
}

TEST(PoseSet, refuses_more_samples_than_anyone_needs) {
  PoseSetSpec spec;
  spec.clip_samples = 65'537;
  EXPECT_EQ(fault_of(make_crooked_tube(3), spec).code(), StatusCode::limit_exceeded);
}

}  // namespace
}  // namespace sunder
