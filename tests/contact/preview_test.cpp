// A preview says what the operation then does, and leaves no trace.

#include <sunder/skinning/pose.h>
#include <sunder/tear/preview.h>
#include <sunder/tear/tear_stroke.h>

#if defined(__GLIBC__)
#include <malloc.h>
#endif

#include <algorithm>
#include <cmath>
#include <set>

#include <gtest/gtest.h>

#include "support/machine/stress.h"
#include "support/models/make_model.h"
#include "support/models/random_operations.h"
#include "support/models/rigs.h"
#include "support/oracles/contact_oracle.h"
#include "support/oracles/model_state.h"

namespace sunder {
namespace {

using test::Random;

Result<OperationPreview> preview_of(const TornModel& model, const Operation& operation) {
  if (const auto* tear = std::get_if<TearOperation>(&operation))
    return preview_tear(model, std::get<ModelPose>(tear->pose), tear->stroke, tear->options);
  if (const auto* cut = std::get_if<CutOperation>(&operation))
    return preview_cut(model, std::get<ModelPose>(cut->pose), cut->cut);
  const auto& drill = std::get<DrillOperation>(operation);
  return preview_drill(model, std::get<ModelPose>(drill.pose), drill.bore);
}

void expect_equal(const TearReport& a, const TearReport& b) {
  EXPECT_EQ(a.runs, b.runs);
  EXPECT_EQ(a.segments, b.segments);
  EXPECT_EQ(a.segments_missed, b.segments_missed);
  EXPECT_EQ(a.faces_crossed, b.faces_crossed);
  EXPECT_EQ(a.points_added, b.points_added);
  EXPECT_EQ(a.vertices_added, b.vertices_added);
  EXPECT_EQ(a.triangles_added, b.triangles_added);
  EXPECT_EQ(a.triangles_retired, b.triangles_retired);
  EXPECT_EQ(a.blocked, b.blocked);
  EXPECT_EQ(a.length_posed, b.length_posed);
  EXPECT_EQ(a.area_removed_posed, b.area_removed_posed);
  EXPECT_EQ(a.caps, b.caps);
  EXPECT_EQ(a.open_sections, b.open_sections);
  EXPECT_EQ(a.weights.points, b.weights.points);
  ASSERT_EQ(a.pieces.size(), b.pieces.size());
  for (std::size_t i = 0; i < a.pieces.size(); ++i) {
    EXPECT_EQ(a.pieces[i].triangle_count, b.pieces[i].triangle_count);
    EXPECT_EQ(a.pieces[i].mesh, b.pieces[i].mesh);
    EXPECT_EQ(a.pieces[i].triangle, b.pieces[i].triangle);
    EXPECT_EQ(a.pieces[i].component, b.pieces[i].component);
    EXPECT_EQ(a.pieces[i].is_body, b.pieces[i].is_body);
  }
}

/// Half of the length of all borders in bind space.
double border_length(const TornModel& model) {
  double length = 0;
  for (std::uint32_t m = 0; m < model.character().meshes.size(); ++m) {
    const Mesh& mesh = model.character().meshes[m];
    std::multiset<std::pair<std::uint32_t, std::uint32_t>> edges;
    std::vector<std::array<std::uint32_t, 4>> all;  // points and vertices
    for (std::uint32_t t = 0; t < mesh.triangle_count(); ++t) {
      if (is_retired(mesh.triangles[t])) continue;
      for (std::uint32_t k = 0; k < 3; ++k) {
        const std::uint32_t a = model.point_at(m, t, k), b = model.point_at(m, t, (k + 1) % 3);
        edges.insert({a, b});
        all.push_back({a, b, mesh.triangles[t][k], mesh.triangles[t][(k + 1) % 3]});
      }
    }
    for (const auto& [a, b, v, w] : all)
      if (edges.count({b, a}) == 0)
        length += (mesh.positions[v] - mesh.positions[w]).cast<double>().norm();
  }
  return 0.5 * length;
}

TEST(Preview, it_says_what_the_operation_then_does) {
  std::size_t torn = 0, missed = 0;
  for (int seed = 0; seed < test::stressed(120, 20); ++seed) {
    Random random(seed);
    const Character character = random.index(3) == 0
                                    ? test::make_bumpy_ball(100 + random.index(200))
                                    : test::random_character(random);
    TornModel model = test::make_model(character);
    for (std::uint32_t before = random.index(3); before > 0; --before)
      ASSERT_TRUE(test::play(model, test::random_operation(model, random)));
    const bool has_redo = model.undo_count() > 0 && random.index(2) == 0;
    if (has_redo) {
      ASSERT_TRUE(model.undo());
    }
    const std::uint32_t undos = model.undo_count(), redos = model.redo_count();
    const std::uint64_t newest = model.newest_operation();
    const test::ModelState before = test::state_of(model);

    const Operation operation = test::random_operation(model, random);
    const auto preview = preview_of(model, operation);
    ASSERT_TRUE(preview) << preview.error().text();
    EXPECT_EQ(test::difference(test::state_of(model), before), "") << seed;
    EXPECT_EQ(model.undo_count(), undos);
    EXPECT_EQ(model.redo_count(), redos);
    EXPECT_EQ(model.newest_operation(), newest);
    if (has_redo && random.index(2) == 0) {  // the redo stack still works
      ASSERT_TRUE(model.redo());
      ASSERT_TRUE(model.undo());
      EXPECT_EQ(test::difference(test::state_of(model), before), "") << seed;
    }

    const auto report = test::play(model, operation);
    ASSERT_TRUE(report);
    expect_equal(preview->report, *report);
    (report->runs > 0 ? torn : missed) += 1;
    EXPECT_EQ(preview->meshes.empty(), report->runs == 0);
    EXPECT_EQ(preview->bones.empty(), report->runs == 0);
    if (report->runs > 0) {
      EXPECT_EQ(preview->miss_distance, 0);
    }
    // A model that never saw the preview becomes the same.
    if (undos == 0 && report->runs > 0) {
      TornModel other = test::make_model(character);
      ASSERT_TRUE(test::play(other, operation));
      EXPECT_EQ(other.digest(), model.digest());
    }
  }
  EXPECT_GT(torn, 60u);
}

TEST(Preview, the_length_in_bind_space_is_that_of_the_borders) {
  for (int seed = 0; seed < test::stressed(40, 20); ++seed) {
    Random random(500 + seed);
    const Character tube = test::make_tube(6, 9, 3);
    TornModel model = test::make_model(tube);
    const Operation operation = test::random_operation(model, random);
    const bool is_closed = std::visit(
        [](const auto& of) {
          using Kind = std::decay_t<decltype(of)>;
          if constexpr (std::is_same_v<Kind, TearOperation>) return of.options.wall_depth > 0;
          if constexpr (std::is_same_v<Kind, CutOperation>) return of.cut.caps;
          if constexpr (std::is_same_v<Kind, DrillOperation>) return of.bore.wall;
          return false;
        },
        operation);
    const auto preview = preview_of(model, operation);
    ASSERT_TRUE(preview);
    ASSERT_TRUE(test::play(model, operation));
    if (is_closed) continue;  // then there are no borders
    EXPECT_NEAR(preview->length_bind, border_length(model), 1e-6) << seed;
  }
}

TEST(Preview, it_counts_layers_and_measures_a_miss) {
  const Character tube = test::make_tube(12, 16, 3);
  const TornModel model = test::make_model(tube);
  const ModelPose pose = *bind_pose(tube);
  std::vector<std::vector<Vec3d>> positions = {test::posed_positions(tube, 0, pose)};
  double radius = 0;
  for (const Vec3d& position : positions[0])
    radius = std::max(radius, std::hypot(position.x(), position.z()));
  const auto across = [&](double y, double end) -> Blade {
    return {{3 * radius, y, 0.01}, {end, y, 0.01}};
  };
  const double middle = 0.5 * test::posed_diagonal(tube, pose) * 0.5;
  TearOptions all;
  all.layers = Layers::all;
  const Stroke through = {across(middle, -3 * radius), across(middle + 0.1, -3 * radius)};
  const auto layers = preview_tear(model, pose, through, all);
  ASSERT_TRUE(layers);
  EXPECT_EQ(layers->layers, 1u) << "it enters once and leaves once";
  EXPECT_EQ(layers->report.runs, 2u);
  EXPECT_EQ(layers->meshes, std::vector<std::uint32_t>{0});

  const Stroke beside = {across(middle, 1.5 * radius), across(middle + 0.1, 1.5 * radius)};
  const auto miss = preview_tear(model, pose, beside);
  ASSERT_TRUE(miss);
  EXPECT_EQ(miss->report.runs, 0u);
  EXPECT_EQ(miss->layers, 0u);
  EXPECT_TRUE(miss->bones.empty());
  const test::ContactOracle oracle(tube, positions);
  double distance = 1e9;  // a flat sweep, straight: the least over blades close together
  for (int i = 0; i <= 200; ++i) {
    const Blade at = across(middle + 0.1 * i / 200, 1.5 * radius);
    distance = std::min(distance, oracle.distance(at.base, at.tip));
  }
  EXPECT_NEAR(miss->miss_distance, distance, 1e-4 * radius);

  Bore short_bore;
  short_bore.origin = {3 * radius, middle, 0};
  short_bore.direction = {-1, 0, 0};
  short_bore.radius = 0.01;
  short_bore.depth = radius;
  const auto bore = preview_drill(model, pose, short_bore);
  ASSERT_TRUE(bore);
  EXPECT_EQ(bore->report.runs, 0u);
  const Vec3d origin(3 * radius, middle, 0), end(2 * radius, middle, 0);
  EXPECT_NEAR(bore->miss_distance, oracle.distance(origin, end), 1e-9);
}

TEST(Preview, it_returns_the_errors_of_the_operation) {
  const Character sheet = test::make_sheet(4);
  TornModel model = test::make_model(sheet);
  const ModelPose pose = *bind_pose(sheet);
  const Stroke stroke = {test::down_at(0.2, 0.5), test::down_at(0.8, 0.5)};
  EXPECT_EQ(preview_tear(model, pose, {}).error().code(), StatusCode::invalid_argument);
  ModelPose other = pose;
  other.model_from_bone.pop_back();
  EXPECT_EQ(preview_tear(model, other, stroke).error().code(), StatusCode::size_mismatch);
  PlaneCut cut;
  cut.normal = {0, 0, 0};
  EXPECT_EQ(preview_cut(model, pose, cut).error().code(), StatusCode::invalid_argument);
  EXPECT_EQ(preview_drill(model, pose, Bore()).error().code(), StatusCode::invalid_argument);
  auto under_way = TearStroke::create(model, pose, stroke[0]);
  ASSERT_TRUE(under_way);
  EXPECT_EQ(preview_tear(model, pose, stroke).error().code(), StatusCode::invalid_argument);
  ASSERT_TRUE(under_way->extend(pose, stroke[1]));
  ASSERT_TRUE(under_way->end());

  const TornModel full = test::make_model(sheet, {2, 2, 1});
  const auto digest = full.digest();
  EXPECT_EQ(preview_tear(full, pose, stroke).error().code(), StatusCode::capacity_exceeded);
  EXPECT_EQ(full.digest(), digest);
}

#if defined(__GLIBC__)
/// Its memory serves the next one.
TEST(Preview, memory_does_not_grow_with_the_number_of_previews) {
  Random random(1);
  const Character tube = test::make_tube(20, 40, 5);
  const TornModel model = test::make_model(tube);
  const ModelPose pose = test::random_pose(tube, random);
  const Stroke stroke = test::random_stroke(tube, pose, random);
  const auto bytes_after = [&](int previews) {
    for (int i = 0; i < previews; ++i) EXPECT_TRUE(preview_tear(model, pose, stroke));
    const struct mallinfo2 info = mallinfo2();
    return info.uordblks + info.hblkhd;
  };
  const std::size_t warm = bytes_after(4);
  EXPECT_EQ(bytes_after(20), warm);
}
#endif

/// With a fixed capacity a preview takes none of it.
TEST(Preview, it_uses_up_no_capacity) {
  const Character sheet = test::make_sheet(10);
  TornModel model = test::make_model(sheet, {200, 200, 2});
  const ModelPose pose = *bind_pose(sheet);
  const Stroke stroke = {test::down_at(0.2, 0.53), test::down_at(0.8, 0.56)};
  for (int i = 0; i < 50; ++i) {
    const auto preview = preview_tear(model, pose, stroke);
    ASSERT_TRUE(preview) << preview.error().text();
    ASSERT_GT(preview->report.faces_crossed, 0u);
  }
  ASSERT_TRUE(model.tear(pose, stroke));
}

}  // namespace
}  // namespace sunder
