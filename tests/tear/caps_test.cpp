// Caps of cuts close the pieces.
#include <sunder/skinning/deform.h>
#include <sunder/skinning/pose.h>
#include <sunder/tear/topology.h>
#include <sunder/tear/torn_model.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>
#include <vector>

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

/// Posed volume enclosed by some triangles, by the divergence theorem; by default by the whole
/// mesh.
double volume_of(const TornModel& model, const ModelPose& pose, const TornPiece* piece = nullptr) {
  double volume = 0;
  for (std::uint32_t m = 0; m < model.character().meshes.size(); ++m) {
    const auto positions = test::posed_positions(model.character(), m, pose);
    std::vector<Triangle> triangles;
    if (piece == nullptr) {
      triangles = model.character().meshes[m].triangles;
    } else {
      const Result<PieceDescription> description = model.describe_piece(*piece);
      for (const PieceDescription::Triangles& of_mesh : description->meshes)
        if (of_mesh.mesh == m)
          for (const std::uint32_t t : of_mesh.triangles)
            triangles.push_back(model.character().meshes[m].triangles[t]);
    }
    volume += test::enclosed_volume(positions, triangles);
  }
  return volume;
}

PlaneCut cut_through(const Vec3d& point, const Vec3d& normal) {
  PlaneCut cut;
  cut.point = point;
  cut.normal = normal;
  cut.caps = true;
  return cut;
}

TEST(Caps, close_both_halves_of_a_tube) {
  TornModel model = make_model(test::make_tube(10, 12, 3));
  const ModelPose pose = *bind_pose(model.source());
  const double whole = volume_of(model, pose);
  const auto report = model.cut(pose, cut_through({0, 1.53, 0}, {0.2, 1, 0.1}));
  ASSERT_TRUE(report) << report.error().text();
  EXPECT_EQ(report->caps, 2u);
  EXPECT_EQ(report->open_sections, 0u);
  const TopologyCounts counts = *count_topology(model.character());
  EXPECT_EQ(counts.components, 2u);
  EXPECT_EQ(counts.boundary_edges, 0u);
  EXPECT_EQ(counts.non_manifold_edges, 0u);
  ASSERT_EQ(report->pieces.size(), 2u);
  EXPECT_NEAR(
      volume_of(model, pose, &report->pieces[0]) + volume_of(model, pose, &report->pieces[1]),
      whole, 1e-6 * whole);
  EXPECT_GT(volume_of(model, pose, &report->pieces[0]), 0);
  EXPECT_GT(volume_of(model, pose, &report->pieces[1]), 0);
  EXPECT_THAT(test::broken_laws(model), IsEmpty());
}

TEST(Caps, of_random_cuts_in_random_poses_leave_no_border) {
  Random random(9);
  for (int i = 0; i < 100; ++i) {
    SCOPED_TRACE(i);
    const std::uint32_t rings = 3 + random.index(12), sides = 3 + random.index(16);
    TornModel model = make_model(test::make_tube(rings, sides, 2 + random.index(3)));
    for (int k = 0; k < 4; ++k) {
      const ModelPose pose = test::random_pose(model.source(), random, 0.5, 1.1);
      const auto positions = test::posed_positions(model.source(), 0, pose);
      Vec3d middle = Vec3d::Zero();
      for (int n = 0; n < 3; ++n)
        middle += positions[random.index(static_cast<std::uint32_t>(positions.size()))] / 3;
      const auto report = model.cut(pose, cut_through(middle, random.direction()));
      ASSERT_TRUE(report) << report.error().text();
      ASSERT_EQ(report->open_sections, 0u) << "cut " << k;
      ASSERT_EQ(count_topology(model.character())->boundary_edges, 0u) << "cut " << k;
      ASSERT_EQ(count_topology(model.character())->non_manifold_edges, 0u) << "cut " << k;
      ASSERT_THAT(test::broken_laws(model), IsEmpty()) << "cut " << k;
    }
    while (model.undo_count() > 0) ASSERT_TRUE(model.undo());
    ASSERT_EQ(model.character(), model.source());
  }
}

