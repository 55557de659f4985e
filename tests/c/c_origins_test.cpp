// Where C programs are told that vertices and triangles come from.

#include <cmath>
#include <map>

#include "c/c_twins.h"

namespace sunder::test {
namespace {

std::vector<sunder_vertex_origin> vertex_origins(const Twins& twins, std::uint32_t first) {
  std::uint32_t count = 0;
  EXPECT_DONE(sunder_get_vertex_origins(twins.c_scene, twins.c_id, 0, first, nullptr, 0, &count));
  std::vector<sunder_vertex_origin> origins(count);
  EXPECT_DONE(sunder_get_vertex_origins(twins.c_scene, twins.c_id, 0, first, origins.data(), count,
                                        &count));
  EXPECT_EQ(count, origins.size());
  return origins;
}

std::vector<sunder_triangle_origin> triangle_origins(const Twins& twins) {
  std::uint32_t count = 0;
  EXPECT_DONE(sunder_get_triangle_origins(twins.c_scene, twins.c_id, 0, 0, nullptr, 0, &count));
  std::vector<sunder_triangle_origin> origins(count);
  EXPECT_DONE(
      sunder_get_triangle_origins(twins.c_scene, twins.c_id, 0, 0, origins.data(), count, &count));
  return origins;
}

/// A number that a program of its own would keep per vertex.
double own_value(const float* position) {
  return 2.0 * static_cast<double>(position[0]) - static_cast<double>(position[1]) +
         0.5 * static_cast<double>(position[2]);
}

TEST(COrigins, of_vertices_carry_what_a_program_keeps_per_vertex) {
  Random random(21);
  Twins twins(make_tube(24, 12, 6));
  twins.update();
  const Mesh& source = twins.asset->character()->meshes[0];
  std::size_t on_surface = 0, filled = 0;
  for (int frame = 0; frame < 12; ++frame) {
    submit_random(twins, random);
    twins.update();
    sunder_mesh torn = {};
    EXPECT_DONE(sunder_get_instance_mesh(twins.c_scene, twins.c_id, 0, &torn));
    const auto origins = vertex_origins(twins, source.vertex_count());
    ASSERT_EQ(source.vertex_count() + origins.size(), torn.vertex_count);
    const TornModel& model = *twins.scene->find(twins.id)->model();
    for (std::size_t i = 0; i < origins.size(); ++i) {
      const auto vertex = static_cast<std::uint32_t>(source.vertex_count() + i);
      if (origins[i].triangle == SUNDER_NONE) {
        ++filled;
        continue;
      }
      ++on_surface;
      if (model.weight_policy(0, vertex) != WeightPolicy::barycentric) continue;
      double value = 0;
      for (std::size_t k = 0; k < 3; ++k)
        value += origins[i].barycentric[k] *
                 own_value(source.positions[source.triangles[origins[i].triangle][k]].data());
      EXPECT_NEAR(own_value(torn.positions + 3 * vertex), value, 1e-6) << vertex;
    }
  }
  EXPECT_GT(on_surface, 200u);
  EXPECT_GT(filled, 20u);
}

TEST(COrigins, of_triangles_tell_their_source_and_their_neighbours) {
  Random random(22);
  Twins twins(make_tube(24, 12, 6));
  twins.update();
  const Mesh& source = twins.asset->character()->meshes[0];
  for (int frame = 0; frame < 12; ++frame) {
    submit_random(twins, random);
    twins.update();
    sunder_mesh torn = {};
    EXPECT_DONE(sunder_get_instance_mesh(twins.c_scene, twins.c_id, 0, &torn));
    const auto origins = triangle_origins(twins);
    ASSERT_EQ(origins.size(), torn.triangle_count);
    std::map<std::uint32_t, const float*> place_of_point;
    std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
    for (std::uint32_t t = 0; t < torn.triangle_count; ++t) {
      const std::uint32_t* const corners = torn.triangles + 3 * t;
      const bool is_removed = corners[0] == corners[1] && corners[1] == corners[2];
      ASSERT_EQ(origins[t].points[0] == SUNDER_NONE, is_removed);
      if (is_removed) continue;
      for (std::size_t k = 0; k < 3; ++k) {
        const float* const at = torn.positions + 3 * corners[k];
        const float* const known = place_of_point.emplace(origins[t].points[k], at).first->second;
        EXPECT_TRUE(std::equal(at, at + 3, known)) << "a point is one place";
        ++edges[{origins[t].points[k], origins[t].points[(k + 1) % 3]}];
      }
      if (t < source.triangle_count()) {
        EXPECT_EQ(origins[t].triangle, t);
      }
    }
    for (const auto& [edge, count] : edges) EXPECT_EQ(count, 1) << "two triangles on one side";
  }
}

TEST(COrigins, refuse_what_there_is_not) {
  Twins twins(make_tube(8, 6, 3));
  std::uint32_t count = 7;
  sunder_vertex_origin vertex = {};
  sunder_triangle_origin triangle = {};
  EXPECT_EQ(sunder_get_vertex_origins(twins.c_scene, twins.c_id, 0, 0, &vertex, 1, &count),
            SUNDER_NOT_FOUND)
      << "nothing was torn";
  EXPECT_EQ(sunder_get_triangle_origins(twins.c_scene, twins.c_id, 0, 0, &triangle, 1, &count),
            SUNDER_NOT_FOUND);
  EXPECT_DONE(sunder_prepare_to_tear(twins.c_scene, twins.c_id));
  const std::uint32_t end = twins.asset->character()->meshes[0].vertex_count();
  EXPECT_EQ(sunder_get_vertex_origins(twins.c_scene, twins.c_id, 0, end - 1, &vertex, 1, &count),
            SUNDER_INDEX_OUT_OF_RANGE);
  EXPECT_EQ(sunder_last_error_index(), end - 1);
  EXPECT_EQ(sunder_get_vertex_origins(twins.c_scene, twins.c_id, 0, end + 1, &vertex, 1, &count),
            SUNDER_INDEX_OUT_OF_RANGE);
  EXPECT_EQ(sunder_get_vertex_origins(twins.c_scene, twins.c_id, 1, end, &vertex, 1, &count),
            SUNDER_INDEX_OUT_OF_RANGE);
  EXPECT_EQ(sunder_get_vertex_origins(twins.c_scene, twins.c_id, 0, end, nullptr, 1, &count),
            SUNDER_NULL_POINTER);
  EXPECT_EQ(sunder_get_vertex_origins(twins.c_scene, twins.c_id, 0, end, &vertex, 1, nullptr),
            SUNDER_NULL_POINTER);
  EXPECT_EQ(sunder_get_triangle_origins(twins.c_scene, twins.c_id, 0, 0, nullptr, 1, &count),
            SUNDER_NULL_POINTER);
  EXPECT_EQ(count, 7u) << "failures write nothing";
  EXPECT_DONE(sunder_get_vertex_origins(twins.c_scene, twins.c_id, 0, end, nullptr, 0, &count));
  EXPECT_EQ(count, 0u);
}

}  // namespace
}  // namespace sunder::test
