// Rows of skinned meshes, cracks, and influences chosen under a certificate.

#include <sunder/certificate/certificate.h>
#include <sunder/skinning/pose.h>
#include <sunder/weights/influences.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "skinning/internal/character_pose.h"
#include "support/models/random_skin.h"
#include "support/models/rigs.h"
#include "validation/random_rig.h"

namespace sunder {
namespace {

using test::Random;

struct SkinnedScene {
  Character character;
  ModelPose bind;
  JointLimits limits;

  [[nodiscard]] JointTree tree() const {
    auto result = JointTree::create(character.skeleton, bind, limits);
    EXPECT_TRUE(result) << result.error().text();
    return *result;
  }
};

/// A tube of bones in a chain, each limited to an angle.
SkinnedScene tube(double angle) {
  SkinnedScene scene;
  scene.character = test::make_tube(24, 12, 6);
  scene.bind = *bind_pose(scene.character);
  scene.limits.of_bone.resize(scene.character.skeleton.bones.size());
  for (JointRange& range : scene.limits.of_bone) range.angle = angle;
  return scene;
}

ModelPose pose_within(Random& random, const SkinnedScene& scene) {
  const test::RandomRig rig{scene.character.skeleton, scene.bind, scene.limits};
  ModelPose pose = scene.bind;
  pose.model_from_bone = test::random_pose_within(random, rig);
  for (float& weight : pose.morph_weights) weight = 0;
  return pose;
}

/// Weights divided by their sum, in double, as rows have them.
Vec3d posed(const Character& character, const CharacterPose& pose, std::uint32_t vertex,
            std::span<const Influence> influences) {
  const Mesh& mesh = character.meshes[0];
  double sum = 0;
  Vec3d position = Vec3d::Zero();
  for (const Influence& influence : influences) {
    const auto weight = static_cast<double>(influence.weight);
    position += weight * (pose.palette(0)[influence.slot] * mesh.positions[vertex].cast<double>());
    sum += weight;
  }
  return position / sum;
}

TEST(SkinRows, are_what_skinning_poses) {
  Random random(41);
  const SkinnedScene scene = tube(std::numbers::pi);
  const std::uint32_t vertices = scene.character.meshes[0].vertex_count();
  for (int i = 0; i < 100; ++i) {
    const std::uint32_t a = random.index(vertices), b = random.index(vertices);
    SkinDifferences rows;
    const VertexShare shares[] = {{a, 0.3}, {b, -0.7}};
    ASSERT_TRUE(append_difference(scene.character, scene.bind, 0, shares, rows));
    const ModelPose model_pose = pose_within(random, scene);
    CharacterPose pose;
    ASSERT_TRUE(pose.set(scene.character, model_pose));
    const SkinWeights& weights = scene.character.meshes[0].weights;
    const Vec3d expected = 0.3 * posed(scene.character, pose, a, weights.of(a)) -
                           0.7 * posed(scene.character, pose, b, weights.of(b));
    Vec3d sum = Vec3d::Zero();
    for (const SkinTerm& term : rows.terms) {
      const Affine3d matrix =
          model_pose.model_from_bone[term.bone] * scene.bind.model_from_bone[term.bone].inverse();
      sum += matrix.linear() * term.x + term.m * matrix.translation();
    }
    EXPECT_LT((sum - expected).norm(), 1e-6);  // bind matrices are stored as floats
  }
}

TEST(SkinRows, of_equal_copies_are_empty) {
  Random random(42);
  SkinnedScene scene = tube(std::numbers::pi);
  Mesh& mesh = scene.character.meshes[0];
  const std::uint32_t count = mesh.vertex_count();
  SkinDifferences rows;
  for (std::uint32_t vertex = 0; vertex < count; ++vertex) {
    mesh.positions.push_back(Vec3f(mesh.positions[vertex]));
    const std::vector<Influence> copy(mesh.weights.of(vertex).begin(),
                                      mesh.weights.of(vertex).end());
    mesh.weights.append(copy);
    const VertexShare shares[] = {{vertex, 1}, {count + vertex, -1}};
    ASSERT_TRUE(append_difference(scene.character, scene.bind, 0, shares, rows));
  }
  EXPECT_TRUE(rows.terms.empty());
  const auto certificate = certify_deviation(scene.tree(), rows);
  ASSERT_TRUE(certificate);
  EXPECT_EQ(certificate->bound, std::vector<double>(count, 0.0));
}

/// t (1 - t) * the weight that differs across each joint * 2 sin(angle / 2) * the edge.
double crack_formula(const SkinnedScene& scene, std::uint32_t a, std::uint32_t b, double t) {
  const Mesh& mesh = scene.character.meshes[0];
  const Skin& skin = scene.character.skins[mesh.skin];
  std::vector<double> flow(scene.character.skeleton.bones.size(), 0.0);
  for (const Influence& influence : mesh.weights.of(a))
    flow[skin.bones[influence.slot]] += static_cast<double>(influence.weight);
  for (const Influence& influence : mesh.weights.of(b))
    flow[skin.bones[influence.slot]] -= static_cast<double>(influence.weight);
  double sum = 0;
  for (std::size_t bone = flow.size(); bone-- > 0;) {
    const std::uint32_t parent = scene.character.skeleton.bones[bone].parent;
    if (parent == kNone) continue;
    flow[parent] += flow[bone];
    sum += std::abs(flow[bone]) * 2 * std::sin(scene.limits.of_bone[bone].angle / 2);
  }
  return t * (1 - t) * sum * (mesh.positions[a] - mesh.positions[b]).cast<double>().norm();
}

TEST(Crack, of_a_t_junction_is_at_most_the_formula_and_holds) {
  Random random(43);
  for (const double angle : {0.5, 1.5, std::numbers::pi}) {
    SkinnedScene scene = tube(angle);
    Mesh& mesh = scene.character.meshes[0];
    const std::uint32_t count = mesh.vertex_count();
    SkinDifferences rows;
    std::vector<double> formula;
    for (int i = 0; i < 200; ++i) {
      const Triangle& triangle = mesh.triangles[random.index(mesh.triangle_count())];
      const std::uint32_t a = triangle[0], b = triangle[1];
      const double t = random.uniform(0.1, 0.9);
      std::vector<double> weight_of(scene.character.skins[0].bones.size(), 0.0);
      for (const Influence& of : mesh.weights.of(a))
        weight_of[of.slot] += (1 - t) * static_cast<double>(of.weight);
      for (const Influence& of : mesh.weights.of(b))
        weight_of[of.slot] += t * static_cast<double>(of.weight);
      std::vector<Influence> influences;
      for (std::uint32_t slot = 0; slot < weight_of.size(); ++slot)
        if (weight_of[slot] > 0) influences.push_back({slot, static_cast<float>(weight_of[slot])});
      mesh.positions.push_back(
          ((1 - t) * mesh.positions[a].cast<double>() + t * mesh.positions[b].cast<double>())
              .cast<float>());
      mesh.weights.append(influences);
      const VertexShare shares[] = {
          {count + static_cast<std::uint32_t>(i), 1}, {a, t - 1}, {b, -t}};
      ASSERT_TRUE(append_difference(scene.character, scene.bind, 0, shares, rows));
      formula.push_back(crack_formula(scene, a, b, t));
    }
    const auto certificate = certify_deviation(scene.tree(), rows);
    ASSERT_TRUE(certificate);
    EXPECT_TRUE(certificate->gaps.empty());
    for (std::size_t i = 0; i < formula.size(); ++i)
      EXPECT_LE(certificate->bound[i], formula[i] + 2e-6) << "positions and weights are floats";
    for (int k = 0; k < 20; ++k) {
      const ModelPose model_pose = pose_within(random, scene);
      for (std::size_t i = 0; i < formula.size(); ++i) {
        Vec3d sum = Vec3d::Zero();
        for (std::uint32_t j = rows.first[i]; j < rows.first[i + 1]; ++j) {
          const SkinTerm& term = rows.terms[j];
          const Affine3d matrix = model_pose.model_from_bone[term.bone] *
                                  scene.bind.model_from_bone[term.bone].inverse();
          sum += matrix.linear() * term.x + term.m * matrix.translation();
        }
        EXPECT_LE(sum.norm(), certificate->bound[i] + 1e-12);
      }
    }
  }
}

/// The certificate of one vertex' change, by the public functions alone, coarse or refined.
double bound_of_change(const SkinnedScene& scene, std::uint32_t vertex,
                       std::span<const Influence> influences, std::uint32_t refined = 0) {
  Character character = scene.character;
  Mesh& mesh = character.meshes[0];
  const std::uint32_t count = mesh.vertex_count();
  mesh.positions.push_back(Vec3f(mesh.positions[vertex]));
  mesh.weights.append(influences);
  SkinDifferences rows;
  const VertexShare shares[] = {{count, 1}, {vertex, -1}};
  EXPECT_TRUE(append_difference(character, scene.bind, 0, shares, rows));
  const auto certificate = certify_deviation(scene.tree(), rows, {0, refined});
  EXPECT_TRUE(certificate);
  return certificate->bound[0];
}

TEST(CertifiedInfluences, keep_the_error_with_as_few_as_they_can) {
  Random random(44);
  const SkinnedScene scene = tube(1.0);
  const SkinWeights& original = scene.character.meshes[0].weights;
  for (const double error : {0.1, 0.03}) {
    InfluenceBudget budget;
    budget.maximum_error = error;
    budget.bits = {8, 16, 32};
    const auto result = certified_influences(scene.character, scene.bind, scene.tree(), 0, budget);
    ASSERT_TRUE(result) << result.error().text();
    EXPECT_LE(result->maximum, error);
    EXPECT_EQ(result->above_maximum_error, 0u);
    EXPECT_LT(result->weights.influences.size(), original.influences.size());
    for (std::uint32_t v = 0; v < original.vertex_count(); v += 7) {
      const auto chosen = result->weights.of(v);
      EXPECT_LE(result->bound[v], bound_of_change(scene, v, chosen) + 1e-12);
      EXPECT_GE(result->bound[v], bound_of_change(scene, v, chosen, 1) - 1e-12);
      std::vector<Influence> fewer(original.of(v).begin(), original.of(v).end());
      const std::size_t kept = result->weights.of(v).size();
      if (kept < 2) continue;
      fewer.resize(prune_influences(fewer, kept - 1));
      if (result->bits[v] == 32) {
        EXPECT_GT(bound_of_change(scene, v, fewer, 1), error) << "vertex " << v;
      }
    }
    for (int k = 0; k < 20; ++k) {
      CharacterPose pose;
      ASSERT_TRUE(pose.set(scene.character, pose_within(random, scene)));
      for (std::uint32_t v = 0; v < original.vertex_count(); ++v)
        ASSERT_LE((posed(scene.character, pose, v, result->weights.of(v)) -
                   posed(scene.character, pose, v, original.of(v)))
                      .norm(),
                  result->bound[v] + 1e-6);
    }
  }
}

/// A tube of which one vertex has the given weights.
SkinnedScene tube_with(std::uint32_t vertex, const std::vector<Influence>& influences) {
  SkinnedScene scene = tube(1.0);
  Mesh& mesh = scene.character.meshes[0];
  const SkinWeights old = mesh.weights;
  mesh.weights = {};
  for (std::uint32_t v = 0; v < mesh.vertex_count(); ++v)
    mesh.weights.append(v == vertex ? std::span<const Influence>(influences) : old.of(v));
  return scene;
}

TEST(CertifiedInfluences, weight_goes_to_the_bone_that_moves_alike) {
  SkinnedScene scene = tube_with(3, {{0, 0.4f}, {2, 0.35f}, {3, 0.25f}});
  scene.limits.of_bone[3].angle = 0;  // bone 3 moves as bone 2 does
  InfluenceBudget budget;
  budget.maximum_error = 1e-6;
  const auto result = certified_influences(scene.character, scene.bind, scene.tree(), 0, budget);
  ASSERT_TRUE(result) << result.error().text();
  const auto chosen = result->weights.of(3);
  ASSERT_EQ(chosen.size(), 2u) << "the two largest alone, divided by their sum, move away";
  EXPECT_EQ(chosen[0].slot, 2u);
  EXPECT_NEAR(chosen[0].weight, 0.6, 1e-6);
  EXPECT_NEAR(chosen[1].weight, 0.4, 1e-6);
  EXPECT_LE(result->bound[3], 1e-6);
}

TEST(CertifiedInfluences, bounds_are_refined_before_influences_are_added) {
  const SkinnedScene scene = tube(1.0);
  const SkinWeights& original = scene.character.meshes[0].weights;
  int refined_ones = 0;
  for (std::uint32_t v = 0; v < original.vertex_count() && refined_ones < 3; ++v) {
    std::vector<Influence> cut(original.of(v).begin(), original.of(v).end());
    if (cut.size() < 3) continue;
    cut.resize(prune_influences(cut, 1));
    const double coarse = bound_of_change(scene, v, cut), fine = bound_of_change(scene, v, cut, 1);
    if (!(fine < coarse * (1 - 1e-4))) continue;
    ++refined_ones;
    InfluenceBudget budget;
    budget.maximum_error = 0.5 * (coarse + fine);
    const auto result = certified_influences(scene.character, scene.bind, scene.tree(), 0, budget);
    ASSERT_TRUE(result);
    EXPECT_EQ(result->weights.of(v).size(), 1u);
    EXPECT_LE(result->bound[v], budget.maximum_error);
  }
  EXPECT_GT(refined_ones, 0);
}

TEST(CertifiedInfluences, have_no_bound_if_weight_crosses_a_slide_without_range) {
  const float weight = static_cast<float>(32768.13 / 65535);  // 2e-6 from what 16 bits can hold
  SkinnedScene scene = tube_with(3, {{0, weight}, {3, 1.0f - weight}});
  scene.limits.of_bone[3].slide_radius = std::numeric_limits<double>::infinity();
  InfluenceBudget budget;
  budget.maximum_error = 0.01;
  budget.bits = {16};
  const auto rounded = certified_influences(scene.character, scene.bind, scene.tree(), 0, budget);
  ASSERT_TRUE(rounded);
  EXPECT_FALSE(std::isfinite(rounded->bound[3])) << "a slide of 10 km moves the vertex by 2 cm";
  budget.bits = {32};
  const auto kept = certified_influences(scene.character, scene.bind, scene.tree(), 0, budget);
  ASSERT_TRUE(kept);
  EXPECT_LE(kept->bound[3], 1e-9);
}

TEST(SkinRows, report_what_was_divided) {
  SkinnedScene scene = tube(std::numbers::pi);
  Mesh& mesh = scene.character.meshes[0];
  const std::uint32_t count = mesh.vertex_count();
  std::vector<Influence> copy(mesh.weights.of(7).begin(), mesh.weights.of(7).end());
  for (Influence& influence : copy) influence.weight *= 1 + 1e-5f;
  mesh.positions.push_back(Vec3f(mesh.positions[7]));
  mesh.weights.append(copy);
  SkinDifferences rows;
  const VertexShare shares[] = {{count, 1}, {7, -1}};
  ASSERT_TRUE(append_difference(scene.character, scene.bind, 0, shares, rows));
  const auto certificate = certify_deviation(scene.tree(), rows);
  ASSERT_TRUE(certificate);
  EXPECT_TRUE(certificate->gaps.empty());
  EXPECT_LT(certificate->maximum, 1e-6);
  EXPECT_NEAR(certificate->sum_residual, 1e-5, 2e-7) << "skinning does not divide";
}

TEST(CertifiedInfluences, integers_sum_to_the_whole) {
  const SkinnedScene scene = tube(1.0);
  for (const std::uint32_t bits : {8u, 16u}) {
    InfluenceBudget budget;
    budget.maximum_error = 1;
    budget.bits = {bits};
    const auto result = certified_influences(scene.character, scene.bind, scene.tree(), 0, budget);
    ASSERT_TRUE(result);
    const double whole = bits == 8 ? 255 : 65535;
    for (std::uint32_t v = 0; v < result->weights.vertex_count(); ++v) {
      double sum = 0;
      for (const Influence& influence : result->weights.of(v))
        sum += std::round(static_cast<double>(influence.weight) * whole);
      EXPECT_EQ(sum, whole);
      EXPECT_EQ(result->bits[v], bits);
    }
  }
}

TEST(CertifiedInfluences, no_error_keeps_everything_and_much_keeps_one) {
  const SkinnedScene scene = tube(1.0);
  InfluenceBudget budget;
  budget.maximum_error = 0;
  auto result = certified_influences(scene.character, scene.bind, scene.tree(), 0, budget);
  ASSERT_TRUE(result);
  EXPECT_EQ(result->maximum, 0.0);
  EXPECT_EQ(result->weights.influences.size(), scene.character.meshes[0].weights.influences.size());
  budget.maximum_error = 100;
  result = certified_influences(scene.character, scene.bind, scene.tree(), 0, budget);
  ASSERT_TRUE(result);
  EXPECT_EQ(result->weights.influences.size(), scene.character.meshes[0].vertex_count());
  budget.maximum_error = 0;
  budget.most_influences = 1;
  result = certified_influences(scene.character, scene.bind, scene.tree(), 0, budget);
  ASSERT_TRUE(result);
  EXPECT_GT(result->above_maximum_error, 0u);
  EXPECT_GT(result->maximum, 0.0);
}

TEST(CertifiedInfluences, faults_of_the_input_are_named) {
  const SkinnedScene scene = tube(1.0);
  const auto code = [&](std::uint32_t mesh, const InfluenceBudget& budget) {
    return certified_influences(scene.character, scene.bind, scene.tree(), mesh, budget)
        .error()
        .code();
  };
  InfluenceBudget budget;
  EXPECT_EQ(code(1, budget), StatusCode::index_out_of_range);
  budget.bits = {12};
  EXPECT_EQ(code(0, budget), StatusCode::invalid_argument);
  budget.bits = {};
  EXPECT_EQ(code(0, budget), StatusCode::invalid_argument);
  budget = {};
  budget.maximum_error = -1;
  EXPECT_EQ(code(0, budget), StatusCode::invalid_argument);
  SkinDifferences rows;
  const VertexShare beyond[] = {{100'000, 1}};
  EXPECT_EQ(append_difference(scene.character, scene.bind, 0, beyond, rows).code(),
            StatusCode::index_out_of_range);
  EXPECT_EQ(append_difference(scene.character, {}, 0, {}, rows).code(), StatusCode::size_mismatch);
  EXPECT_EQ(rows.first.size(), 1u);
}

}  // namespace
}  // namespace sunder
