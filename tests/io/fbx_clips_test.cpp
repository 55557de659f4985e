// Clips of FBX files, compared with the definition of the FBX transform stack, which is evaluated
// here as a product of matrices, and with three's FBXLoader.

#include <sunder/io/character_file.h>
#include <sunder/skinning/pose.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <numbers>
#include <sstream>
#include <string>
#include <vector>

#include <Eigen/LU>
#include <gtest/gtest.h>

#include "skinning/internal/reference.h"
#include "support/machine/node_program.h"
#include "support/machine/random.h"
#include "support/machine/stress.h"
#include "support/machine/temporary_folder.h"
#include "support/models/fbx_text.h"
#include "support/models/shared_models.h"

namespace sunder {
namespace {

using test::FbxCurve;
using test::FbxFile;
using test::FbxModel;
using test::FbxMotion;
using test::FbxTake;
using test::Random;
using Matrix = Eigen::Matrix4d;

// ---- The definition.

Matrix moved(const Vec3d& by) {
  Matrix matrix = Matrix::Identity();
  matrix.topRightCorner<3, 1>() = by;
  return matrix;
}

Matrix turned(const Vec3d& degrees, int order) {
  constexpr const char* kOrders[] = {"xyz", "xzy", "yzx", "yxz", "zxy", "zyx"};
  Matrix matrix = Matrix::Identity();
  for (const char* axis = kOrders[order]; *axis != '\0'; ++axis) {
    const double angle = degrees[*axis - 'x'] * std::numbers::pi / 180.0;
    Matrix turn = Matrix::Identity();
    const int a = (*axis - 'x' + 1) % 3, b = (*axis - 'x' + 2) % 3;
    turn(a, a) = turn(b, b) = std::cos(angle);
    turn(b, a) = std::sin(angle);
    turn(a, b) = -std::sin(angle);
    matrix = turn * matrix;
  }
  return matrix;
}

Matrix scaled(const Vec3d& by) {
  Matrix matrix = Matrix::Identity();
  matrix.diagonal().head<3>() = by;
  return matrix;
}

double value_at(const FbxCurve& curve, double seconds, double rest) {
  if (curve.empty()) return rest;
  if (seconds <= curve.front().seconds) return curve.front().value;
  for (std::size_t i = 1; i < curve.size(); ++i) {
    if (seconds > curve[i].seconds) continue;
    const double x = (seconds - curve[i - 1].seconds) / (curve[i].seconds - curve[i - 1].seconds);
    return curve[i - 1].value + x * (curve[i].value - curve[i - 1].value);
  }
  return curve.back().value;
}

Vec3d values_at(const std::array<FbxCurve, 3>& curves, double seconds, const Vec3d& rest) {
  return {value_at(curves[0], seconds, rest[0]), value_at(curves[1], seconds, rest[1]),
          value_at(curves[2], seconds, rest[2])};
}

struct Evaluated {
  Matrix scene_from_model, turn, scale;
};

/// All models at a moment of a take; at rest if there is none.
std::vector<Evaluated> evaluate(const FbxFile& file, const FbxTake* take, double seconds) {
  std::vector<Evaluated> all;
  for (std::uint32_t i = 0; i < file.models.size(); ++i) {
    FbxModel m = file.models[i];
    if (take != nullptr) {
      for (const FbxMotion& motion : take->motions) {
        if (motion.model != i) continue;
        m.translation = values_at(motion.translation, seconds, m.translation);
        m.rotation = values_at(motion.rotation, seconds, m.rotation);
        m.scaling = values_at(motion.scaling, seconds, m.scaling);
      }
    }
    const Matrix turn = turned(m.pre_rotation, 0) * turned(m.rotation, m.rotation_order) *
                        turned(m.post_rotation, 0).inverse();
    const Matrix local = moved(m.translation) * moved(m.rotation_offset) * moved(m.rotation_pivot) *
                         turn * moved(-m.rotation_pivot) * moved(m.scaling_offset) *
                         moved(m.scaling_pivot) * scaled(m.scaling) * moved(-m.scaling_pivot);
    Evaluated parent{Matrix::Identity(), Matrix::Identity(), Matrix::Identity()};
    if (m.parent != kNone) parent = all[m.parent];
    Evaluated here{Matrix::Identity(), parent.turn * turn, scaled(m.scaling)};
    const Vec3d place = local.topRightCorner<3, 1>();
    Matrix parent_linear = parent.scene_from_model;
    parent_linear.topRightCorner<3, 1>().setZero();
    const Matrix parent_shape = parent.turn.inverse() * parent_linear;
    if (m.inherit_type == 0) {
      here.scene_from_model = here.turn * parent_shape * here.scale;
    } else if (m.inherit_type == 1) {
      here.scene_from_model = parent.turn * parent_shape * turn * here.scale;
    } else {
      here.scene_from_model = here.turn * parent_shape * parent.scale.inverse() * here.scale;
    }
    here.scene_from_model.topRightCorner<3, 1>() =
        (parent.scene_from_model * place.homogeneous()).head<3>();
    all.push_back(here);
  }
  return all;
}

// ---- Ours.

ModelPose pose_of(const Character& character, int clip, double seconds) {
  Pose pose = *local_rest_pose(character);
  if (clip >= 0) {
    EXPECT_TRUE(sample_clip(character.clips[static_cast<std::size_t>(clip)], seconds, pose));
  }
  ModelPose model_pose;
  EXPECT_TRUE(compute_model_pose(character.skeleton, pose, model_pose));
  return model_pose;
}

std::vector<Vec3d> corners_of(const Character& character, const Mesh& mesh, const ModelPose& pose) {
  std::vector<Affine3d> palette(character.skins[mesh.skin].bones.size());
  EXPECT_TRUE(compute_palette(character.skins[mesh.skin], pose, palette));
  std::vector<Vec3d> corners;
  for (const Triangle& triangle : mesh.triangles)
    for (const std::uint32_t vertex : triangle)
      corners.push_back(deform_position_reference(mesh, vertex, palette, {}));
  return corners;
}

/// Largest distance of a corner from the definition, relative to the size of the whole.
double largest_difference(const Character& character, const FbxFile& file, int clip,
                          double clip_seconds, double file_seconds) {
  const FbxTake* const take = clip < 0 ? nullptr : &file.takes[static_cast<std::size_t>(clip)];
  const std::vector<Evaluated> expected = evaluate(file, take, file_seconds);
  const ModelPose pose = pose_of(character, clip, clip_seconds);
  double largest = 0.0;
  Eigen::AlignedBox3d box;
  for (std::size_t m = 0; m < file.models.size(); ++m) {
    const auto mesh =
        std::find_if(character.meshes.begin(), character.meshes.end(),
                     [&](const Mesh& one) { return one.name == file.models[m].name; });
    if (mesh == character.meshes.end()) return HUGE_VAL;
    const std::vector<Vec3d> corners = corners_of(character, *mesh, pose);
    if (corners.size() != 3) return HUGE_VAL;
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3d wanted =
          (expected[m].scene_from_model * file.models[m].triangle[k].homogeneous()).head<3>();
      box.extend(Eigen::Vector3d(wanted));
      largest = std::max(largest, (corners[k] - wanted).norm());
    }
  }
  return largest / box.diagonal().norm();
}

Result<LoadedCharacter> load(const FbxFile& file) {
  const test::TemporaryFolder folder;
  return load_character(folder.write("model.fbx", std::string_view(test::fbx_text(file))));
}

/// Interpolation between the keys of a clip turns a bone by at most 1e-4 rad from the file's curve;
/// bones lever that.
constexpr double kTolerance = 1e-3;

void expect_clips_match(const FbxFile& file, const std::string& what) {
  const auto loaded = load(file);
  ASSERT_TRUE(loaded) << what << loaded.error().text();
  const Character& character = *loaded->character;
  EXPECT_LT(largest_difference(character, file, -1, 0.0, 0.0), 1e-5) << what << " at rest";
  ASSERT_EQ(character.clips.size(), file.takes.size()) << what;
  for (std::size_t t = 0; t < file.takes.size(); ++t) {
    const FbxTake& take = file.takes[t];
    EXPECT_EQ(character.clips[t].name, take.name);
    double first = HUGE_VAL, last = -HUGE_VAL;
    for (const FbxMotion& motion : take.motions)
      for (const auto* curves : {&motion.translation, &motion.rotation, &motion.scaling})
        for (const FbxCurve& curve : *curves)
          for (const test::FbxKey& key : curve) {
            first = std::min(first, key.seconds);
            last = std::max(last, key.seconds);
          }
    const bool has_span = take.stop > take.start;
    const double start = has_span ? take.start : first, stop = has_span ? take.stop : last;
    EXPECT_NEAR(static_cast<double>(character.clips[t].duration), stop - start, 1e-5) << what;
    for (int i = 0; i <= 40; ++i) {
      const double seconds = (stop - start) * i / 40.0;
      ASSERT_LT(largest_difference(character, file, static_cast<int>(t), seconds, start + seconds),
                kTolerance)
          << what << ", take " << t << " at " << seconds;
    }
  }
}

// ---- Cases.

FbxCurve random_curve(Random& random, double start, double stop, double from, double to) {
  FbxCurve curve;
  const std::uint32_t keys = 1 + random.index(5);
  for (std::uint32_t i = 0; i < keys; ++i) {
    const double x = keys == 1 ? 0.0 : (i + random.uniform(0.0, 0.5)) / (keys - 0.5);
    curve.push_back({start + x * (stop - start), random.uniform(from, to)});
  }
  return curve;
}

Vec3d random_vector(Random& random, double most) {
  return {random.uniform(-most, most), random.uniform(-most, most), random.uniform(-most, most)};
}

struct Freedom {
  bool has_rotations = true;  ///< Pre- and post-rotations.
  bool has_pivots = true;     ///< Pivots and offsets.
  bool has_scales = true;     ///< Scales, with any way of inheriting them.
};

FbxFile random_file(Random& random, const Freedom& may) {
  FbxFile file;
  const std::uint32_t models = 2 + random.index(4);
  for (std::uint32_t i = 0; i < models; ++i) {
    FbxModel model;
    model.name = "part_" + std::to_string(i);
    if (i > 0) model.parent = random.index(2) == 0 ? i - 1 : random.index(i);
    model.translation = random_vector(random, 2.0);
    model.rotation = random_vector(random, 120.0);
    model.rotation_order = static_cast<int>(random.index(6));
    if (may.has_rotations && random.index(2) == 0)
      model.pre_rotation = random_vector(random, 180.0);
    if (may.has_rotations && random.index(3) == 0)
      model.post_rotation = random_vector(random, 90.0);
    if (may.has_pivots && random.index(2) == 0) {
      model.rotation_pivot = random_vector(random, 1.0);
      model.rotation_offset = random_vector(random, 1.0);
      model.scaling_pivot = random_vector(random, 1.0);
      model.scaling_offset = random_vector(random, 1.0);
    }
    model.inherit_type = static_cast<int>(random.index(3));
    if (may.has_scales && random.index(2) == 0)
      model.scaling = Vec3d::Constant(random.uniform(0.5, 2.0));
    model.triangle = {Vec3d(0, 0, 0), random_vector(random, 1.0), random_vector(random, 1.0)};
    file.models.push_back(model);
  }
  const std::uint32_t takes = 1 + random.index(3);
  for (std::uint32_t t = 0; t < takes; ++t) {
    FbxTake take;
    take.name = "take " + std::to_string(t);
    const double start = random.uniform(-2.0, 1.0), stop = start + random.uniform(0.5, 2.0);
    if (random.index(2) == 0) {
      take.start = start;
      take.stop = stop;
    }
    for (std::uint32_t m = 0; m < models; ++m) {
      if (m > 0 && random.index(3) == 0) continue;
      FbxMotion motion;
      motion.model = m;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        if (random.index(3) == 0)
          motion.translation[axis] = random_curve(random, start, stop, -2, 2);
        if (random.index(4) != 0 || m == 0)
          motion.rotation[axis] = random_curve(random, start, stop, -200, 200);
      }
      if (may.has_scales && random.index(3) == 0) {
        const FbxCurve even = random_curve(random, start, stop, 0.5, 2.0);
        motion.scaling = {even, even, even};
      }
      take.motions.push_back(motion);
    }
    file.takes.push_back(take);
  }
  return file;
}

