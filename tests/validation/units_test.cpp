// Lengths of a validation are metres, whatever the unit of bind space and the rest pose.

#include <sunder/validation/validation.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <memory>
#include <set>

#include <gtest/gtest.h>

#include "support/models/rigs.h"
#include "validation/shared_character.h"

namespace sunder::test {
namespace {

/// Moves half of the larger weight of each blended vertex to the smaller one.
Character with_mixed_weights(const Character& character) {
  Character result = character;
  SkinWeights weights;
  for (Index v = 0; v < result.meshes[0].vertex_count(); ++v) {
    const auto of = result.meshes[0].weights.of(v);
    std::vector<Influence> influences(of.begin(), of.end());
    if (influences.size() > 1) {
      const float moved = 0.5f * influences[0].weight;
      influences[0].weight -= moved;
      influences[1].weight += moved;
    }
    weights.append(influences);
  }
  result.meshes[0].weights = std::move(weights);
  return result;
}

/// The same model in centimetres, below a root that scales by 0.01.
Character in_centimetres(const Character& character) {
  Character result = character;
  for (std::size_t bone = 0; bone < result.skeleton.bones.size(); ++bone) {
    BoneTransform& rest = result.skeleton.bones[bone].rest;
    if (result.skeleton.bones[bone].parent == kNone)
      rest.scale.setConstant(0.01f);
    else
      rest.translation *= 100.0f;
  }
  for (Mesh& mesh : result.meshes) {
    for (Vec3f& position : mesh.positions) position *= 100.0f;
    for (MorphTarget& morph : mesh.morph_targets)
      for (Vec3f& delta : morph.position_deltas) delta *= 100.0f;
  }
  for (Skin& skin : result.skins)
    for (Affine3f& bone_from_bind : skin.bone_from_bind) bone_from_bind.translation() *= 100.0f;
  return result;
}

double largest_of_edge(const ValidationReport& report) {
  double largest = 0.0;
  for (const PosedFigures& figures : report.posed)
    largest = std::max(largest, figures.maximum_of_edge);
  return largest;
}

std::set<std::string_view> warnings(const ValidationReport& report) {
  std::set<std::string_view> codes;
  for (const Finding& finding : report.findings)
    if (finding.severity != Severity::note) codes.insert(finding.code);
  return codes;
}

TEST(Units, a_model_in_centimetres_below_an_armature_has_the_figures_of_one_in_metres) {
  Character metres = make_tube(16, 12, 4);
  metres.clips.clear();
  const Character centimetres = in_centimetres(metres);
  const auto a = validate_skin(share(metres), share(with_mixed_weights(metres)));
  const auto b = validate_skin(share(centimetres), share(with_mixed_weights(centimetres)));
  ASSERT_TRUE(a && b);
  EXPECT_NEAR(a->metres_per_bind_unit, 1.0, 1e-6);
  EXPECT_NEAR(b->metres_per_bind_unit, 0.01, 1e-8);
  EXPECT_NEAR(b->diagonal, a->diagonal, 1e-5 * a->diagonal);
  ASSERT_GT(largest_of_edge(*a), 0.1);
  EXPECT_NEAR(largest_of_edge(*b), largest_of_edge(*a), 1e-4 * largest_of_edge(*a));
  for (std::size_t i = 0; i < a->posed.size(); ++i)
    EXPECT_NEAR(b->posed[i].maximum, a->posed[i].maximum, 1e-4 * a->posed[i].maximum);
  // Stretch, turned faces and collapse do not depend on the unit either.
  EXPECT_EQ(warnings(*a), warnings(*b));
  EXPECT_TRUE(warnings(*a).contains("SUNDER_W_STRETCH"));
}

/// The mean length of the edges at each vertex, with vertices at one place as one point.
std::vector<double> mean_edges(const Mesh& mesh) {
  using Place = std::array<float, 3>;
  const auto place = [&](Index v) {
    const Vec3f& p = mesh.positions[v];
    return Place{p.x(), p.y(), p.z()};
  };
  std::map<Place, std::set<Place>> neighbours;
  for (const Triangle& triangle : mesh.triangles)
    for (std::size_t k = 0; k < 3; ++k) {
      neighbours[place(triangle[k])].insert(place(triangle[(k + 1) % 3]));
      neighbours[place(triangle[(k + 1) % 3])].insert(place(triangle[k]));
    }
  std::vector<double> means;
  for (Index v = 0; v < mesh.vertex_count(); ++v) {
    double sum = 0.0;
    for (const Place& other : neighbours[place(v)])
      sum += static_cast<double>((Vec3f(other[0], other[1], other[2]) - mesh.positions[v]).norm());
    means.push_back(sum / static_cast<double>(neighbours[place(v)].size()));
  }
  return means;
}

TEST(Units, a_rest_pose_that_is_not_bind_does_not_change_the_length_of_edges) {
  Character curled = make_tube(16, 12, 4);
  for (std::size_t bone = 1; bone < 4; ++bone)
    curled.skeleton.bones[bone].rest.rotation =
        Quatf(Eigen::AngleAxisf(1.5f, Eigen::Vector3f::UnitZ()));
  const auto report = validate_skin(share(curled), share(with_mixed_weights(curled)));
  ASSERT_TRUE(report) << report.error().text();
  EXPECT_NEAR(report->metres_per_bind_unit, 1.0, 1e-5);
  EXPECT_LT(report->diagonal, 3.5) << "the tube of 4 m is meant to be curled up at rest";
  const std::vector<double> edges = mean_edges(curled.meshes[0]);
  double expected = 0.0;
  for (std::size_t v = 0; v < edges.size(); ++v)
    expected = std::max(expected, static_cast<double>(report->vertex_deviation[v]) / edges[v]);
  ASSERT_GT(expected, 0.1);
  EXPECT_NEAR(largest_of_edge(*report), expected, 1e-5 * expected);
}

TEST(Units, distances_of_matches_are_metres) {
  Character metres = make_tube(16, 12, 4);
  metres.clips.clear();
  const auto raised = [](Character character, float by) {
    for (Vec3f& position : character.meshes[0].positions) position.x() += by;
    return character;
  };
  const Character centimetres = in_centimetres(metres);
  const auto a = validate_skin(share(metres), share(raised(metres, 0.02f)));
  const auto b = validate_skin(share(centimetres), share(raised(centimetres, 2.0f)));
  ASSERT_TRUE(a && b);
  ASSERT_GT(a->matching.target_distance, 0.01);
  EXPECT_NEAR(b->matching.target_distance, a->matching.target_distance, 1e-5);
  EXPECT_NEAR(b->matching.source_distance, a->matching.source_distance, 1e-5);
}

TEST(Units, poses_that_do_not_fill_a_block_count_once) {
  const Character source = make_tube(8, 8, 4), target = with_mixed_weights(source);
  double sum = 0.0, largest = 0.0;
  for (std::uint32_t n = 1; n <= 10; ++n) {
    ValidationOptions options;
    options.random_poses = n;
    const auto report = validate_skin(share(source), share(target), options);
    ASSERT_TRUE(report) << report.error().text();
    const PosedFigures& random = report->posed.back();
    // The poses of a smaller number are the first ones of a larger number.
    const double mean_of_last = random.mean * n - sum;
    EXPECT_GT(mean_of_last, 0.0);
    EXPECT_LE(mean_of_last, random.maximum);
    EXPECT_GE(random.maximum, largest);
    sum = random.mean * n;
    largest = random.maximum;
  }
}

}  // namespace
}  // namespace sunder::test
