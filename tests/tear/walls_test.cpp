// Inner walls of gaps and bores.
#include <sunder/skinning/deform.h>
#include <sunder/skinning/pose.h>
#include <sunder/tear/topology.h>
#include <sunder/tear/torn_model.h>

#include <algorithm>
#include <numbers>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/models/make_model.h"
#include "support/models/rigs.h"
#include "support/oracles/torn_invariants.h"

namespace sunder {
namespace {

using test::make_model;
using test::Random;
using testing::IsEmpty;

double volume_of_mesh(const TornModel& model, const ModelPose& pose) {
  return test::enclosed_volume(test::posed_positions(model.character(), 0, pose),
                               model.character().meshes[0].triangles);
}

void expect_sound_walls(const TornModel& model) {
  EXPECT_THAT(test::broken_laws(model), IsEmpty());
  EXPECT_THAT(test::broken_surface(model), IsEmpty());
  EXPECT_EQ(count_topology(model.character())->non_manifold_edges, 0u);
}

Stroke along_tube() {
  return {{{-0.2, 1.2, 0.8}, {-0.2, 1.2, 0.2}},
          {{0.05, 1.5, 0.8}, {0.05, 1.5, 0.2}},
          {{0.2, 1.8, 0.8}, {0.2, 1.8, 0.2}}};
}

TEST(Walls, of_a_tear_start_at_its_lips) {
  for (const double width : {0.0, 0.1}) {
    SCOPED_TRACE(width);
    TornModel model = make_model(test::make_tube(10, 12, 3));
    const ModelPose pose = *bind_pose(model.source());
    const TearOptions options{width, Layers::nearest, 0.07};
    ASSERT_TRUE(model.tear(pose, along_tube(), options));
    TornModel without = make_model(test::make_tube(10, 12, 3));
    ASSERT_TRUE(without.tear(pose, along_tube(), {width, Layers::nearest, 0.0}));
    const TopologyCounts counts = *count_topology(model.character()),
                         bare = *count_topology(without.character());
    // Three rows of two triangles per border edge, whose lower edges form a border of the same
    // length. At a tip, where lips without a gap meet, the wall has no depth.
    const std::uint32_t tips = width > 0 ? 0 : 2;
    EXPECT_EQ(counts.triangles, bare.triangles + 6 * bare.boundary_edges - 6 * tips);
    EXPECT_EQ(counts.boundary_edges, bare.boundary_edges);
    EXPECT_EQ(counts.boundary_loops, 1u);
    EXPECT_EQ(counts.components, 1u);
    expect_sound_walls(model);
    const Mesh& mesh = model.character().meshes[0];
    EXPECT_EQ(mesh.submeshes.back().name, "wall");
    EXPECT_EQ(mesh.submeshes.size(), model.source().meshes[0].submeshes.size() + 1);
    // Everything lies within the depth below the surface of the tube (radius about 0.5), and
    // something lies at that depth.
    const auto radius = [&](std::uint32_t v) {
      return std::hypot(mesh.positions[v].x(), mesh.positions[v].z());
    };
    double deepest = 1;
    for (std::uint32_t v = model.source().meshes[0].vertex_count(); v < mesh.vertex_count(); ++v)
      deepest = std::min(deepest, static_cast<double>(radius(v)));
    double surface = 1;
    for (std::uint32_t v = model.source().meshes[0].vertex_count();
         v < without.character().meshes[0].vertex_count(); ++v)
      surface = std::min(surface, static_cast<double>(radius(v)));
    EXPECT_GT(surface - deepest, 0.02);
    EXPECT_LT(surface - deepest, 0.09);
  }
}

TEST(Walls, of_a_bore_through_a_body_close_it) {
  TornModel model = make_model(test::make_tube(16, 24, 3));
  const ModelPose pose = *bind_pose(model.source());
  const double whole = volume_of_mesh(model, pose);
  Bore bore;
  bore.origin = {0.03, 1.5, 3};
  bore.direction = {0, 0, -2};
  bore.radius = 0.1;
  bore.depth = 10;
  bore.wall = true;
  const auto report = model.drill(pose, bore);
  ASSERT_TRUE(report) << report.error().text();
  EXPECT_EQ(report->open_sections, 0u);
  const TopologyCounts counts = *count_topology(model.character());
  EXPECT_EQ(counts.boundary_edges, 0u);
  EXPECT_EQ(counts.components, 1u);
  // A hole through a ball makes a ring.
  const TopologyCounts before = *count_topology(model.source());
  const auto euler = [](const TopologyCounts& c) {
    return static_cast<int>(c.points) - static_cast<int>(c.edges) + static_cast<int>(c.triangles);
  };
  EXPECT_EQ(euler(counts), euler(before) - 2);
  EXPECT_LT(volume_of_mesh(model, pose), whole);
  expect_sound_walls(model);
}

TEST(Walls, of_a_blind_bore_have_a_floor) {
  TornModel model = make_model(test::make_tube(16, 24, 3));
  const ModelPose pose = *bind_pose(model.source());
  const double whole = volume_of_mesh(model, pose);
  Bore bore;
  bore.origin = {0.03, 1.5, 2};
  bore.direction = {0, 0, -1};
  bore.radius = 0.1;
  bore.depth = 1.8;  // down to z = 0.2
  bore.wall = true;
  ASSERT_TRUE(model.drill(pose, bore));
  EXPECT_EQ(count_topology(model.character())->boundary_edges, 0u);
  const double removed = whole - volume_of_mesh(model, pose);
  EXPECT_GT(removed, 0.5 * std::numbers::pi * 0.01 * 0.1);
  EXPECT_LT(removed, std::numbers::pi * 0.01 * 0.35);
  expect_sound_walls(model);
}

TEST(Walls, of_random_operations_keep_every_invariant) {
  Random random(21);
  for (int i = 0; i < 60; ++i) {
    SCOPED_TRACE(i);
    const std::uint32_t rings = 5 + random.index(12), sides = 5 + random.index(16);
    TornModel model = make_model(test::make_tube(rings, sides, 3));
    for (int k = 0; k < 4; ++k) {
      const ModelPose pose = test::random_pose(model.source(), random, 0.5, 1.1);
      const double diagonal = test::posed_diagonal(model.source(), pose);
      const double length = random.uniform(0.05, 0.3);
      const Stroke stroke =
          test::random_stroke(model.source(), pose, random, length, 1 + random.index(4));
      if (random.index(2) == 0) {
        const double width = random.index(2) == 0 ? 0.0 : random.uniform(0.002, 0.03) * diagonal;
        ASSERT_TRUE(model.tear(pose, stroke,
                               {width, Layers::nearest, random.uniform(0.005, 0.03) * diagonal}));
      } else {
        Bore bore;
        bore.origin = stroke[0].base;
        bore.direction = stroke[0].tip - stroke[0].base;
        bore.radius = random.uniform(0.005, 0.05) * diagonal;
        bore.depth = random.uniform(0.5, 5) * bore.direction.norm();
        bore.wall = true;
        ASSERT_TRUE(model.drill(pose, bore));
      }
      ASSERT_THAT(test::broken_laws(model), IsEmpty()) << "operation " << k;
      ASSERT_EQ(count_topology(model.character())->non_manifold_edges, 0u) << "operation " << k;
    }
    while (model.undo_count() > 0) ASSERT_TRUE(model.undo());
    ASSERT_EQ(model.character(), model.source());
  }
}

}  // namespace
}  // namespace sunder
