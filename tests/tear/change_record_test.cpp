// Checks what an engine relies on: buffers that are changed only in the ranges of the record stay
// equal to the model.
#include <sunder/skinning/deform.h>
#include <sunder/skinning/pose.h>
#include <sunder/tear/change_record.h>
#include <sunder/tear/tear_stroke.h>

#include <algorithm>
#include <bit>

#include <gtest/gtest.h>

#include "support/machine/stress.h"
#include "support/models/make_model.h"
#include "support/models/random_operations.h"
#include "support/models/rigs.h"
#include "support/oracles/model_state.h"

namespace sunder {
namespace {

using test::make_model;
using test::Random;

/// All attributes of a vertex one after another, as bits. The tear side is 0 if the mesh has none
/// yet.
class VertexBits {
 public:
  VertexBits(const Mesh& mesh, std::uint32_t v) : vertex_(v) {
    add(mesh.positions);
    add(mesh.normals);
    add(mesh.tangents);
    for (const auto& uv : mesh.uv_sets) add(uv);
    for (const auto& colors : mesh.color_sets) add(colors);
    float side = 0;
    for (const CustomAttribute& attribute : mesh.custom_attributes)
      if (attribute.name == kTearSideAttribute)
        side = attribute.values[v];
      else
        for (std::size_t c = 0; c < attribute.components; ++c)
          add(attribute.values[std::size_t{v} * attribute.components + c]);
    add(side);
    for (const MorphTarget& target : mesh.morph_targets) {
      add(target.position_deltas);
      add(target.normal_deltas);
      add(target.tangent_deltas);
    }
    for (const Influence& influence : mesh.weights.of(v)) {
      bits_.push_back(influence.slot);
      add(influence.weight);
    }
  }
  bool operator==(const VertexBits&) const = default;

 private:
  void add(float value) { bits_.push_back(std::bit_cast<std::uint32_t>(value)); }
  template <class Vector>
  void add(const std::vector<Vector>& values) {
    if (values.empty()) return;
    for (const float value : values[vertex_]) add(value);
  }

  std::uint32_t vertex_;
  std::vector<std::uint32_t> bits_;
};

struct MirroredMesh {
  std::vector<VertexBits> vertices;
  std::vector<Triangle> triangles;
  std::vector<std::uint32_t> submesh;

  explicit MirroredMesh(const Mesh& mesh)
      : triangles(mesh.triangles), submesh(mesh.triangle_submesh) {
    for (std::uint32_t v = 0; v < mesh.vertex_count(); ++v) vertices.emplace_back(mesh, v);
  }
  bool operator==(const MirroredMesh&) const = default;
};

void expect_apart_and_within(const DirtyRanges& ranges, std::size_t count) {
  std::uint32_t end = 0;
  for (const IndexRange& range : ranges) {
    EXPECT_GT(range.count, 0u);
    if (&range != ranges.begin()) {
      EXPECT_GT(range.first, end);
    }
    end = range.first + range.count;
    EXPECT_LE(end, count);
  }
}

class Mirror {
 public:
  explicit Mirror(const TornModel& model) {
    for (const Mesh& mesh : model.character().meshes) meshes_.emplace_back(mesh);
  }

  void apply(const ChangeRecord& change, const TornModel& model) {
    EXPECT_EQ(change.first_point + change.point_count, model.point_count());
    std::uint32_t next_mesh = 0;
    for (const MeshChange& of_mesh : change.meshes) {
      ASSERT_GE(of_mesh.mesh, next_mesh) << "meshes ascend";
      next_mesh = of_mesh.mesh + 1;
      apply(of_mesh, model);
    }
    for (std::size_t m = 0; m < meshes_.size(); ++m)
      ASSERT_TRUE(meshes_[m] == MirroredMesh(model.character().meshes[m])) << "mesh " << m;
  }

 private:
  void apply(const MeshChange& change, const TornModel& model) {
    const Mesh& mesh = model.character().meshes[change.mesh];
    ASSERT_EQ(change.first_vertex + change.vertex_count, mesh.vertex_count());
    ASSERT_EQ(change.first_triangle + change.triangle_count, mesh.triangle_count());
    expect_end_fits(change);
    expect_births(change, model);
    expect_rewritten(change, mesh);
    expect_retired(change, mesh);
    expect_apart_and_within(change.dirty_vertices, mesh.vertex_count());
    expect_apart_and_within(change.dirty_triangles, mesh.triangle_count());
    upload(change, mesh);
  }