void expect_random_files_match(const Freedom& may, std::uint64_t seed) {
  const int cases = test::stressed(25, 12);
  for (int i = 0; i < cases; ++i) {
    Random random(seed + static_cast<std::uint64_t>(i));
    expect_clips_match(random_file(random, may),
                       "seed " + std::to_string(seed + static_cast<std::uint64_t>(i)));
    if (testing::Test::HasFatalFailure()) return;
  }
}

TEST(FbxClips, rotations_alone) { expect_random_files_match({false, false, false}, 100); }
TEST(FbxClips, pre_and_post_rotations) { expect_random_files_match({true, false, false}, 1000); }
TEST(FbxClips, pivots_and_offsets) { expect_random_files_match({true, true, false}, 2000); }
TEST(FbxClips, scales_however_they_are_inherited) {
  expect_random_files_match({true, true, true}, 3000);
}

/// A bone with a scale along one axis, whose child does not inherit it, as in Maya.
TEST(FbxClips, a_child_without_its_parents_uneven_scale) {
  FbxFile file;
  file.models.resize(3);
  for (std::uint32_t i = 0; i < 3; ++i) {
    file.models[i].name = "bone_" + std::to_string(i);
    file.models[i].parent = i == 0 ? kNone : i - 1;
    file.models[i].translation = Vec3d(0, 1, 0);
    file.models[i].inherit_type = 2;
  }
  FbxTake take{.name = "squash", .motions = {}};
  take.motions.push_back({.model = 1, .translation = {}, .rotation = {}, .scaling = {}});
  take.motions.back().scaling[1] = {{0.0, 1.0}, {1.0, 0.4}};
  take.motions.push_back({.model = 2, .translation = {}, .rotation = {}, .scaling = {}});
  take.motions.back().rotation[2] = {{0.0, 0.0}, {1.0, 80.0}};
  file.takes.push_back(take);
  expect_clips_match(file, "squash");
}

