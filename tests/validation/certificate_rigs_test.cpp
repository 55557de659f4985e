// Rigged files: weights cut to the top two against the original. How close poses come to what is
// certified. The figures of docs/method/certificate.md are this program's output.

#include <sunder/certificate/certificate.h>
#include <sunder/io/character_file.h>
#include <sunder/skinning/pose.h>
#include <sunder/weights/influences.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <filesystem>

#include <gtest/gtest.h>

#include "support/machine/random.h"
#include "support/models/shared_models.h"
#include "validation/random_rig.h"

namespace sunder {
namespace {

constexpr double kDegree = std::numbers::pi / 180;

/// All meshes' vertices with cut weights against the same with their own.
struct CutRig {
  Character character;
  ModelPose bind;
  SkinDifferences rows;
  double diagonal = 0;
};

void append_cut_rows(CutRig& rig, std::uint32_t mesh, std::size_t influences) {
  Mesh& of = rig.character.meshes[mesh];
  const std::uint32_t count = of.vertex_count();
  for (std::uint32_t v = 0; v < count; ++v) {
    std::vector<Influence> cut(of.weights.of(v).begin(), of.weights.of(v).end());
    cut.resize(prune_influences(cut, influences));
    of.positions.push_back(Vec3f(of.positions[v]));
    of.weights.append(cut);
    const VertexShare shares[] = {{count + v, 1}, {v, -1}};
    ASSERT_TRUE(append_difference(rig.character, rig.bind, mesh, shares, rig.rows));
  }
}

CutRig load_cut(const std::filesystem::path& file, std::size_t influences) {
  CutRig rig;
  const auto loaded = load_character(file);
  EXPECT_TRUE(loaded) << file << ": " << loaded.error().text();
  if (!loaded) return rig;
  rig.character = *loaded->character;
  rig.bind = *bind_pose(rig.character);
  Vec3d low = Vec3d::Constant(1e30), high = -low;
  for (std::uint32_t mesh = 0; mesh < rig.character.meshes.size(); ++mesh) {
    const std::size_t first = rig.rows.first.size() - 1;
    append_cut_rows(rig, mesh, influences);
    for (std::size_t row = first; row + 1 < rig.rows.first.size(); ++row) {
      SkinDifferences place;  // in model space of bind
      const VertexShare share[] = {{static_cast<std::uint32_t>(row - first), 1}};
      if (!append_difference(rig.character, rig.bind, mesh, share, place)) continue;
      Vec3d at = Vec3d::Zero();
      for (const SkinTerm& term : place.terms) at += term.x;
      low = low.cwiseMin(at);
      high = high.cwiseMax(at);
    }
  }
  rig.diagonal = (high - low).norm();
  return rig;
}

JointLimits limits_of(const CutRig& rig, double degrees) {
  auto limits = degrees > 0 ? free_joint_limits(rig.character, rig.bind)
                            : joint_limits_of_clips(rig.character, rig.bind, 0);
  EXPECT_TRUE(limits) << limits.error().text();
  if (degrees > 0 && degrees < 180)
    for (JointRange& range : limits->of_bone) range.angle = degrees * kDegree;
  return *limits;
}

double posed_deviation(const CutRig& rig, std::uint32_t point, const ModelPose& pose) {
  Vec3d sum = Vec3d::Zero();
  for (std::uint32_t i = rig.rows.first[point]; i < rig.rows.first[point + 1]; ++i) {
    const SkinTerm& term = rig.rows.terms[i];
    const Affine3d matrix =
        pose.model_from_bone[term.bone] * rig.bind.model_from_bone[term.bone].inverse();
    sum += matrix.linear() * term.x + term.m * matrix.translation();
  }
  return sum.norm();
}

struct Bracket {
  double median = 1, least = 1, certified = 0, found = 0, random = 0;
  std::size_t points = 0;
};

/// The largest deviation of some points in 200 random poses within joint limits.
double largest_in_random_poses(const CutRig& rig, const JointLimits& limits,
                               const std::vector<std::uint32_t>& points) {
  test::Random random(52);
  ModelPose pose = rig.bind;
  double largest = 0;
  for (int i = 0; i < 200; ++i) {
    pose.model_from_bone =
        test::random_pose_within(random, {rig.character.skeleton, rig.bind, limits});
    for (const std::uint32_t point : points)
      largest = std::max(largest, posed_deviation(rig, point, pose));
  }
  return largest;
}

/// Found over certified at the 20 worst points, within joint limits.
Bracket bracket_of(const CutRig& rig, const JointLimits& limits, std::uint32_t refined) {
  Bracket bracket;
  const auto tree = JointTree::create(rig.character.skeleton, rig.bind, limits);
  EXPECT_TRUE(tree) << tree.error().text();
  const auto certificate = certify_deviation(*tree, rig.rows, {0, refined});
  EXPECT_TRUE(certificate) << certificate.error().text();
  bracket.certified = certificate->maximum;
  std::vector<double> ratios;
  const auto worst = worst_points(*certificate, 20);
  bracket.random = largest_in_random_poses(rig, limits, worst);
  EXPECT_LE(bracket.random, bracket.certified + 1e-12);
  for (const std::uint32_t point : worst) {
    const auto pose = find_worst_pose(*tree, rig.rows, point);
    EXPECT_TRUE(pose) << pose.error().text();
    EXPECT_NEAR(posed_deviation(rig, point, pose->pose), pose->found, 1e-9);
    EXPECT_LE(pose->found, certificate->bound[point]);
    bracket.found = std::max(bracket.found, pose->found);
    ratios.push_back(pose->found / certificate->bound[point]);
  }
  bracket.points = ratios.size();
  if (ratios.empty()) return bracket;
  std::sort(ratios.begin(), ratios.end());
  bracket.median = ratios[ratios.size() / 2];
  bracket.least = ratios.front();
  return bracket;
}

/// Of the repository and, where they are, the shared ones.
std::vector<std::filesystem::path> own_rigs() {
  return test::files_below(test::own_data() / "rigged", {".glb"});
}

/// Searched poses reach at least 85 % of what is certified, in the median of the worst 20 points.
/// @return the number of limits under which something was certified.
int expect_close(const std::filesystem::path& file) {
  int certified = 0;
  const CutRig rig = load_cut(file, 2);
  for (const double degrees : {30.0, 60.0, 120.0, 180.0, 0.0}) {
    if (degrees == 0 && rig.character.clips.empty()) continue;
    const JointLimits limits = limits_of(rig, degrees);
    const Bracket closed = bracket_of(rig, limits, 0), refined = bracket_of(rig, limits, 64);
    if (refined.points == 0) continue;
    ++certified;
    const std::string name =
        degrees > 0 ? std::to_string(static_cast<int>(degrees)) + "°" : "clips";
    std::printf("| %s, %s | %.2f (%.2f) | %.2f | %.3f | %.3f | %.3f |\n", file.stem().c_str(),
                name.c_str(), refined.median, refined.least, closed.median,
                100 * refined.random / rig.diagonal, 100 * refined.found / rig.diagonal,
                100 * refined.certified / rig.diagonal);
    EXPECT_GE(refined.median, 0.85) << file << ", " << name;
  }
  return certified;
}

void print_head() {
  std::printf(
      "| rig, limits | found / certified | coarse | random, %% of the diagonal | found | certified "
      "|\n|---|---|---|---|---|---|\n");
}

TEST(CertificateOfRigs, is_reached_on_our_own) {
  print_head();
  int certified = 0;
  for (const auto& file : own_rigs()) certified += expect_close(file);
  EXPECT_GT(certified, 10);
}

TEST(CertificateOfRigs, is_reached_on_shared_ones) {
  SUNDER_SKIP_WITHOUT_SHARED_MODELS();
  print_head();
  for (const char* const name :
       {"fox.glb", "cactoro.glb", "godot_hand_r.gltf", "webxr_hand_right.glb", "mannequiny.glb"})
    EXPECT_GT(expect_close(test::shared_models() / "rigged" / name), 0) << name;
}

TEST(CertificateOfRigs, holds_in_every_clip) {
  test::Random random(51);
  int poses = 0;
  for (const auto& file : test::rigged_gltf_models()) {
    const CutRig rig = load_cut(file, 2);
    if (rig.character.clips.empty()) continue;
    const auto tree = JointTree::create(rig.character.skeleton, rig.bind, limits_of(rig, 0));
    ASSERT_TRUE(tree) << tree.error().text();
    const auto certificate = certify_deviation(*tree, rig.rows);
    ASSERT_TRUE(certificate);
    EXPECT_TRUE(certificate->gaps.empty()) << file;
    const auto worst = worst_points(*certificate, 100);
    for (const Clip& clip : rig.character.clips)
      for (int i = 0; i < 10; ++i) {
        Pose local = *local_rest_pose(rig.character);
        ASSERT_TRUE(
            sample_clip(clip, random.uniform(0, static_cast<double>(clip.duration)), local));
        ModelPose pose;
        ASSERT_TRUE(compute_model_pose(rig.character.skeleton, local, pose));
        ++poses;
        for (const std::uint32_t point : worst)
          ASSERT_LE(posed_deviation(rig, point, pose), certificate->bound[point] + 1e-9) << file;
      }
  }
  EXPECT_GT(poses, 0);
}

TEST(CertificateOfRigs, takes_little_time) {
  std::printf(
      "| rig | vertices | changed by the cut | ns per vertex | ns per changed vertex |\n"
      "|---|---|---|---|---|\n");
  for (const auto& file : test::rigged_gltf_models()) {
    const CutRig rig = load_cut(file, 2);
    const auto tree = JointTree::create(rig.character.skeleton, rig.bind, limits_of(rig, 180));
    ASSERT_TRUE(tree);
    double best = 1e9;
    for (int i = 0; i < 20; ++i) {
      const auto start = std::chrono::steady_clock::now();
      ASSERT_TRUE(certify_deviation(*tree, rig.rows, {0, 0}));
      const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
      best = std::min(best, seconds.count());
    }
    const auto points = static_cast<double>(rig.rows.first.size() - 1);
    double changed = 0;
    for (std::size_t i = 0; i + 1 < rig.rows.first.size(); ++i)
      if (rig.rows.first[i] != rig.rows.first[i + 1]) ++changed;
    if (changed == 0) continue;
    std::printf("| %s | %.0f | %.0f | %.0f | %.0f |\n", file.stem().c_str(), points, changed,
                1e9 * best / points, 1e9 * best / changed);
  }
}

}  // namespace
}  // namespace sunder