  /// A range that grows begins at the end of the buffer; arrays that shrink do not grow.
  void expect_end_fits(const MeshChange& change) {
    const MirroredMesh& before = meshes_[change.mesh];
    EXPECT_LE(change.first_vertex, before.vertices.size());
    EXPECT_LE(change.first_triangle, before.triangles.size());
    if (change.vertex_count > 0) {
      EXPECT_EQ(change.first_vertex, before.vertices.size());
    }
    if (change.triangle_count > 0) {
      EXPECT_EQ(change.first_triangle, before.triangles.size());
    }
  }

  static void expect_births(const MeshChange& change, const TornModel& model) {
    ASSERT_EQ(change.births.size(), change.vertex_count);
    for (std::uint32_t i = 0; i < change.vertex_count; ++i)
      EXPECT_TRUE(
          test::are_same(change.births[i], model.birth(change.mesh, change.first_vertex + i)));
  }

  void expect_rewritten(const MeshChange& change, const Mesh& mesh) {
    const MirroredMesh& before = meshes_[change.mesh];
    std::vector<RewrittenTriangle> expected;
    for (std::uint32_t t = 0; t < std::min(before.triangles.size(), mesh.triangles.size()); ++t)
      if (mesh.triangles[t] != before.triangles[t]) expected.push_back({t, before.triangles[t]});
    EXPECT_EQ(change.rewritten, expected);
  }

  void expect_retired(const MeshChange& change, const Mesh& mesh) {
    const MirroredMesh& before = meshes_[change.mesh];
    EXPECT_TRUE(std::ranges::is_sorted(change.retired));
    for (const std::uint32_t t : change.retired) {
      ASSERT_LT(t, mesh.triangle_count());
      EXPECT_TRUE(is_retired(mesh.triangles[t]));
      if (t < before.triangles.size()) {
        EXPECT_FALSE(is_retired(before.triangles[t]));
      }
    }
    for (std::uint32_t t = 0; t < std::min(before.triangles.size(), mesh.triangles.size()); ++t)
      if (is_retired(mesh.triangles[t]) && !is_retired(before.triangles[t])) {
        EXPECT_TRUE(std::ranges::binary_search(change.retired, t));
      }
  }

  void upload(const MeshChange& change, const Mesh& mesh) {
    // The values beyond the old end of a buffer are arbitrary.
    MirroredMesh& mirrored = meshes_[change.mesh];
    mirrored.vertices.resize(mesh.vertex_count(), VertexBits(mesh, 0));
    mirrored.triangles.resize(mesh.triangle_count(), {kNone, kNone, kNone});
    mirrored.submesh.resize(mesh.triangle_count(), kNone);
    for (const IndexRange& range : change.dirty_vertices)
      for (std::uint32_t v = range.first; v < range.first + range.count; ++v)
        mirrored.vertices[v] = VertexBits(mesh, v);
    for (const IndexRange& range : change.dirty_triangles)
      for (std::uint32_t t = range.first; t < range.first + range.count; ++t) {
        mirrored.triangles[t] = mesh.triangles[t];
        mirrored.submesh[t] = mesh.triangle_submesh[t];
      }
  }

