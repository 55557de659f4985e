// Every attribute of a new vertex follows from its birth, whatever was done, undone and done again.

#include <sunder/skinning/vertex_arrays.h>
#include <sunder/tear/torn_model.h>

#include <algorithm>
#include <array>

#include <gtest/gtest.h>

#include "support/models/make_model.h"
#include "support/models/random_operations.h"
#include "support/models/rich_mesh.h"
#include "support/models/rigs.h"

namespace sunder {
namespace {

using test::Random;

/// A tube with attributes of every kind; all displacements of its morph target differ.
Character rich_tube() {
  Character character = test::make_tube(5, 7, 4);
  character.meshes[0] = test::rich_mesh();
  Mesh& mesh = character.meshes[0];
  Random random(3);
  for (std::uint32_t v = 0; v < mesh.vertex_count(); ++v) {
    mesh.morph_targets[0].normal_deltas.push_back(random.direction().cast<float>());
    mesh.morph_targets[0].tangent_deltas.push_back(random.direction().cast<float>());
  }
  return character;
}

/// What a new vertex is made of.
struct Origin {
  std::array<std::uint32_t, 3> corners;
  std::array<double, 3> barycentric;

  /// The mean of a quantity, given by corner.
  template <class Of>
  [[nodiscard]] auto mean(Of of) const {
    return (barycentric[0] * of(corners[0]) + barycentric[1] * of(corners[1]) +
            barycentric[2] * of(corners[2]))
        .eval();
  }
  [[nodiscard]] auto mean_of(const auto& values) const {
    return mean([&](std::uint32_t v) { return values[v].template cast<double>().eval(); });
  }
};

/// Calls visit(vertex, origin) for each new vertex of the surface; walls and caps have attributes
/// of their own.
template <class Visit>
std::size_t for_each_new_vertex(const TornModel& model, Visit visit) {
  const Mesh &torn = model.character().meshes[0], &source = model.source().meshes[0];
  std::size_t count = 0;
  for (std::uint32_t v = source.vertex_count(); v < torn.vertex_count(); ++v) {
    const Birth birth = model.birth(0, v);
    if (birth.triangle >= source.triangle_count()) continue;
    Origin origin{source.triangles[birth.triangle], {}};
    for (std::size_t k = 0; k < 3; ++k) origin.barycentric[k] = birth.barycentric[k];
    visit(v, origin);
    ++count;
  }
  return count;
}

std::size_t expect_attributes_of_births(const TornModel& model) {
  const Mesh &torn = model.character().meshes[0], &source = model.source().meshes[0];
  constexpr double kNear = 2e-6;
  return for_each_new_vertex(model, [&](std::uint32_t v, const Origin& of) {
    EXPECT_LT((torn.uv_sets[0][v].cast<double>() - of.mean_of(source.uv_sets[0])).norm(), kNear);
    EXPECT_LT((torn.color_sets[0][v].cast<double>() - of.mean_of(source.color_sets[0])).norm(),
              kNear);
    const Eigen::Vector3d normal = of.mean_of(source.normals);
    EXPECT_LT((torn.normals[v].cast<double>() - normal.normalized()).norm(), kNear);
    EXPECT_NEAR(torn.tangents[v].head<3>().norm(), 1, 1e-6);
    EXPECT_EQ(torn.tangents[v].w(), 1.0f);
    const MorphTarget &morph = torn.morph_targets[0], &from = source.morph_targets[0];
    EXPECT_LT((morph.normal_deltas[v].cast<double>() - of.mean_of(from.normal_deltas)).norm(),
              kNear);
    EXPECT_LT((morph.tangent_deltas[v].cast<double>() - of.mean_of(from.tangent_deltas)).norm(),
              kNear);
    const auto& heat = source.custom_attributes[0].values;
    const Eigen::Vector2d expected = of.mean([&](std::uint32_t corner) {
      return Eigen::Vector2d(static_cast<double>(heat[2 * corner]),
                             static_cast<double>(heat[2 * corner + 1]));
    });
    const float* const found = &torn.custom_attributes[0].values[2 * v];
    EXPECT_NEAR(static_cast<double>(found[0]), expected.x(), 1e-5);
    EXPECT_NEAR(static_cast<double>(found[1]), expected.y(), 1e-5);
    const float label = torn.custom_attributes[1].values[v];
    EXPECT_TRUE(std::ranges::count(of.corners, static_cast<std::uint32_t>(label)) > 0) << label;
  });
}

TEST(Attributes, follow_births_through_operations_undo_and_redo) {
  std::size_t checked = 0;
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    Random random(seed);
    TornModel model = test::make_model(rich_tube());
    for (int i = 0; i < 5; ++i)
      ASSERT_TRUE(test::play(model, test::random_operation(model, random)));
    checked += expect_attributes_of_births(model);
    const Character torn = model.character();
    while (model.undo_count() > 0) ASSERT_TRUE(model.undo());
    EXPECT_EQ(model.character(), model.source());
    while (model.redo_count() > 0) ASSERT_TRUE(model.redo());
    EXPECT_EQ(model.character(), torn);
    if (::testing::Test::HasFailure()) FAIL() << "seed " << seed;
  }
  EXPECT_GT(checked, 1000u);
}

TEST(Attributes, of_exact_vertices_are_the_sums_of_their_influences) {
  const Character source = rich_tube();
  const Mesh& mesh = source.meshes[0];
  std::size_t checked = 0;
  for (std::uint64_t seed = 0; seed < 10; ++seed) {
    Random random(seed);
    TornModel model = test::make_model(source);
    ASSERT_TRUE(model.set_weights({WeightPolicy::exact, 0}));
    for (int i = 0; i < 3; ++i)
      ASSERT_TRUE(test::play(model, test::random_tear(model, random, false)));
    const Mesh& torn = model.character().meshes[0];
    const InfluencePositions& exact = model.influence_positions(0);
    for_each_new_vertex(model, [&](std::uint32_t v, const Origin& of) {
      const std::uint32_t place = model.influence_place(0, v);
      ASSERT_EQ(place != kNone, std::ranges::binary_search(exact.vertices, v));
      if (place == kNone) return;
      const auto influences = torn.weights.of(v);
      for (std::size_t i = 0; i < influences.size(); ++i) {
        const auto expect_sum = [&](const std::vector<Vec3f>& found, auto value) {
          const Eigen::Vector3d expected = of.mean([&](std::uint32_t corner) -> Eigen::Vector3d {
            double weight = 0;
            for (const Influence& influence : mesh.weights.of(corner))
              if (influence.slot == influences[i].slot)
                weight = static_cast<double>(influence.weight);
            return weight * value(corner).template cast<double>();
          });
          EXPECT_LT((found[place + i].cast<double>() - expected).norm(), 2e-6);
        };
        const auto of_stream = [](const auto& stream) {
          return [&](std::uint32_t corner) { return stream[corner].template head<3>().eval(); };
        };
        expect_sum(exact.normals, of_stream(mesh.normals));
        expect_sum(exact.tangents, of_stream(mesh.tangents));
        const InfluencePositions::Deltas& morph = exact.morph_targets[0];
        expect_sum(morph.positions, of_stream(mesh.morph_targets[0].position_deltas));
        expect_sum(morph.normals, of_stream(mesh.morph_targets[0].normal_deltas));
        expect_sum(morph.tangents, of_stream(mesh.morph_targets[0].tangent_deltas));
        ++checked;
      }
    });
    if (::testing::Test::HasFailure()) FAIL() << "seed " << seed;
  }
  EXPECT_GT(checked, 200u);
}

}  // namespace
}  // namespace sunder
