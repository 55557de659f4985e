#include <sunder/skinning/skinned_mesh.h>

#include <algorithm>

#include <gtest/gtest.h>

#include "support/models/random_skin.h"
#include "support/models/rigs.h"

namespace sunder {
namespace {

TEST(VertexOrder, puts_vertices_of_the_same_bones_together_and_keeps_the_order_among_them) {
  test::Random random(1);
  const Mesh mesh = test::make_random_skin(random, {1000, 10, 3, 0, false, 10});
  const auto old_from_new = *order_for_skinning(mesh);
  const auto slots_of = [&](std::uint32_t v) {
    std::vector<std::uint32_t> slots;
    for (const Influence& influence : mesh.weights.of(v)) slots.push_back(influence.slot);
    std::sort(slots.begin(), slots.end());
    return slots;
  };
  ASSERT_EQ(old_from_new.size(), 1000u);
  for (std::size_t v = 1; v < old_from_new.size(); ++v) {
    const auto before = slots_of(old_from_new[v - 1]), here = slots_of(old_from_new[v]);
    ASSERT_TRUE(before < here || (before == here && old_from_new[v - 1] < old_from_new[v]));
  }
}

TEST(VertexOrder, renumbers_everything_that_a_vertex_has) {
  test::Random random(2);
  Character character = test::make_tube(6, 8, 4);
  Mesh& mesh = character.meshes[0];
  mesh.custom_attributes.push_back({"_PAIR", 2, true, {}});
  for (std::uint32_t i = 0; i < 2 * mesh.vertex_count(); ++i)
    mesh.custom_attributes.back().values.push_back(static_cast<float>(i));
  mesh.color_sets.emplace_back();
  for (std::uint32_t v = 0; v < mesh.vertex_count(); ++v)
    mesh.color_sets[0].emplace_back(static_cast<float>(v), 0.0f, 0.0f, 1.0f);
  ASSERT_TRUE(validate_character(character));
  const Mesh before = mesh;
  const auto order = *order_for_skinning(mesh);
  ASSERT_TRUE(reorder_vertices(mesh, order));
  EXPECT_TRUE(validate_character(character));
  for (std::uint32_t v = 0; v < mesh.vertex_count(); ++v) {
    const std::uint32_t old = order[v];
    ASSERT_EQ(mesh.positions[v], before.positions[old]);
    ASSERT_EQ(mesh.normals[v], before.normals[old]);
    ASSERT_EQ(mesh.uv_sets[0][v], before.uv_sets[0][old]);
    ASSERT_EQ(mesh.color_sets[0][v], before.color_sets[0][old]);
    for (std::uint32_t c = 0; c < 2; ++c)
      ASSERT_EQ(mesh.custom_attributes.back().values[2 * v + c],
                before.custom_attributes.back().values[2 * old + c]);
    ASSERT_EQ(mesh.morph_targets[0].position_deltas[v],
              before.morph_targets[0].position_deltas[old]);
    const auto here = mesh.weights.of(v), there = before.weights.of(old);
    ASSERT_TRUE(std::equal(here.begin(), here.end(), there.begin(), there.end()));
  }
  for (std::uint32_t t = 0; t < mesh.triangle_count(); ++t)
    for (std::size_t k = 0; k < 3; ++k)
      ASSERT_EQ(order[mesh.triangles[t][k]], before.triangles[t][k]);
}

TEST(VertexOrder, refuses_an_invalid_order) {
  test::Random random(3);
  Mesh mesh = test::make_random_skin(random, {5, 2, 2, 0, false, 2});
  const Mesh before = mesh;
  EXPECT_EQ(reorder_vertices(mesh, std::vector<std::uint32_t>{0, 1, 2, 3}).code(),
            StatusCode::size_mismatch);
  EXPECT_EQ(reorder_vertices(mesh, std::vector<std::uint32_t>{0, 1, 2, 3, 5}).code(),
            StatusCode::index_out_of_range);
  EXPECT_EQ(reorder_vertices(mesh, std::vector<std::uint32_t>{0, 1, 2, 3, 3}).code(),
            StatusCode::index_out_of_range);
  EXPECT_EQ(mesh, before);
}

}  // namespace
}  // namespace sunder
