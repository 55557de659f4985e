// Where appended vertices come from, compared with what is in the mesh.

#include <sunder/tear/torn_weights.h>

#include <numeric>

#include <gtest/gtest.h>

#include "support/models/make_model.h"
#include "support/models/random_operations.h"
#include "support/models/rigs.h"

namespace sunder {
namespace {

Vec3d mean_position(const VertexOrigin& origin, const Mesh& mesh) {
  Vec3d mean = Vec3d::Zero();
  for (std::size_t k = 0; k < 3; ++k)
    mean += origin.parts[k] * mesh.positions[origin.parents[k]].cast<double>();
  return mean;
}

double area_of(const Triangle& triangle, const Mesh& mesh) {
  const Vec3d a = mesh.positions[triangle[0]].cast<double>(),
              b = mesh.positions[triangle[1]].cast<double>(),
              c = mesh.positions[triangle[2]].cast<double>();
  return 0.5 * (b - a).cross(c - a).norm();
}

TEST(VertexOrigins, are_the_places_of_the_vertices) {
  std::size_t between = 0, rims = 0, inside = 0;
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    test::Random random(seed);
    auto model = test::make_model(test::make_tube(14, 18, 5));
    for (int i = 0; i < 4; ++i)
      ASSERT_TRUE(test::play(model, test::random_operation(model, random)));
    const Mesh& mesh = model.character().meshes[0];
    const auto origins = vertex_origins(model);
    ASSERT_TRUE(origins);
    if (mesh == model.source().meshes[0]) continue;
    const MeshOrigins& of = origins->at(0);
    ASSERT_EQ(of.first_vertex, model.source().meshes[0].vertex_count());
    ASSERT_EQ(of.first_vertex + of.vertices.size(), mesh.vertex_count());
    for (std::uint32_t i = 0; i < of.vertices.size(); ++i) {
      const VertexOrigin& origin = of.vertices[i];
      const std::uint32_t v = of.first_vertex + i;
      EXPECT_NEAR(std::accumulate(origin.parts.begin(), origin.parts.end(), 0.0), 1, 1e-12);
      if (origin.values == VertexOrigin::Values::none) {
        ++inside;
        continue;
      }
      (origin.values == VertexOrigin::Values::all ? between : rims)++;
      for (const std::uint32_t parent : origin.parents) ASSERT_LT(parent, v);
      EXPECT_LT((mean_position(origin, mesh) - mesh.positions[v].cast<double>()).norm(), 1e-6)
          << "vertex " << v << " of seed " << seed;
    }
  }
  EXPECT_GT(between, 1000u);
  EXPECT_GT(rims, 100u);
  EXPECT_GT(inside, 100u);
}

TEST(VertexOrigins, tell_how_much_of_each_triangle_remains) {
  std::size_t reduced_triangles = 0;
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    test::Random random(seed);
    auto model = test::make_model(test::make_tube(14, 18, 5));
    for (int i = 0; i < 3; ++i)
      ASSERT_TRUE(test::play(model, test::random_operation(model, random)));
    const Mesh &mesh = model.character().meshes[0], &source = model.source().meshes[0];
    const auto origins = vertex_origins(model);
    ASSERT_TRUE(origins);
    std::vector<double> expected(source.triangle_count()), found(source.triangle_count());
    for (std::uint32_t t = 0; t < source.triangle_count(); ++t)
      expected[t] = area_of(source.triangles[t], source);
    for (const ReducedTriangle& reduced : origins->at(0).reduced) {
      expected[reduced.triangle] *= reduced.remaining;
      ++reduced_triangles;
    }
    for (std::uint32_t t = 0; t < mesh.triangle_count(); ++t)
      if (model.source_triangle(0, t) < source.triangle_count())
        found[model.source_triangle(0, t)] += area_of(mesh.triangles[t], mesh);
    for (std::uint32_t t = 0; t < source.triangle_count(); ++t)
      ASSERT_NEAR(found[t], expected[t], 1e-6) << "triangle " << t << " of seed " << seed;
  }
  EXPECT_GT(reduced_triangles, 100u);
}

TEST(VertexOrigins, are_none_before_the_first_operation) {
  const auto tube = std::make_shared<const Character>(test::make_tube(6, 6, 3));
  const auto asset = TornAsset::create(tube);
  ASSERT_TRUE(asset);
  for (const auto& model : {TornModel::create(tube), TornModel::create(*asset)}) {
    ASSERT_TRUE(model);
    const auto origins = vertex_origins(*model);
    ASSERT_TRUE(origins);
    ASSERT_EQ(origins->size(), 1u);
    EXPECT_EQ(origins->at(0), (MeshOrigins{tube->meshes[0].vertex_count(), {}, {}}));
  }
}

}  // namespace
}  // namespace sunder
