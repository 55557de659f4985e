// The lips and pieces that the page of `sunder view` colours, found from two models alone, against
// what the model that was torn knows of itself.

#include <sunder/tear/topology.h>
#include <sunder/tear/torn_model.h>

#include <algorithm>
#include <array>
#include <memory>
#include <set>
#include <vector>

#include <gtest/gtest.h>

#include "support/machine/random.h"
#include "support/models/random_operations.h"
#include "support/models/rigs.h"
#include "tools/picture/rims.h"
#include "tools/view_page/torn_section.h"

namespace sunder::test {
namespace {

using Edges = std::set<std::array<Index, 2>>;

/// Number of the first vertex of each mesh, as if all were one array.
std::vector<Index> first_vertices(const Character& character) {
  std::vector<Index> first = {0};
  for (const Mesh& mesh : character.meshes) first.push_back(first.back() + mesh.vertex_count());
  return first;
}

Edges rims_of(const TornModel& model) {
  const std::vector<Index> first = first_vertices(model.character());
  Edges edges;
  for (const tools::RimEdge& edge : tools::find_rims(model))
    edges.insert({first[edge.mesh] + edge.a, first[edge.mesh] + edge.b});
  return edges;
}

/// The sides of all triangles of walls and caps, which are no rims but may be open.
Edges filling_edges(const TornModel& model) {
  const std::vector<Index> first = first_vertices(model.character());
  Edges edges;
  for (Index m = 0; m < model.character().meshes.size(); ++m) {
    const std::vector<Triangle>& triangles = model.character().meshes[m].triangles;
    for (Index t = 0; t < triangles.size(); ++t)
      for (std::size_t i = 0; i < 3; ++i)
        if (model.source_triangle(m, t) >= model.source().meshes[m].triangle_count())
          edges.insert({first[m] + triangles[t][i], first[m] + triangles[t][(i + 1) % 3]});
  }
  return edges;
}

Index components_of(const Character& character) { return count_topology(character)->components; }

/// A tube and triangles at some of its places that are no part of it, because they have other
/// weights.
Character make_tube_with_loose_triangles() {
  Character character = make_tube(6, 8, 3);
  Mesh& mesh = character.meshes[0];
  for (const std::uint32_t t : {0u, 11u, 30u}) {
    const Triangle copied = mesh.triangles[t];
    Triangle loose;
    for (std::size_t corner = 0; corner < 3; ++corner) {
      loose[corner] = mesh.vertex_count();
      const std::uint32_t vertex = copied[corner];
      mesh.positions.push_back(mesh.positions[vertex]);
      if (!mesh.normals.empty()) mesh.normals.push_back(mesh.normals[vertex]);
      if (!mesh.tangents.empty()) mesh.tangents.push_back(mesh.tangents[vertex]);
      for (auto& set : mesh.uv_sets) set.push_back(set[vertex]);
      for (auto& set : mesh.color_sets) set.push_back(set[vertex]);
      for (MorphTarget& target : mesh.morph_targets)
        for (auto* const deltas :
             {&target.position_deltas, &target.normal_deltas, &target.tangent_deltas})
          if (!deltas->empty()) deltas->push_back((*deltas)[vertex]);
      const Influence whole{2, 1.0f};
      mesh.weights.append({&whole, 1});
    }
    mesh.triangles.push_back(loose);
    mesh.triangle_submesh.push_back(0);
  }
  return character;
}

TEST(TornParts, a_model_beside_itself_has_none) {
  EXPECT_EQ(components_of(make_tube_with_loose_triangles()), 4u);
  for (const Character& character : {make_sheet(6), make_tube(6, 8, 3), make_two_tubes(5, 7),
                                     make_tube_with_loose_triangles()}) {
    const auto parts = tools::find_torn_parts(character, character);
    ASSERT_TRUE(parts) << parts.error().text();
    EXPECT_TRUE(parts->lips.empty());
    EXPECT_EQ(parts->pieces, 0u);
  }
}

TEST(TornParts, lips_and_pieces_are_those_of_the_model_that_was_torn) {
  std::size_t lips = 0, pieces = 0;
  for (std::uint32_t seed = 1; seed <= 40; ++seed) {
    Random random(seed);
    auto model = TornModel::create(std::make_shared<Character>(random_character(random)));
    ASSERT_TRUE(model);
    for (int i = 0; i < 4; ++i) ASSERT_TRUE(play(*model, random_operation(*model, random)));
    const auto parts = tools::find_torn_parts(model->source(), model->character());
    ASSERT_TRUE(parts) << parts.error().text();
    Edges lips_of_surface;
    const Edges of_filling = filling_edges(*model);
    for (const auto& lip : parts->lips)
      if (!of_filling.contains(lip)) lips_of_surface.insert(lip);
    EXPECT_EQ(lips_of_surface, rims_of(*model)) << seed;
    ASSERT_EQ(components_of(model->source()), 1u);
    EXPECT_EQ(parts->pieces + 1, components_of(model->character())) << seed;
    const auto& numbers = parts->piece_of_vertex;
    const std::set<std::uint16_t> used(numbers.begin(), numbers.end());
    EXPECT_EQ(used.size(), parts->pieces + 1) << seed << ": each piece has vertices";
    lips += parts->lips.size();
    pieces += parts->pieces;
  }
  EXPECT_GT(lips, 500u);
  EXPECT_GT(pieces, 10u);
}

}  // namespace
}  // namespace sunder::test
