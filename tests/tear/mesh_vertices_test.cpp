#include "tear/internal/mesh_vertices.h"

#include <map>

#include <gtest/gtest.h>

#include "support/models/rich_mesh.h"
#include "support/models/rigs.h"

namespace sunder {
namespace {

using test::rich_mesh;

TEST(Interpolate, every_attribute_is_the_barycentric_mean) {
  const Mesh source = rich_mesh();
  test::Random random(4);
  for (int i = 0; i < 200; ++i) {
    const std::uint32_t t = random.index(source.triangle_count());
    const double u = random.uniform(0, 0.5), v = random.uniform(0, 0.49);
    Mesh mesh = source;
    const std::uint32_t made =
        append_interpolated_vertex(source.triangles[t], {1 - u - v, u, v}, mesh);
    ASSERT_EQ(made, source.vertex_count());
    const std::uint32_t a = source.triangles[t][0], b = source.triangles[t][1],
                        c = source.triangles[t][2];
    const auto mean = [&](const auto& values) {
      return ((1 - u - v) * values[a].template cast<double>() +
              u * values[b].template cast<double>() + v * values[c].template cast<double>())
          .eval();
    };
    EXPECT_LT((mesh.positions[made].cast<double>() - mean(source.positions)).norm(), 1e-6);
    EXPECT_LT((mesh.uv_sets[0][made].cast<double>() - mean(source.uv_sets[0])).norm(), 1e-6);
    EXPECT_LT((mesh.color_sets[0][made].cast<double>() - mean(source.color_sets[0])).norm(), 1e-6);
    EXPECT_LT((mesh.normals[made].cast<double>() - mean(source.normals).normalized()).norm(), 1e-6);
    EXPECT_NEAR(mesh.tangents[made].head<3>().norm(), 1.0f, 1e-6f);
    EXPECT_EQ(mesh.tangents[made].w(), 1.0f);
    EXPECT_LT((mesh.morph_targets[0].position_deltas[made].cast<double>() -
               mean(source.morph_targets[0].position_deltas))
                  .norm(),
              1e-6);
    const float part = mesh.custom_attributes[1].values[made];
    EXPECT_EQ(part, static_cast<float>(1 - u - v >= std::max(u, v) ? a
                                       : u > v                     ? b
                                                                   : c))
        << "labels come from the nearest corner";

    std::map<std::uint32_t, double> expected, actual;
    for (const auto& [corner, beta] : {std::pair{a, 1 - u - v}, {b, u}, {c, v}})
      for (const Influence& influence : source.weights.of(corner))
        expected[influence.slot] += beta * static_cast<double>(influence.weight);
    double sum = 0;
    for (const Influence& influence : mesh.weights.of(made)) {
      actual[influence.slot] = static_cast<double>(influence.weight);
      sum += actual[influence.slot];
    }
    EXPECT_NEAR(sum, 1, 2e-7 * static_cast<double>(actual.size()));
    ASSERT_EQ(actual.size(), expected.size());
    for (const auto& [slot, weight] : expected) EXPECT_NEAR(actual[slot], weight, 1e-6);
  }
}

TEST(Interpolate, a_birth_in_a_corner_is_that_vertex) {
  const Mesh source = rich_mesh();
  Mesh mesh = source;
  const std::uint32_t made = append_interpolated_vertex(source.triangles[3], {0, 1, 0}, mesh);
  const std::uint32_t corner = source.triangles[3][1];
  EXPECT_EQ(mesh.positions[made], source.positions[corner]);
  EXPECT_EQ(mesh.uv_sets[0][made], source.uv_sets[0][corner]);
  for (const Influence& influence : source.weights.of(corner)) {
    const auto of_made = mesh.weights.of(made);
    EXPECT_NE(std::find(of_made.begin(), of_made.end(), influence), of_made.end());
  }
}

TEST(Interpolate, copies_and_removals_are_exact) {
  const Mesh source = rich_mesh();
  Mesh mesh = source;
  const std::uint32_t copy = append_vertex_copy(9, mesh);
  EXPECT_EQ(mesh.positions[copy], mesh.positions[9]);
  EXPECT_EQ(mesh.custom_attributes[0].values[2 * copy + 1], mesh.custom_attributes[0].values[19]);
  EXPECT_TRUE(std::ranges::equal(mesh.weights.of(copy), mesh.weights.of(9)));
  append_interpolated_vertex(source.triangles[1], {0.2, 0.3, 0.5}, mesh);
  remove_vertices_from(source.vertex_count(), mesh);
  EXPECT_EQ(mesh, source);
}

TEST(Interpolate, a_surface_point_is_copied_bit_for_bit) {
  const Mesh source = rich_mesh();
  Mesh mesh = source;
  const std::uint32_t like = append_interpolated_vertex(source.triangles[1], {0.2, 0.3, 0.5}, mesh);
  const std::uint32_t made = append_interpolated_vertex(source.triangles[8], {0.6, 0.3, 0.1}, mesh);
  copy_surface_point(mesh, like, made, mesh);
  EXPECT_EQ(mesh.positions[made], mesh.positions[like]);
  EXPECT_EQ(mesh.morph_targets[0].position_deltas[made],
            mesh.morph_targets[0].position_deltas[like]);
  EXPECT_TRUE(std::ranges::equal(mesh.weights.of(made), mesh.weights.of(like)));
}

}  // namespace
}  // namespace sunder
