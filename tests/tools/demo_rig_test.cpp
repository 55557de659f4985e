#include "tools/demo/demo_rig.h"

#include <sunder/tear/topology.h>

#include <algorithm>

#include <gtest/gtest.h>

namespace sunder::tools {
namespace {

TEST(DemoRig, is_valid_and_always_the_same) {
  const Character cactus = make_cactus();
  const Status status = validate_character(cactus);
  EXPECT_TRUE(status) << status.text();
  EXPECT_EQ(cactus, make_cactus());
}

TEST(DemoRig, is_one_closed_manifold_surface_in_a_pot) {
  const TopologyCounts counts = *count_topology(make_cactus());
  EXPECT_EQ(counts.components, 2u);
  EXPECT_EQ(counts.boundary_edges, 0u);
  EXPECT_EQ(counts.non_manifold_edges, 0u);
  EXPECT_EQ(counts.degenerate_triangles, 0u);
  // Without handles: the Euler characteristic of two spheres.
  EXPECT_EQ(counts.points + counts.triangles, counts.edges + 4);
}

TEST(DemoRig, has_something_of_everything_that_a_tear_must_carry) {
  const Character cactus = make_cactus();
  const Mesh& flesh = cactus.meshes.at(0);
  EXPECT_EQ(flesh.name, "Cactus");
  EXPECT_EQ(flesh.submeshes.size(), 2u);
  EXPECT_EQ(flesh.uv_sets.size(), 1u);
  EXPECT_EQ(flesh.morph_targets.size(), 1u);
  std::size_t most_influences = 0;
  for (std::uint32_t v = 0; v < flesh.vertex_count(); ++v)
    most_influences = std::max(most_influences, flesh.weights.of(v).size());
  EXPECT_GT(most_influences, 4u);
  const auto& channels = cactus.clips.at(0).channels;
  EXPECT_TRUE(std::any_of(channels.begin(), channels.end(), [](const Channel& channel) {
    return channel.interpolation == Interpolation::cubic_spline;
  }));
  // A UV seam: more vertices than points.
  EXPECT_GT(count_topology(cactus)->vertices, count_topology(cactus)->points);
}

}  // namespace
}  // namespace sunder::tools