TEST(Caps, of_both_sides_have_the_same_points_and_opposite_normals) {
  Random random(11);
  for (int i = 0; i < 30; ++i) {
    SCOPED_TRACE(i);
    TornModel model = make_model(test::make_tube(6 + random.index(6), 12, 3));
    const ModelPose pose = test::random_pose(model.source(), random, 0.4, 1.0);
    const auto positions = test::posed_positions(model.source(), 0, pose);
    const Vec3d place = positions[random.index(static_cast<std::uint32_t>(positions.size()))];
    const auto report = model.cut(pose, cut_through(place, random.direction()));
    ASSERT_TRUE(report) << report.error().text();
    const Mesh& mesh = model.character().meshes[0];
    // The vertices of caps by their places: one for either side.
    std::map<std::array<float, 3>, std::vector<std::uint32_t>> at;
    std::set<std::uint32_t> seen;
    for (std::uint32_t t = 0; t < mesh.triangle_count(); ++t) {
      if (mesh.submeshes[mesh.triangle_submesh[t]].name != "cap") continue;
      for (const std::uint32_t v : mesh.triangles[t])
        if (seen.insert(v).second)
          at[{mesh.positions[v].x(), mesh.positions[v].y(), mesh.positions[v].z()}].push_back(v);
    }
    for (const auto& [position, vertices] : at) {
      if (vertices.size() != 2) continue;  // also a place where two sections meet
      const auto a = mesh.weights.of(vertices[0]), b = mesh.weights.of(vertices[1]);
      EXPECT_TRUE(std::equal(a.begin(), a.end(), b.begin(), b.end()));
      EXPECT_LT((mesh.normals[vertices[0]] + mesh.normals[vertices[1]]).norm(), 1e-5f);
    }
    EXPECT_EQ(seen.size() > 0, report->caps > 0);
  }
}

/// Twenty cuts with caps across a whole body of 7,344 faces: with inner points everywhere as close
/// as on the rim it would have more than 200,000 faces.
void expect_few_faces(std::uint64_t seed, std::uint32_t most) {
  const Character tube = test::make_tube(101, 36, 8);
  TornModel model = make_model(tube);
  const ModelPose pose = *bind_pose(tube);
  Eigen::AlignedBox3d box;
  for (const Vec3f& position : tube.meshes[0].positions)
    box.extend(Eigen::Vector3d(position.cast<double>()));
  Random random(seed);
  std::uint32_t caps = 0;
  for (int i = 0; i < 20; ++i) {
    Eigen::Vector3d at;
    for (double& coordinate : at) coordinate = random.uniform(0.25, 0.75);
    const Vec3d point = box.min() + at.cwiseProduct(box.sizes());
    const auto report = model.cut(pose, cut_through(point, random.direction()));
    ASSERT_TRUE(report) << report.error().text();
    caps += report->caps;
  }
  EXPECT_GT(caps, 200u);
  const TopologyCounts counts = *count_topology(model.character());
  EXPECT_EQ(counts.boundary_edges, 0u);
  EXPECT_EQ(counts.non_manifold_edges, 0u);
  EXPECT_LT(counts.triangles, most);
}

TEST(Caps, that_are_cut_again_do_not_multiply) {
  expect_few_faces(3, 43000);
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    SCOPED_TRACE(seed);
    expect_few_faces(seed, 60000);
  }
}

/// Later planes cross faces that are thinner than stored positions can tell: corners of older caps
/// lie on one line.
TEST(Caps, of_faces_whose_corners_lie_on_one_line_are_cut) {
  for (const std::uint64_t seed : {32, 33, 49, 88, 160, 226, 254}) {
    SCOPED_TRACE(seed);
    expect_few_faces(seed, 90000);
  }
}

}  // namespace
}  // namespace sunder
