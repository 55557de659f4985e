// Bones and surfaces of two characters matched, and the differences of their skins.

#include <sunder/skinning/deform.h>
#include <sunder/skinning/pose.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/internal/bone_sides.h"
#include "pipeline/validation/match/closest_on_triangle.h"
#include "pipeline/validation/match/skin_difference.h"
#include "skinning/internal/reference.h"
#include "support/models/make_model.h"
#include "support/models/random_operations.h"
#include "support/models/rigs.h"

namespace sunder::validation {
namespace {

using test::Random;

constexpr double kThirtyDegrees = 0.8660254037844387;

SurfaceMatches match(const Character& from, const Character& to, double share = 0.05) {
  const BindSurface a = make_bind_surface(from), b = make_bind_surface(to);
  return match_surfaces(a, b, {share * b.diagonal, kThirtyDegrees});
}

Skeleton skeleton_of(const std::vector<std::string>& names) {
  Skeleton skeleton;
  for (const std::string& name : names) {
    Bone bone;
    bone.name = name;
    bone.parent = skeleton.bones.empty() ? kNone : static_cast<Index>(skeleton.bones.size() - 1);
    skeleton.bones.push_back(bone);
  }
  return skeleton;
}

// ---- Bones

TEST(BoneMatching, equal_names_are_found_in_any_order) {
  const auto match =
      match_bones(skeleton_of({"hip", "arm.L", "arm.R"}), skeleton_of({"arm.R", "hip", "arm.L"}));
  ASSERT_TRUE(match);
  EXPECT_EQ(match->source_of_target, (std::vector<Index>{2, 0, 1}));
  EXPECT_EQ(match->count(BoneMatchKind::exact), 3u);
  EXPECT_EQ(match->target_of_source, (std::vector<Index>{1, 2, 0}));
}

TEST(BoneMatching, names_of_other_programs_are_fuzzy) {
  const auto match = match_bones(skeleton_of({"mixamorig:Hips", "mixamorig:LeftForeArm",
                                              "mixamorig:RightForeArm", "mixamorig:Spine1"}),
                                 skeleton_of({"hips", "fore_arm.R", "Forearm_L", "spine.1"}));
  ASSERT_TRUE(match);
  EXPECT_EQ(match->source_of_target, (std::vector<Index>{0, 2, 1, 3}));
  EXPECT_EQ(match->count(BoneMatchKind::fuzzy), 4u);
}

TEST(BoneMatching, ambiguous_names_are_not_guessed) {
  const auto match = match_bones(skeleton_of({"arm", "Leg"}), skeleton_of({"Arm", "ARM", "leg"}));
  ASSERT_TRUE(match);
  EXPECT_EQ(match->source_of_target, (std::vector<Index>{kNone, kNone, 1}));
}

TEST(BoneMatching, left_is_never_taken_for_right) {
  const auto match = match_bones(skeleton_of({"arm.L", "leg.R"}), skeleton_of({"Arm_R", "Leg_R"}));
  ASSERT_TRUE(match);
  EXPECT_EQ(match->source_of_target, (std::vector<Index>{kNone, 1}));
  EXPECT_EQ(side_of_name("mixamorig:LeftArm"), -1);
  EXPECT_EQ(side_of_name("upper_arm.R.001"), 1);
  EXPECT_EQ(side_of_name("Pelvis"), 0);
  EXPECT_EQ(side_of_name("Bright"), 0);
}

TEST(BoneMatching, given_pairs_come_first_and_must_exist) {
  const Skeleton source = skeleton_of({"a", "b"}), target = skeleton_of({"b", "x"});
  const auto match = match_bones(source, target, std::vector<BoneNames>{{"b", "a"}, {"x", "b"}});
  ASSERT_TRUE(match);
  EXPECT_EQ(match->source_of_target, (std::vector<Index>{0, 1}));
  EXPECT_EQ(match->count(BoneMatchKind::mapping), 2u);
  const auto unknown = match_bones(source, target, std::vector<BoneNames>{{"b", "nobody"}});
  ASSERT_FALSE(unknown);
  EXPECT_EQ(unknown.error().code(), StatusCode::not_found);
  const auto twice = match_bones(source, target, std::vector<BoneNames>{{"b", "a"}, {"b", "b"}});
  ASSERT_FALSE(twice);
  EXPECT_EQ(twice.error().index(), 1u);
}

TEST(BoneMatching, a_bone_without_counterpart_moves_with_its_ancestor) {
  const auto match = match_bones(skeleton_of({"hip", "spine"}),
                                 skeleton_of({"armature", "hip", "twist", "spine", "bow"}));
  ASSERT_TRUE(match);
  EXPECT_EQ(match->driver_of_target, (std::vector<Index>{0, 0, 0, 1, 1}));
}

// ---- Surfaces

TEST(ClosestOnTriangle, agrees_with_a_search_over_the_triangle) {
  Random random(3);
  for (int i = 0; i < 300; ++i) {
    const Vec3d a = random.direction(), b = random.direction(), c = random.direction(),
                p = 2 * random.direction();
    const PlaceOnTriangle place = closest_on_triangle(p, a, b, c);
    double sum = 0;
    for (const double part : place.barycentric) {
      EXPECT_GE(part, 0);
      sum += part;
    }
    EXPECT_NEAR(sum, 1, 1e-12);
    constexpr int kSteps = 60;
    for (int u = 0; u <= kSteps; ++u)
      for (int v = 0; u + v <= kSteps; ++v) {
        const Vec3d at = (a * u + b * v + c * (kSteps - u - v)) / kSteps;
        EXPECT_GE((at - p).norm(), place.distance - 1e-12);
      }
  }
}

TEST(SurfaceMatching, a_model_matches_itself_completely) {
  for (const Character& character :
       {test::make_tube(8, 12, 4), test::make_two_tubes(4, 6), test::make_bumpy_ball(500)}) {
    const SurfaceMatches matches = match(character, character);
    EXPECT_EQ(matches.counts.coincident, matches.matches.size());
    EXPECT_EQ(matches.counts.accepted, matches.matches.size());
    for (Index m = 0; m < character.meshes.size(); ++m)
      for (Index v = 0; v < character.meshes[m].vertex_count(); ++v) {
        const SurfaceMatch& found = matches.of(m, v);
        ASSERT_EQ(found.mesh, m);
        const Triangle& triangle = character.meshes[m].triangles[found.triangle];
        const auto corner = std::ranges::find(found.barycentric, 1.0) - found.barycentric.begin();
        EXPECT_EQ(character.meshes[m].positions[triangle[corner]],
                  character.meshes[m].positions[v]);
        EXPECT_NEAR(found.cosine, 1, 1e-9);
      }
  }
}

TEST(SurfaceMatching, the_closest_place_is_that_of_a_search_over_all_triangles) {
  Random random(7);
  for (int i = 0; i < 10; ++i) {
    const Character source = test::make_bumpy_ball(200 + random.index(300));
    Character target = test::make_bumpy_ball(150);
    for (Vec3f& position : target.meshes[0].positions)
      position = (position * static_cast<float>(random.uniform(0.8, 1.3))).eval();
    const BindSurface surface = make_bind_surface(source), of = make_bind_surface(target);
    const SurfaceMatches matches = match_surfaces(of, surface, {1.0, -1});
    for (Index v = 0; v < of.vertex_count(); ++v) {
      double least = 1e9;
      for (const auto& [a, b, c] : surface.triangles)
        least = std::min(least, closest_on_triangle(of.positions[v], surface.positions[a],
                                                    surface.positions[b], surface.positions[c])
                                    .distance);
      EXPECT_GE(matches.matches[v].distance, least - 1e-12);
      EXPECT_LE(matches.matches[v].distance, least + 2.1e-7 * surface.diagonal);
    }
  }
}

TEST(SurfaceMatching, far_and_turned_places_are_told_apart) {
  const Character source = test::make_sheet(4);
  Character target = source;
  for (Vec3f& position : target.meshes[0].positions) position.z() += 0.01f;
  EXPECT_EQ(match(target, source).counts.accepted, target.meshes[0].vertex_count());
  EXPECT_EQ(match(target, source, 0.001).counts.too_far, target.meshes[0].vertex_count());
  for (Triangle& triangle : target.meshes[0].triangles) std::swap(triangle[0], triangle[1]);
  EXPECT_EQ(match(target, source).counts.turned_away, target.meshes[0].vertex_count());
  const BindSurface a = make_bind_surface(target), b = make_bind_surface(source);
  EXPECT_EQ(match_surfaces(a, b, {0.1, kThirtyDegrees, true}).counts.accepted,
            target.meshes[0].vertex_count());
}

TEST(SurfaceMatching, two_sheets_back_to_back_keep_to_their_own_sides) {
  Character character = test::make_sheet(4);
  Mesh& mesh = character.meshes[0];
  const Index count = mesh.vertex_count();
  const std::vector<Triangle> front = mesh.triangles;
  for (Index v = 0; v < count; ++v) {
    mesh.positions.push_back(mesh.positions[v]);
    mesh.normals.push_back(-mesh.normals[v]);
    mesh.uv_sets[0].push_back(mesh.uv_sets[0][v]);
    const std::vector<Influence> back = {{0, 1.0f}};
    mesh.weights.append(back);
  }
  for (const Triangle& triangle : front) {
    mesh.triangles.push_back({count + triangle[1], count + triangle[0], count + triangle[2]});
    mesh.triangle_submesh.push_back(0);
  }
  ASSERT_TRUE(validate_character(character));
  const SurfaceMatches matches = match(character, character);
  for (Index v = 0; v < 2 * count; ++v) {
    EXPECT_NEAR(matches.matches[v].cosine, 1, 1e-9);
    EXPECT_EQ(matches.matches[v].triangle < front.size(), v < count) << v;
  }
}

TEST(SurfaceMatching, degenerate_and_retired_triangles_are_never_matched) {
  Character character = test::make_sheet(3);
  Mesh& mesh = character.meshes[0];
  mesh.triangles.insert(mesh.triangles.begin(), {{0, 0, 0}, {0, 1, 1}, {0, 1, 2}});
  mesh.triangle_submesh.assign(mesh.triangles.size(), 0);
  const SurfaceMatches matches = match(test::make_sheet(7), character);
  for (const SurfaceMatch& found : matches.matches) {
    EXPECT_GE(found.triangle, 3u);
    EXPECT_TRUE(std::isfinite(found.distance) && std::isfinite(found.cosine));
  }
  mesh.triangles.resize(3);
  mesh.triangle_submesh.resize(3);
  const SurfaceMatches none = match(test::make_sheet(7), character);
  EXPECT_EQ(none.counts.impossible, none.matches.size());
}

TEST(SurfaceMatching, soups_give_finite_matches) {
  Random random(11);
  for (int i = 0; i < 60; ++i) {
    const Character a = test::make_soup(random), b = test::make_soup(random);
    for (const SurfaceMatch& found : match(a, b).matches) {
      if (found.mesh == kNone) continue;
      EXPECT_TRUE(std::isfinite(found.distance) && std::isfinite(found.cosine));
      EXPECT_NEAR(std::accumulate(found.barycentric.begin(), found.barycentric.end(), 0.0), 1,
                  1e-9);
    }
  }
}

TEST(SurfaceMatching, births_agree_with_the_closest_places) {
  Random random(5);
  int torn = 0;
  for (int i = 0; i < 20; ++i) {
    TornModel model = test::make_model(test::random_character(random));
    for (int k = 0; k < 3; ++k) {
      const auto report = test::play(model, test::random_operation(model, random));
      ASSERT_TRUE(report) << report.error().text();
    }
    const SurfaceMatches by_birth = matches_from_births(model);
    const BindSurface surface = make_bind_surface(model.character());
    const BindSurface source = make_bind_surface(model.source());
    ASSERT_EQ(by_birth.matches.size(), surface.positions.size());
    torn += by_birth.matches.size() > source.positions.size();
    for (Index v = 0; v < surface.vertex_count(); ++v) {
      const SurfaceMatch& match = by_birth.matches[v];
      if (!match.is_accepted) continue;
      Vec3d place = Vec3d::Zero();
      const Triangle& triangle =
          source.triangles[source.first_triangle[match.mesh] + match.triangle];
      for (std::size_t k = 0; k < 3; ++k)
        place += match.barycentric[k] * source.positions[triangle[k]];
      EXPECT_NEAR((place - surface.positions[v]).norm(), 0, 1e-6 * source.diagonal);
    }
  }
  EXPECT_GT(torn, 10);
}

// ---- Differences of skins

/// The posed difference of a row.
Vec3d posed(const SkinDifferences& differences, Index row, const Character& source,
            const ModelPose& pose) {
  const ModelPose bind = *bind_pose(source);
  Vec3d sum = Vec3d::Zero();
  for (Index i = differences.first[row]; i < differences.first[row + 1]; ++i) {
    const SkinTerm& term = differences.terms[i];
    const Affine3d model_from_bind =
        pose.model_from_bone[term.bone] * bind.model_from_bone[term.bone].inverse();
    sum += model_from_bind.linear() * term.x + term.m * model_from_bind.translation();
  }
  return sum;
}

TEST(SkinDifference, equal_skins_have_no_term) {
  for (const Character& character :
       {test::make_tube(8, 12, 4), test::make_two_tubes(4, 6), test::make_bumpy_ball(500)}) {
    const auto bones = match_bones(character.skeleton, character.skeleton);
    ASSERT_TRUE(bones);
    const SkinDifferences differences =
        difference_of(character, character, match(character, character),
                      make_driven_skins(character, character, *bones));
    EXPECT_TRUE(differences.terms.empty());
    EXPECT_EQ(differences.first.back(), 0u);
  }
}

TEST(SkinDifference, posed_it_is_the_distance_from_the_source) {
  Random random(9);
  for (int i = 0; i < 10; ++i) {
    const Character source = test::make_tube(6, 8, 4);
    Character target = test::make_tube(9, 10, 4);
    // Other numbers for the same bones.
    std::swap(target.skins[0].bones[1], target.skins[0].bones[2]);
    std::swap(target.skins[0].bone_from_bind[1], target.skins[0].bone_from_bind[2]);
    for (Influence& influence : target.meshes[0].weights.influences)
      if (influence.slot == 1 || influence.slot == 2) influence.slot = 3 - influence.slot;
    const auto bones = match_bones(source.skeleton, target.skeleton);
    ASSERT_TRUE(bones);
    const SurfaceMatches matches = match(target, source, 10);
    const SkinDifferences differences =
        difference_of(source, target, matches, make_driven_skins(source, target, *bones));
    ASSERT_EQ(differences.first.size(), matches.matches.size() + 1);
    ModelPose pose = test::random_pose(source, random, 0.6, 1.0);
    pose.morph_weights.assign(pose.morph_weights.size(), 0.0f);
    const auto of_source = test::posed_positions(source, 0, pose),
               of_target = test::posed_positions(target, 0, pose);
    for (Index v = 0; v < of_target.size(); ++v) {
      const SurfaceMatch& match = matches.matches[v];
      if (!match.is_accepted) continue;
      Vec3d expected = of_target[v];
      for (std::size_t k = 0; k < 3; ++k)
        expected -= match.barycentric[k] * of_source[source.meshes[0].triangles[match.triangle][k]];
      EXPECT_NEAR((posed(differences, v, source, pose) - expected).norm(), 0, 1e-6);
      for (Index t = differences.first[v]; t + 1 < differences.first[v + 1]; ++t)
        EXPECT_LT(differences.terms[t].bone, differences.terms[t + 1].bone);
    }
  }
}

TEST(SkinDifference, a_stale_bind_matrix_shows) {
  const Character source = test::make_tube(6, 8, 4);
  Character target = source;
  target.skins[0].bone_from_bind[2].translation().x() += 0.1f;
  const auto bones = match_bones(source.skeleton, target.skeleton);
  ASSERT_TRUE(bones);
  const SurfaceMatches matches = match(target, source);
  EXPECT_EQ(matches.counts.accepted, matches.matches.size());
  const SkinDifferences differences =
      difference_of(source, target, matches, make_driven_skins(source, target, *bones));
  for (Index v = 0; v < matches.matches.size(); ++v) {
    double weight = 0;
    for (const Influence& influence : target.meshes[0].weights.of(v))
      if (influence.slot == 2) weight += static_cast<double>(influence.weight);
    EXPECT_EQ(differences.first[v + 1] > differences.first[v], weight > 0);
    EXPECT_NEAR(posed(differences, v, source, *bind_pose(source)).x(), 0.1 * weight, 1e-6);
  }
}

}  // namespace
}  // namespace sunder::validation