  std::vector<MirroredMesh> meshes_;
};

/// The sums in the report equal those of the record.
void expect_report_agrees(const TearReport& report, const ChangeRecord& change) {
  std::uint32_t vertices = 0, triangles = 0, retired = 0;
  for (const MeshChange& of_mesh : change.meshes) {
    vertices += of_mesh.vertex_count;
    triangles += of_mesh.triangle_count;
    retired += static_cast<std::uint32_t>(std::ranges::count_if(
        of_mesh.retired, [&](std::uint32_t t) { return t < of_mesh.first_triangle; }));
  }
  EXPECT_EQ(report.points_added, change.point_count);
  EXPECT_EQ(report.vertices_added, vertices);
  EXPECT_EQ(report.triangles_added, triangles);
  EXPECT_EQ(report.triangles_retired, retired);
}

void mirror_at_random(std::uint64_t seed) {
  SCOPED_TRACE(seed);
  Random random(seed);
  TornModel model = make_model(test::random_character(random));
  Mirror mirror(model);
  for (int i = 0; i < 12; ++i) {
    SCOPED_TRACE(i);
    ChangeRecord change;
    change.meshes.resize(3);  // whatever it contained before
    change.lips.resize(3);
    const std::uint32_t what = random.index(5);
    if (what == 0 && model.undo_count() > 0) {
      ASSERT_TRUE(model.undo(&change));
      EXPECT_EQ(change.point_count, 0u);
    } else if (what == 1 && model.redo_count() > 0) {
      ASSERT_TRUE(model.redo(&change));
    } else {
      const auto report = test::play(model, test::random_operation(model, random), &change);
      ASSERT_TRUE(report) << report.error().text();
      expect_report_agrees(*report, change);
      EXPECT_TRUE(report->runs > 0 || (change.meshes.empty() && change.lips.empty()));
    }
    mirror.apply(change, model);
    if (testing::Test::HasFailure()) return;
  }
}

class RandomChanges : public testing::TestWithParam<int> {};

TEST_P(RandomChanges, keep_a_mirror_equal) {
  const int rounds = test::stressed(1, 50);
  for (int round = 0; round < rounds && !HasFailure(); ++round)
    mirror_at_random(static_cast<std::uint64_t>(100 * round + GetParam()));
}

INSTANTIATE_TEST_SUITE_P(seeds, RandomChanges, testing::Range(0, 100));

TEST(ChangeRecord, has_a_run_if_the_first_segment_was_too_short_to_tear) { mirror_at_random(431); }
/// It turned an edge out of its way to a vertex that it only touches.
TEST(ChangeRecord, of_a_cut_that_opens_nothing_is_empty) { mirror_at_random(1603); }

TEST(ChangeRecord, of_a_strokes_pieces_keep_a_mirror_equal) {
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    SCOPED_TRACE(seed);
    Random random(seed);
    TornModel model = make_model(test::random_character(random));
    Mirror mirror(model);
    const TearOperation tear = test::random_tear(model, random, seed % 2 == 1);
    const auto& pose = std::get<ModelPose>(tear.pose);
    auto stroke = TearStroke::create(model, pose, tear.stroke[0], tear.options);
    ASSERT_TRUE(stroke) << stroke.error().text();
    for (std::size_t i = 1; i < tear.stroke.size(); ++i) {
      ChangeRecord change;
      const auto report = stroke->extend(pose, tear.stroke[i], 0.0, &change);
      ASSERT_TRUE(report) << report.error().text();
      expect_report_agrees(*report, change);
      mirror.apply(change, model);
    }
    ChangeRecord change;
    ASSERT_TRUE(stroke->end(&change));
    mirror.apply(change, model);
    if (model.undo_count() > 0) {
      ASSERT_TRUE(model.undo(&change));
      mirror.apply(change, model);
      ASSERT_TRUE(model.redo(&change));
      mirror.apply(change, model);
    }
  }
}

TEST(ChangeRecord, of_a_cancelled_stroke_restores_a_mirror) {
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    SCOPED_TRACE(seed);
    Random random(seed);
    TornModel model = make_model(test::random_character(random));
    ASSERT_TRUE(test::play(model, test::random_operation(model, random)));
    Mirror mirror(model);
    const TearOperation tear = test::random_tear(model, random, seed % 2 == 1);
    const auto& pose = std::get<ModelPose>(tear.pose);
    auto stroke = TearStroke::create(model, pose, tear.stroke[0], tear.options);
    ASSERT_TRUE(stroke) << stroke.error().text();
    ChangeRecord change;
    for (std::size_t i = 1; i < tear.stroke.size(); ++i) {
      ASSERT_TRUE(stroke->extend(pose, tear.stroke[i], 0.0, &change));
      mirror.apply(change, model);
    }
    ASSERT_TRUE(stroke->cancel(&change));
    EXPECT_TRUE(change.lips.empty() && change.rims.left.empty() && change.rims.right.empty());
    mirror.apply(change, model);
  }
}

TEST(ChangeRecord, lists_lips_in_the_order_of_the_stroke) {
  TornModel model = make_model(test::make_tube(12, 24, 3));
  // Upwards across the seam on the tube's +x side.
  Stroke stroke;
  for (int i = 0; i <= 6; ++i) {
    const double part = i / 6.0, z = 0.3 * (part - 0.5);
    stroke.push_back({{3, 0.23 + 1.4 * part, z}, {0.2, 0.23 + 1.4 * part, z}});
  }
  ChangeRecord change;
  const auto report = model.tear(*bind_pose(model.source()), stroke, {}, &change);
  ASSERT_TRUE(report) << report.error().text();
  ASSERT_EQ(report->runs, 1u);
  ASSERT_GT(change.lips.size(), 15u);
  const test::ModelState state = test::state_of(model);
  std::vector<float> heights(state.point_count);
  const Mesh& mesh = state.character.meshes[0];
  for (std::size_t corner = 0; corner < state.meshes[0].points.size(); ++corner)
    heights[state.meshes[0].points[corner]] =
        mesh.positions[mesh.triangles[corner / 3][corner % 3]].y();
  for (std::size_t i = 1; i < change.lips.size(); ++i)
    EXPECT_GT(heights[change.lips[i].left], heights[change.lips[i - 1].left]) << i;
}

}  // namespace
}  // namespace sunder
