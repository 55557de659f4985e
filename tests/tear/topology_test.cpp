#include <sunder/tear/topology.h>

#include <gtest/gtest.h>

#include "support/models/rigs.h"

namespace sunder {
namespace {

/// Triangles on one rigid bone, each corner with its own vertex, so that they are joined only by
/// position.
Character make_soup(const std::vector<std::array<Vec3f, 3>>& triangles) {
  Character character = test::make_sheet(1);
  Mesh mesh;
  mesh.name = "soup";
  mesh.submeshes.push_back({"soup", kNone});
  const Influence rigid[] = {{0, 1.0f}};
  for (const auto& corners : triangles) {
    mesh.triangles.push_back(
        {mesh.vertex_count(), mesh.vertex_count() + 1, mesh.vertex_count() + 2});
    mesh.triangle_submesh.push_back(0);
    for (const Vec3f& corner : corners) {
      mesh.positions.push_back(corner);
      mesh.weights.append(rigid);
    }
  }
  character.meshes = {mesh};
  EXPECT_TRUE(validate_character(character));
  return character;
}

const Vec3f kA(0, 0, 0), kB(1, 0, 0), kC(0, 1, 0), kD(0, 0, 1), kE(1, 1, 1);

TEST(Topology, an_open_sheet_has_one_border) {
  const TopologyCounts counts = *count_topology(test::make_sheet(5));
  EXPECT_EQ(counts.points, 36u);
  EXPECT_EQ(counts.triangles, 50u);
  EXPECT_EQ(counts.boundary_edges, 20u);
  EXPECT_EQ(counts.boundary_loops, 1u);
  EXPECT_EQ(counts.components, 1u);
  EXPECT_EQ(counts.points - counts.edges + counts.triangles, 1u) << "a disc";
}

TEST(Topology, seams_hard_edges_and_submeshes_do_not_count_as_borders) {
  const TopologyCounts counts = *count_topology(test::make_tube(6, 8, 3));
  EXPECT_LT(counts.points, counts.vertices);
  EXPECT_EQ(counts.boundary_edges, 0u);
  EXPECT_EQ(counts.components, 1u);
  EXPECT_EQ(counts.points - counts.edges + counts.triangles, 2u) << "a sphere";
}

TEST(Topology, meshes_of_one_skin_are_one_surface) {
  Character character = test::make_tube(6, 8, 3);
  Mesh caps = character.meshes[0];
  Mesh& side = character.meshes[0];
  for (Mesh* mesh : {&side, &caps}) {
    const std::uint32_t kept = mesh == &caps ? 1 : 0;
    std::vector<Triangle> triangles;
    for (std::uint32_t t = 0; t < mesh->triangle_count(); ++t)
      if (mesh->triangle_submesh[t] == kept) triangles.push_back(mesh->triangles[t]);
    mesh->triangles = triangles;
    mesh->triangle_submesh.assign(triangles.size(), kept);
  }
  character.meshes.push_back(caps);
  EXPECT_EQ(count_topology(character)->boundary_edges, 0u);
  character.meshes[1].skin = 1;
  character.skins.push_back(character.skins[0]);
  EXPECT_GT(count_topology(character)->boundary_edges, 0u)
      << "what another skin moves is another surface";
}

TEST(Topology, coincident_points_with_other_weights_sides_or_morphs_are_separate) {
  const auto borders_after = [](auto change) {
    Character character = test::make_tube(6, 8, 3);
    change(character.meshes[0]);
    return count_topology(character)->boundary_edges;
  };
  const std::uint32_t first = 0, last = 8;  // the two ends of the first ring, at the seam
  EXPECT_EQ(borders_after([](Mesh&) {}), 0u);
  EXPECT_GT(borders_after([&](Mesh& mesh) { mesh.morph_targets[0].position_deltas[last] *= 2.0f; }),
            0u);
  EXPECT_GT(borders_after([&](Mesh& mesh) {
              mesh.custom_attributes.push_back(
                  {kTearSideAttribute, 1, false, std::vector<float>(mesh.vertex_count(), 0.0f)});
              mesh.custom_attributes[0].values[first] = 1.0f;
            }),
            0u);
  EXPECT_GT(borders_after([&](Mesh& mesh) {
              for (std::uint32_t i = mesh.weights.first[last]; i < mesh.weights.first[last + 1];
                   ++i)
                mesh.weights.influences[i].slot = 2 - mesh.weights.influences[i].slot;
            }),
            0u);
}

TEST(Topology, edges_of_three_faces_or_of_two_that_disagree_are_not_manifold) {
  EXPECT_EQ(count_topology(make_soup({{kA, kB, kC}, {kB, kA, kD}}))->non_manifold_edges, 0u);
  EXPECT_EQ(
      count_topology(make_soup({{kA, kB, kC}, {kB, kA, kD}, {kA, kB, kE}}))->non_manifold_edges,
      1u);
  const TopologyCounts flipped = *count_topology(make_soup({{kA, kB, kC}, {kA, kB, kD}}));
  EXPECT_EQ(flipped.non_manifold_edges, 1u);
  EXPECT_EQ(flipped.components, 2u);
}

TEST(Topology, faces_that_share_their_vertices_stay_together_on_an_edge_of_many) {
  Character character = make_soup({{kA, kB, kC}, {kB, kA, kD}, {kA, kB, kE}, {kB, kA, -kE}});
  Mesh& mesh = character.meshes[0];
  mesh.triangles[1] = {mesh.triangles[0][1], mesh.triangles[0][0], mesh.triangles[1][2]};
  mesh.triangles[3] = {mesh.triangles[2][1], mesh.triangles[2][0], mesh.triangles[3][2]};
  EXPECT_EQ(count_topology(character)->components, 2u);
}

TEST(Topology, surfaces_that_touch_in_a_point_are_separate) {
  const TopologyCounts counts = *count_topology(make_soup({{kA, kB, kC}, {kA, kD, -kE}}));
  EXPECT_EQ(counts.components, 2u);
  EXPECT_EQ(counts.points, 6u) << "the shared place is a point of each";
  EXPECT_EQ(counts.boundary_loops, 2u);
}

TEST(Topology, degenerate_triangles_are_counted_and_join_nothing) {
  const TopologyCounts counts =
      *count_topology(make_soup({{kA, kB, kC}, {kA, kB, kB}, {kA, kB, 0.5f * kB}}));
  EXPECT_EQ(counts.degenerate_triangles, 2u);
}

TEST(Topology, retired_triangles_and_vertices_used_only_by_them_do_not_count) {
  Character character = make_soup({{kA, kB, kC}, {kB, kA, kD}, {kE, 2 * kE, 3 * kD}});
  const TopologyCounts before = *count_topology(character);
  EXPECT_EQ(before.points, 7u);
  for (const std::uint32_t t : {1u, 2u})
    character.meshes[0].triangles[t].fill(character.meshes[0].triangles[t][0]);
  const TopologyCounts after = *count_topology(character);
  EXPECT_EQ(after.vertices, before.vertices);
  EXPECT_EQ(after.points, 3u);
  EXPECT_EQ(after.triangles, 1u);
  EXPECT_EQ(after.edges, 3u);
  EXPECT_EQ(after.boundary_edges, 3u);
  EXPECT_EQ(after.components, 1u);
  EXPECT_EQ(after.degenerate_triangles, 0u);
}

TEST(Topology, vertices_that_no_triangle_uses_are_no_points) {
  Character character = make_soup({{kA, kB, kC}, {kA, kE, kE}});
  EXPECT_EQ(count_topology(character)->points, 4u) << "degenerate triangles have points";
  character.meshes[0].triangles.pop_back();
  character.meshes[0].triangle_submesh.pop_back();
  EXPECT_EQ(count_topology(character)->points, 3u);
  EXPECT_EQ(count_topology(character)->vertices, 6u);
}

/// The character with the triangles of its first mesh dealt out to meshes that share vertices, or
/// to those of several skins, which share none.
Character dealt_out(const Character& character, std::uint32_t mesh_count, bool have_own_skins,
                    test::Random& random) {
  Character result = character;
  const Mesh all = character.meshes[0];
  result.meshes.clear();
  for (std::uint32_t m = 0; m < mesh_count; ++m) {
    Mesh& mesh = result.meshes.emplace_back(all);
    mesh.triangles.clear();
    mesh.triangle_submesh.clear();
    if (!have_own_skins) continue;
    mesh.skin = static_cast<std::uint32_t>(result.skins.size());
    result.skins.push_back(character.skins[all.skin]);
  }
  for (std::uint32_t t = 0; t < all.triangle_count(); ++t) {
    Mesh& mesh = result.meshes[random.index(mesh_count)];
    mesh.triangles.push_back(all.triangles[t]);
    mesh.triangle_submesh.push_back(all.triangle_submesh[t]);
  }
  return result;
}

TEST(Topology, points_of_each_mesh_are_those_of_the_mesh_alone) {
  test::Random random(5);
  for (int i = 0; i < 60; ++i) {
    const Character source = i % 3 == 0 ? test::make_soup(random) : test::make_tube(8, 6, 3);
    const Character character = dealt_out(source, 1 + random.index(4), i % 2 == 0, random);
    std::vector<std::uint32_t> points;
    const auto counts = count_topology(character, &points);
    ASSERT_TRUE(counts);
    EXPECT_EQ(counts->points, count_topology(character)->points);
    ASSERT_EQ(points.size(), character.meshes.size());
    for (std::size_t m = 0; m < points.size(); ++m) {
      Character alone = character;
      alone.meshes = {character.meshes[m]};
      EXPECT_EQ(points[m], count_topology(alone)->points) << "case " << i << ", mesh " << m;
    }
  }
}

}  // namespace
}  // namespace sunder
