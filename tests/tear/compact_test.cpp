#include "tear/surface/compact.h"

#include <sunder/tear/topology.h>
#include <sunder/tear/torn_model.h>

#include <algorithm>
#include <cstring>

#include <gtest/gtest.h>

#include "support/models/rigs.h"

namespace sunder {
namespace {

using test::Random;

/// Any array of floats or of vectors of floats, with random bits except NaN.
template <class Value>
void fill(std::vector<Value>& values, std::size_t count, Random& random) {
  values.resize(count);
  auto* const floats = reinterpret_cast<float*>(values.data());
  for (std::size_t i = 0; i < count * sizeof(Value) / sizeof(float); ++i)
    floats[i] = static_cast<float>(random.uniform(-1, 1));
}

std::vector<Influence> random_influences(Random& random) {
  switch (random.index(3)) {
    case 0: return {{random.index(3), 1.0f}};
    case 1: return {{2, 0.75f}, {0, 0.25f}};
    default: return {{1, 0.5f}, {0, 0.25f}, {2, 0.25f}};
  }
}

/// A mesh with every kind of array, or with as few as possible; some of its triangles are retired,
/// some vertices have no triangle.
Mesh random_mesh(Random& random, bool is_full) {
  Mesh mesh;
  mesh.name = is_full ? "full" : "bare";
  const std::size_t count = 3 + random.index(40);
  fill(mesh.positions, count, random);
  for (std::size_t v = 0; v < count; ++v) mesh.weights.append(random_influences(random));
  mesh.submeshes = {{"one", 4}, {"other", kNone}};
  if (is_full) {
    fill(mesh.normals, count, random);
    fill(mesh.tangents, count, random);
    for (auto& uv : mesh.uv_sets = std::vector<std::vector<Vec2f>>(2)) fill(uv, count, random);
    fill(mesh.color_sets.emplace_back(), count, random);
    for (std::uint32_t components = 1; components <= 4; ++components) {
      mesh.custom_attributes.push_back(
          {"_CUSTOM_" + std::to_string(components), components, components == 2, {}});
      fill(mesh.custom_attributes.back().values, count * components, random);
    }
    mesh.morph_targets = {{"all", {}, {}, {}}, {"none", {}, {}, {}}};
    fill(mesh.morph_targets[0].position_deltas, count, random);
    fill(mesh.morph_targets[0].normal_deltas, count, random);
    fill(mesh.morph_targets[0].tangent_deltas, count, random);
  }
  const auto vertex = [&] { return random.index(static_cast<std::uint32_t>(count)); };
  for (std::uint32_t triangles = random.index(40); triangles > 0; --triangles) {
    const std::uint32_t a = vertex();
    mesh.triangles.push_back(random.index(3) == 0 ? Triangle{a, a, a}
                                                  : Triangle{a, vertex(), vertex()});
    mesh.triangle_submesh.push_back(random.index(2));
  }
  return mesh;
}

Character random_compacted_character(Random& random) {
  Character character = test::make_tube(2, 3, 3);
  character.rest_morph_weights = {0.0f, 0.5f};
  character.meshes = {random_mesh(random, true), random_mesh(random, false)};
  return character;
}

template <class Value>
bool are_kept(const std::vector<Value>& after, const std::vector<Value>& before,
              const std::vector<std::uint32_t>& old_from_new, std::size_t per_element = 1) {
  if (before.empty()) return after.empty();
  if (after.size() != old_from_new.size() * per_element) return false;
  for (std::size_t i = 0; i < old_from_new.size(); ++i)
    if (std::memcmp(&after[i * per_element], &before[old_from_new[i] * per_element],
                    per_element * sizeof(Value)) != 0)
      return false;
  return true;
}

void expect_vertices_kept(const Mesh& after, const Mesh& before,
                          const std::vector<std::uint32_t>& old_from_new) {
  EXPECT_TRUE(are_kept(after.positions, before.positions, old_from_new));
  EXPECT_TRUE(are_kept(after.normals, before.normals, old_from_new));
  EXPECT_TRUE(are_kept(after.tangents, before.tangents, old_from_new));
  for (std::size_t i = 0; i < before.uv_sets.size(); ++i)
    EXPECT_TRUE(are_kept(after.uv_sets[i], before.uv_sets[i], old_from_new));
  for (std::size_t i = 0; i < before.color_sets.size(); ++i)
    EXPECT_TRUE(are_kept(after.color_sets[i], before.color_sets[i], old_from_new));
  for (std::size_t i = 0; i < before.custom_attributes.size(); ++i) {
    const CustomAttribute& attribute = before.custom_attributes[i];
    EXPECT_TRUE(are_kept(after.custom_attributes[i].values, attribute.values, old_from_new,
                         attribute.components));
  }
  for (std::size_t i = 0; i < before.morph_targets.size(); ++i) {
    EXPECT_TRUE(are_kept(after.morph_targets[i].position_deltas,
                         before.morph_targets[i].position_deltas, old_from_new));
    EXPECT_TRUE(are_kept(after.morph_targets[i].normal_deltas,
                         before.morph_targets[i].normal_deltas, old_from_new));
    EXPECT_TRUE(are_kept(after.morph_targets[i].tangent_deltas,
                         before.morph_targets[i].tangent_deltas, old_from_new));
  }
  ASSERT_EQ(after.weights.vertex_count(), old_from_new.size());
  for (std::uint32_t v = 0; v < old_from_new.size(); ++v)
    EXPECT_TRUE(std::ranges::equal(after.weights.of(v), before.weights.of(old_from_new[v])));
}

void expect_triangles_kept(const Mesh& after, const Mesh& before, const CompactMaps::OfMesh& maps) {
  ASSERT_EQ(after.triangle_count(), maps.triangle_old_from_new.size());
  EXPECT_TRUE(
      are_kept(after.triangle_submesh, before.triangle_submesh, maps.triangle_old_from_new));
  for (std::uint32_t t = 0; t < after.triangle_count(); ++t)
    for (std::size_t k = 0; k < 3; ++k)
      EXPECT_EQ(maps.vertex_old_from_new[after.triangles[t][k]],
                before.triangles[maps.triangle_old_from_new[t]][k]);
}

void expect_ascending(const std::vector<std::uint32_t>& map) {
  EXPECT_TRUE(std::adjacent_find(map.begin(), map.end(), std::greater_equal<>()) == map.end());
}

/// Everything that should stay does, and nothing else.
void expect_nothing_superfluous(const Mesh& after, const Mesh& before) {
  std::vector<bool> is_used(after.vertex_count(), false);
  for (const Triangle& triangle : after.triangles) {
    EXPECT_FALSE(is_retired(triangle));
    for (const std::uint32_t vertex : triangle) is_used[vertex] = true;
  }
  EXPECT_EQ(std::count(is_used.begin(), is_used.end(), false), 0);
  EXPECT_EQ(after.triangle_count(),
            before.triangle_count() -
                std::count_if(before.triangles.begin(), before.triangles.end(), is_retired));
}

TEST(Compact, keeps_every_bit_of_remaining_elements) {
  for (std::uint64_t seed = 0; seed < 300; ++seed) {
    SCOPED_TRACE(seed);
    Random random(seed);
    const Character before = random_compacted_character(random);
    ASSERT_TRUE(validate_character(before)) << validate_character(before).text();
    Character after = before;
    const CompactMaps maps = compact(after);
    EXPECT_TRUE(validate_character(after)) << validate_character(after).text();
    ASSERT_EQ(maps.meshes.size(), before.meshes.size());
    for (std::size_t m = 0; m < before.meshes.size(); ++m) {
      expect_ascending(maps.meshes[m].vertex_old_from_new);
      expect_ascending(maps.meshes[m].triangle_old_from_new);
      expect_vertices_kept(after.meshes[m], before.meshes[m], maps.meshes[m].vertex_old_from_new);
      expect_triangles_kept(after.meshes[m], before.meshes[m], maps.meshes[m]);
      expect_nothing_superfluous(after.meshes[m], before.meshes[m]);
      EXPECT_EQ(after.meshes[m].submeshes, before.meshes[m].submeshes);
    }
  }
}

TEST(Compact, a_second_time_changes_nothing) {
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    Random random(seed);
    Character once = random_compacted_character(random);
    (void)compact(once);
    Character twice = once;
    const CompactMaps maps = compact(twice);
    EXPECT_EQ(twice, once);
    for (const auto& of_mesh : maps.meshes)
      for (std::uint32_t v = 0; v < of_mesh.vertex_old_from_new.size(); ++v)
        EXPECT_EQ(of_mesh.vertex_old_from_new[v], v);
  }
}

TEST(Compact, changes_only_the_number_of_vertices) {
  Random random(7);
  Character character = test::make_tube(8, 9, 3);
  for (Triangle& triangle : character.meshes[0].triangles)
    if (random.index(2) == 0) triangle = {triangle[1], triangle[1], triangle[1]};
  const TopologyCounts before = *count_topology(character);
  (void)compact(character);
  TopologyCounts after = *count_topology(character);
  EXPECT_LT(after.vertices, before.vertices);
  EXPECT_EQ(after.points, before.points);
  EXPECT_EQ(after.triangles, before.triangles);
  EXPECT_EQ(after.edges, before.edges);
  EXPECT_EQ(after.boundary_edges, before.boundary_edges);
  EXPECT_EQ(after.boundary_loops, before.boundary_loops);
  EXPECT_EQ(after.components, before.components);
  EXPECT_EQ(after.degenerate_triangles, before.degenerate_triangles);
}

TEST(Compact, a_mesh_may_lose_everything) {
  Random random(3);
  Character character = random_compacted_character(random);
  for (Triangle& triangle : character.meshes[0].triangles) triangle = {0, 0, 0};
  const CompactMaps maps = compact(character);
  EXPECT_TRUE(maps.meshes[0].vertex_old_from_new.empty());
  EXPECT_TRUE(maps.meshes[0].triangle_old_from_new.empty());
  EXPECT_EQ(character.meshes.size(), 2u) << "meshes keep their numbers";
  EXPECT_EQ(character.meshes[0].vertex_count(), 0u);
  EXPECT_EQ(character.meshes[0].weights, SkinWeights{});
  EXPECT_EQ(character.meshes[0].submeshes.size(), 2u);
  EXPECT_TRUE(validate_character(character)) << validate_character(character).text();
}

TEST(Compact, a_model_keeps_its_weight_options) {
  auto model = TornModel::create(std::make_shared<const Character>(test::make_sheet(3)));
  ASSERT_TRUE(model);
  WeightOptions two;
  two.maximum_influences = 2;
  ASSERT_TRUE(model->set_weights(two));
  ASSERT_TRUE(model->compact());
  EXPECT_EQ(model->weights(), two);
}

}  // namespace
}  // namespace sunder