TEST(FbxClips, a_take_before_time_zero_keeps_all_its_keys) {
  FbxFile file;
  file.models.resize(1);
  file.models[0].name = "turtle";
  file.models[0].pre_rotation = Vec3d(-90, 0, 0);
  FbxTake take{.name = "early", .motions = {}};
  take.motions.push_back({.model = 0, .translation = {}, .rotation = {}, .scaling = {}});
  take.motions.back().rotation[0] = {{-1.5, 0.0}, {-1.0, 40.0}, {-0.5, 10.0}};
  file.takes.push_back(take);
  const auto loaded = load(file);
  ASSERT_TRUE(loaded) << loaded.error().text();
  for (const LoadNote& note : loaded->report.notes)
    EXPECT_EQ(note.kind, LoadNote::Kind::information) << note.text;
  expect_clips_match(file, "early");
}

// ---- Another reader.

/// From the file's units and axes, which three leaves as they are.
Affine3d model_from_file(const Character& character) {
  for (const Bone& bone : character.skeleton.bones)
    if (bone.name == "model_from_file")
      return Eigen::Translation3d(Eigen::Vector3d(bone.rest.translation.cast<double>())) *
             Affine3d(bone.rest.rotation.cast<double>().toRotationMatrix() *
                      bone.rest.scale.cast<double>().asDiagonal());
  return Affine3d::Identity();
}

/// Compares all nodes whose names are those of one bone, relative to the size of the skeleton.
/// @param left_out  a take that three poses another way.
void expect_three_agrees(const std::filesystem::path& file, double tolerance,
                         const std::string& left_out = "") {
  const auto loaded = load_character(file);
  ASSERT_TRUE(loaded) << file << loaded.error().text();
  const Character& character = *loaded->character;
  const Affine3d ours_from_theirs = model_from_file(character);
  ASSERT_FALSE(character.clips.empty()) << file;
  for (std::size_t c = 0; c < character.clips.size(); ++c) {
    if (character.clips[c].name == left_out) continue;
    const auto run = test::run_node_program(
        "fbx_nodes.mjs", "'" + file.string() + "' '" + character.clips[c].name + "'");
    ASSERT_TRUE(run && run->succeeded) << file << (run ? run->output : "node does not start");
    std::istringstream lines(run->output);
    std::size_t count = 0;
    double largest = 0.0, size = 0.0;
    std::string worst;
    for (std::string seconds, name, elements; std::getline(lines, seconds, '\t') &&
                                              std::getline(lines, name, '\t') &&
                                              std::getline(lines, elements);) {
      const auto& bones = character.skeleton.bones;
      const auto bone = std::find_if(bones.begin(), bones.end(),
                                     [&](const Bone& one) { return one.name == name; });
      if (bone == bones.end()) continue;
      Eigen::Matrix4d theirs;
      std::istringstream numbers(elements);
      for (int i = 0; i < 16; ++i) numbers >> theirs.data()[i];
      const Affine3d expected = ours_from_theirs * Affine3d(theirs.topRows<3>());
      const ModelPose pose = pose_of(character, static_cast<int>(c), std::stod(seconds));
      const Affine3d ours = pose.model_from_bone[static_cast<std::size_t>(bone - bones.begin())];
      size = std::max(size, ours.translation().norm());
      // Where the origin and the ends of the axes go, axes as long as the skeleton is large.
      const double off = (ours.translation() - expected.translation()).norm() +
                         size * (ours.linear() - expected.linear()).norm() /
                             std::max(expected.linear().norm(), 1e-30);
      if (off > largest) worst = name + " at " + seconds;
      largest = std::max(largest, off);
      ++count;
    }
    EXPECT_GT(count, 3u) << run->output.substr(0, 500);
    EXPECT_LT(largest, tolerance * size)
        << file << ", take " << character.clips[c].name << ", node " << worst;
  }
}

TEST(FbxClips, three_poses_nodes_the_same_way) {
  if (!test::has_node_packages({"three"})) GTEST_SKIP() << "needs node and tests/npm";
  const test::TemporaryFolder folder;
  for (const std::uint64_t seed : {11u, 12u, 13u}) {
    Random random(seed);
    FbxFile file = random_file(random, {true, false, false});  // three animates without pivots.
    for (FbxTake& take : file.takes)  // and takes components without a curve as zero.
      for (FbxMotion& motion : take.motions)
        for (auto* curves : {&motion.translation, &motion.rotation})
          for (FbxCurve& curve : *curves) curve = {{take.start, random.uniform(-60.0, 60.0)}};
    expect_three_agrees(folder.write("own.fbx", std::string_view(test::fbx_text(file))), 1e-3);
  }
  if (test::shared_models().empty()) return;
  const std::filesystem::path strangers = test::shared_models().parent_path() / "strangers";
  // three multiplies scales that the file's children do not inherit.
  expect_three_agrees(test::shared_models() / "rigged/soft_tube_14bones.fbx", 1e-3);
  const std::filesystem::path maya = strangers / "ufbx_maya_sausage_7500.fbx";
  if (std::filesystem::exists(maya)) expect_three_agrees(maya, 1e-3, "deform");
  const std::filesystem::path other = strangers / "mdb_simple_si_rig.fbx";
  if (std::filesystem::exists(other)) expect_three_agrees(other, 1e-3);
}

TEST(FbxClips, nodes_are_the_models_of_the_file) {
  Random random(7);
  const FbxFile file = random_file(random, {true, true, false});
  const auto loaded = load(file);
  ASSERT_TRUE(loaded) << loaded.error().text();
  for (const FbxModel& model : file.models)
    EXPECT_TRUE(std::any_of(loaded->character->skeleton.bones.begin(),
                            loaded->character->skeleton.bones.end(),
                            [&](const Bone& bone) { return bone.name == model.name; }))
        << model.name;
  for (const Bone& bone : loaded->character->skeleton.bones)
    EXPECT_EQ(bone.name.find("AssimpFbx"), std::string::npos) << bone.name;
}

}  // namespace
}  // namespace sunder
