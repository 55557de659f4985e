// Points weighed by each policy: their positions, independence of the topology, and undo.

#include <sunder/skinning/deform.h>
#include <sunder/skinning/skinned_mesh.h>
#include <sunder/tear/tear_stroke.h>
#include <sunder/tear/torn_model.h>
#include <sunder/tear/torn_weights.h>

#include <gtest/gtest.h>

#include "skinning/internal/reference.h"
#include "support/models/make_model.h"
#include "support/models/random_operations.h"
#include "support/models/rigs.h"
#include "support/oracles/model_state.h"
#include "support/oracles/torn_invariants.h"

namespace sunder {
namespace {

constexpr WeightOptions kBarycentric = {};
constexpr WeightOptions kBarycentric4 = {WeightPolicy::barycentric, 4};
constexpr WeightOptions kBarycentric2 = {WeightPolicy::barycentric, 2};
constexpr WeightOptions kPoseExact = {WeightPolicy::pose_exact, 0};
constexpr WeightOptions kPoseExact4 = {WeightPolicy::pose_exact, 4};
constexpr WeightOptions kRefit4 = {WeightPolicy::refit, 4};
constexpr WeightOptions kExact = {WeightPolicy::exact, 0};
constexpr std::array kAll = {kBarycentric, kBarycentric4, kBarycentric2, kPoseExact,
                             kPoseExact4,  kRefit4,       kExact};

TornModel torn(const std::shared_ptr<const Character>& source,
               const std::vector<Operation>& operations, const WeightOptions& weights) {
  auto model = TornModel::create(source);
  EXPECT_TRUE(model);
  EXPECT_TRUE(model->set_weights(weights));
  for (const Operation& operation : operations) {
    const auto report = apply_operation(*model, operation);
    EXPECT_TRUE(report) << report.error().text();
  }
  return std::move(*model);
}

/// A character and operations on it, in several poses.
struct Case {
  explicit Case(int seed) {
    test::Random random(static_cast<std::uint64_t>(seed));
    source = std::make_shared<const Character>(seed % 3 == 0 ? test::random_character(random)
                                                             : test::make_tube(14, 18, 5));
    auto model = TornModel::create(source);
    for (int i = 0; i < 4; ++i) {
      operations.push_back(test::random_operation(*model, random));
      (void)apply_operation(*model, operations.back());
    }
    for (int i = 0; i < 4; ++i) poses.push_back(test::random_pose(*source, random, 0.9));
  }

  std::shared_ptr<const Character> source;
  std::vector<Operation> operations;
  std::vector<ModelPose> poses;
};

class WeightPolicies : public testing::TestWithParam<int> {};
INSTANTIATE_TEST_SUITE_P(seeds, WeightPolicies, testing::Range(1, 31));

TEST_P(WeightPolicies, do_not_decide_where_tears_run) {
  const Case of(GetParam());
  const TornModel plain = torn(of.source, of.operations, kBarycentric);
  for (const WeightOptions& weights : kAll) {
    const TornModel model = torn(of.source, of.operations, weights);
    for (std::uint32_t m = 0; m < of.source->meshes.size(); ++m) {
      const Mesh &a = plain.character().meshes[m], &b = model.character().meshes[m];
      ASSERT_EQ(a.triangles, b.triangles);
      ASSERT_EQ(a.uv_sets, b.uv_sets);
      ASSERT_EQ(a.vertex_count(), b.vertex_count());
      for (std::uint32_t v = of.source->meshes[m].vertex_count(); v < a.vertex_count(); ++v)
        ASSERT_TRUE(test::are_same(plain.birth(m, v), model.birth(m, v)));
    }
    EXPECT_EQ(plain.point_count(), model.point_count());
  }
}

TEST_P(WeightPolicies, keep_the_laws) {
  const Case of(GetParam());
  for (const WeightOptions& weights : kAll) {
    const TornModel model = torn(of.source, of.operations, weights);
    ASSERT_TRUE(validate_character(model.character()))
        << validate_character(model.character()).text();
    for (std::uint32_t m = 0; m < of.source->meshes.size(); ++m) {
      const Mesh& mesh = model.character().meshes[m];
      for (std::uint32_t v = of.source->meshes[m].vertex_count(); v < mesh.vertex_count(); ++v) {
        double sum = 0;
        for (const Influence& influence : mesh.weights.of(v))
          sum += static_cast<double>(influence.weight);
        ASSERT_NEAR(sum, 1, 2e-7 * static_cast<double>(mesh.weights.of(v).size()));
        const bool is_limited = weights.maximum_influences != 0 &&
                                weights.policy != WeightPolicy::barycentric &&
                                model.weight_policy(m, v) == weights.policy;
        if (is_limited) {
          ASSERT_LE(mesh.weights.of(v).size(), weights.maximum_influences);
        }
      }
    }
    if (test::is_clear_of_itself(*of.source)) {
      EXPECT_EQ(test::broken_surface(model), std::vector<std::string>());
    }
  }
}

TEST_P(WeightPolicies, exact_points_are_on_the_untorn_surface_in_every_pose) {
  const Case of(GetParam());
  const TornModel model = torn(of.source, of.operations, kExact);
  if (model.undo_count() == 0) return;
  const auto errors = measure_weight_errors(model, 0, kNone, of.poses);
  ASSERT_TRUE(errors) << errors.error().text();
  EXPECT_LE(errors->of_diagonal.maximum, 2e-7);
  const auto barycentric =
      measure_weight_errors(torn(of.source, of.operations, kBarycentric), 0, kNone, of.poses);
  ASSERT_TRUE(barycentric);
  ASSERT_EQ(barycentric->points.size(), errors->points.size());
}

TEST_P(WeightPolicies, exact_points_are_posed_by_the_runtime) {
  const Case of(GetParam());
  const TornModel model = torn(of.source, of.operations, kExact);
  for (std::uint32_t m = 0; m < of.source->meshes.size(); ++m) {
    const Mesh& mesh = model.character().meshes[m];
    const Mesh& source = of.source->meshes[m];
    const Skin& skin = of.source->skins[mesh.skin];
    VertexSource vertices = source_of(mesh);
    vertices.per_influence = &model.influence_positions(m);
    const auto runtime = SkinnedMesh::create(vertices, skin.bones.size());
    ASSERT_TRUE(runtime) << runtime.error().text();
    BonePalette palette =
        *BonePalette::create(skin.bones.size(), of.source->rest_morph_weights.size());
    std::vector<Vec3f> positions(mesh.vertex_count());
    VertexTarget target;
    target.vertex_count = mesh.vertex_count();
    target.positions.data = positions[0].data();
    PosedBuffer buffer(target);
    for (const ModelPose& pose : of.poses) {
      ASSERT_TRUE(palette.set(skin, pose));
      ASSERT_TRUE(runtime->deform(palette, buffer));
      std::vector<Affine3d> matrices(skin.bones.size());
      ASSERT_TRUE(compute_palette(skin, pose, matrices));
      const double diagonal = test::posed_diagonal(*of.source, pose);
      for (std::uint32_t v = source.vertex_count(); v < mesh.vertex_count(); ++v) {
        const Birth birth = model.birth(m, v);
        if (birth.triangle >= source.triangle_count()) continue;
        Vec3d expected = Vec3d::Zero();
        for (std::size_t k = 0; k < 3; ++k)
          expected += birth.barycentric[k] *
                      deform_position_reference(source, source.triangles[birth.triangle][k],
                                                matrices, pose.morph_weights);
        ASSERT_LT((positions[v].cast<double>() - expected).norm(), 1e-6 * diagonal)
            << "vertex " << v;
      }
    }
  }
}

TEST_P(WeightPolicies, pose_exact_points_are_on_the_untorn_surface_in_the_pose_of_the_tear) {
  test::Random random(static_cast<std::uint64_t>(GetParam()));
  const auto source = std::make_shared<const Character>(test::make_tube(16, 20, 5));
  for (const WeightOptions& weights : {kPoseExact, kPoseExact4}) {
    auto model = test::make_model(*source);
    const ModelPose pose = test::random_pose(*source, random, 0.7);
    TearOptions options;
    options.weights = weights;
    const auto report = model.tear(pose, test::random_stroke(*source, pose, random), options);
    ASSERT_TRUE(report);
    if (report->runs == 0) continue;
    const auto errors = measure_weight_errors(model, 0, kNone, {&pose, 1});
    ASSERT_TRUE(errors);
    EXPECT_EQ(report->weights.points, errors->points.size());
    const auto off = std::ranges::count_if(errors->points, [&](const auto& point) {
      return point.maximum > 1e-6 * test::posed_diagonal(*source, pose);
    });
    EXPECT_LE(off, report->weights.ill_conditioned);
    EXPECT_LT(report->weights.ill_conditioned, std::max(1u, report->weights.points / 2));
  }
}

TEST_P(WeightPolicies, undo_and_redo_give_back_every_state) {
  const Case of(GetParam());
  for (const WeightOptions& weights : {kBarycentric2, kPoseExact, kExact}) {
    auto model = TornModel::create(of.source);
    ASSERT_TRUE(model->set_weights(weights));
    std::vector<std::uint64_t> digests = {model->digest()};
    std::vector<InfluencePositions> exact;
    for (const Operation& operation : of.operations) {
      const std::uint32_t before = model->undo_count();
      ASSERT_TRUE(apply_operation(*model, operation));
      if (model->undo_count() > before) digests.push_back(model->digest());
    }
    const std::uint32_t done = model->undo_count();
    const InfluencePositions last = model->influence_positions(0);
    for (std::uint32_t i = done; i-- > 0;) {
      ASSERT_TRUE(model->undo());
      ASSERT_EQ(model->digest(), digests[i]);
    }
    EXPECT_TRUE(model->influence_positions(0).vertices.empty());
    for (std::uint32_t i = 1; i <= done; ++i) {
      ASSERT_TRUE(model->redo());
      ASSERT_EQ(model->digest(), digests[i]);
    }
    EXPECT_EQ(model->influence_positions(0).vertices, last.vertices);
    EXPECT_EQ(model->influence_positions(0).positions, last.positions);
    EXPECT_EQ(model->influence_positions(0).normals, last.normals);
  }
}

TEST_P(WeightPolicies, history_gives_the_model_again) {
  const Case of(GetParam());
  for (const WeightOptions& weights : kAll) {
    TornModel model = torn(of.source, of.operations, weights);
    if (model.undo_count() == 0) return;
    WeightsOperation wanted;
    wanted.weights = kPoseExact4;
    wanted.pose = of.poses[0];
    ASSERT_TRUE(model.reweigh(wanted));
    const TornModel again = torn(of.source, *model.history(), kBarycentric);
    EXPECT_EQ(again.digest(), model.digest());
  }
}

TEST_P(WeightPolicies, reweighing_equals_weighing_from_the_start) {
  const Case of(GetParam());
  for (const WeightOptions& from : kAll)
    for (const WeightOptions& to : {kBarycentric, kBarycentric4, kExact}) {
      TornModel model = torn(of.source, of.operations, from);
      if (model.undo_count() == 0) return;
      const auto before = model.digest();
      WeightsOperation wanted;
      wanted.weights = to;
      ChangeRecord change;
      const auto report = model.reweigh(wanted, &change);
      ASSERT_TRUE(report) << report.error().text();
      const TornModel expected = torn(of.source, of.operations, to);
      EXPECT_EQ(model.digest(), expected.digest());
      for (std::uint32_t m = 0; m < of.source->meshes.size(); ++m)
        EXPECT_EQ(model.influence_positions(m).positions,
                  expected.influence_positions(m).positions);
      const auto after = model.digest();
      ASSERT_TRUE(model.undo(&change));
      EXPECT_EQ(model.digest(), before);
      ASSERT_TRUE(model.redo(&change));
      EXPECT_EQ(model.digest(), after);
    }
}

TEST_P(WeightPolicies, later_operations_do_not_depend_on_weights) {
  const Case of(GetParam());
  for (const WeightOptions& weights : {kPoseExact4, kExact}) {
    auto model = TornModel::create(of.source);
    for (std::size_t i = 0; i < of.operations.size(); ++i) {
      ASSERT_TRUE(apply_operation(*model, of.operations[i]));
      WeightsOperation wanted;
      wanted.weights = weights;
      wanted.pose = of.poses[i];
      if (model->undo_count() == 0) continue;
      ASSERT_TRUE(model->reweigh(wanted));
    }
    const TornModel plain = torn(of.source, of.operations, kBarycentric);
    for (std::uint32_t m = 0; m < of.source->meshes.size(); ++m) {
      ASSERT_EQ(model->character().meshes[m].triangles, plain.character().meshes[m].triangles);
      for (std::uint32_t v = of.source->meshes[m].vertex_count();
           v < plain.character().meshes[m].vertex_count(); ++v)
        ASSERT_TRUE(test::are_same(plain.birth(m, v), model->birth(m, v)));
    }
    if (model->undo_count() == 0) continue;
    WeightsOperation back;
    ASSERT_TRUE(model->reweigh(back));
    EXPECT_EQ(model->digest(), plain.digest());
  }
}

TEST(WeightPolicy, lips_have_the_same_bits) {
  for (const WeightOptions& weights : kAll) {
    test::Random random(5);
    auto model = test::make_model(test::make_tube(20, 24, 6));
    const ModelPose pose = test::random_pose(model.source(), random, 0.8);
    TearOptions options;
    options.weights = weights;
    ChangeRecord change;
    ASSERT_TRUE(model.tear(pose, test::random_stroke(model.source(), pose, random, 0.4, 4), options,
                           &change));
    ASSERT_FALSE(change.lips.empty());
    EXPECT_EQ(test::broken_lips(model, change), std::vector<std::string>());
  }
}

TEST(WeightPolicy, of_an_operation_overrides_that_of_the_model) {
  test::Random random(2);
  auto model = test::make_model(test::make_tube(20, 24, 6));
  ASSERT_TRUE(model.set_weights(kExact));
  const ModelPose pose = test::random_pose(model.source(), random, 0.8);
  TearOptions options;
  options.weights = kPoseExact4;
  ASSERT_TRUE(model.tear(pose, test::random_stroke(model.source(), pose, random), options));
  EXPECT_TRUE(model.influence_positions(0).vertices.empty());
  ASSERT_TRUE(model.tear(pose, test::random_stroke(model.source(), pose, random)));
  EXPECT_FALSE(model.influence_positions(0).vertices.empty());
}

TEST(WeightPolicy, a_stroke_blade_by_blade_is_that_of_all_its_blades) {
  for (const WeightOptions& weights : kAll) {
    test::Random random(9);
    const auto source = std::make_shared<const Character>(test::make_tube(20, 24, 6));
    const ModelPose pose = test::random_pose(*source, random, 0.8);
    const Stroke stroke = test::random_stroke(*source, pose, random, 0.5, 5);
    TearOptions options;
    options.weights = weights;
    auto whole = TornModel::create(source), parts = TornModel::create(source);
    const auto of_whole = whole->tear(pose, stroke, options);
    ASSERT_TRUE(of_whole);
    auto live = TearStroke::create(*parts, pose, stroke[0], options);
    ASSERT_TRUE(live);
    for (std::size_t i = 1; i < stroke.size(); ++i) ASSERT_TRUE(live->extend(pose, stroke[i]));
    const auto of_parts = live->end();
    ASSERT_TRUE(of_parts);
    const auto a = measure_weight_errors(*whole, 0, kNone, {&pose, 1}),
               b = measure_weight_errors(*parts, 0, kNone, {&pose, 1});
    ASSERT_TRUE(a && b);
    ASSERT_EQ(a->points.size(), b->points.size());
    EXPECT_NEAR(a->metres.rms, b->metres.rms, 1e-9);
    EXPECT_EQ(of_whole->weights.points, of_parts->weights.points);
  }
}

TEST(WeightPolicy, invalid_options_are_refused_and_change_nothing) {
  test::Random random(3);
  auto model = test::make_model(test::make_tube(12, 12, 4));
  const ModelPose pose = test::random_pose(model.source(), random);
  const Stroke stroke = test::random_stroke(model.source(), pose, random);
  const auto digest = model.digest();
  TearOptions options;
  options.weights = WeightOptions{WeightPolicy::exact, 4};
  EXPECT_EQ(model.tear(pose, stroke, options).error().code(), StatusCode::invalid_argument);
  options.weights = WeightOptions{static_cast<WeightPolicy>(9), 0};
  EXPECT_EQ(model.tear(pose, stroke, options).error().code(), StatusCode::invalid_argument);
  EXPECT_EQ(model.set_weights(*options.weights).code(), StatusCode::invalid_argument);
  WeightsOperation wanted;
  EXPECT_EQ(model.reweigh(wanted).error().code(), StatusCode::not_found) << "nothing was done yet";
  ASSERT_TRUE(model.tear(pose, stroke));
  const auto torn_digest = model.digest();
  EXPECT_NE(digest, torn_digest);
  wanted.first_operation = 1;
  EXPECT_EQ(model.reweigh(wanted).error().code(), StatusCode::not_found);
  wanted.first_operation = 0;
  wanted.operation_count = 2;
  EXPECT_EQ(model.reweigh(wanted).error().code(), StatusCode::not_found);
  wanted.operation_count = 0;
  EXPECT_EQ(model.reweigh(wanted).error().code(), StatusCode::not_found);
  wanted.operation_count = 1;
  wanted.weights = kPoseExact;
  ModelPose bad = pose;
  bad.model_from_bone[1].translation().x() = std::numeric_limits<double>::quiet_NaN();
  wanted.pose = bad;
  EXPECT_EQ(model.reweigh(wanted).error().code(), StatusCode::non_finite_value);
  wanted.pose = ClipPose{"no such clip", 0};
  EXPECT_EQ(model.reweigh(wanted).error().code(), StatusCode::not_found);
  EXPECT_EQ(model.digest(), torn_digest);
  EXPECT_EQ(model.undo_count(), 1u);
  EXPECT_EQ(measure_weight_errors(model, 4, 1, {}).error().code(), StatusCode::not_found);
  EXPECT_EQ(measure_weight_errors(model, 0, 1, {&bad, 1}).error().code(),
            StatusCode::non_finite_value);
}

TEST(WeightPolicy, exact_and_interpolated_models_have_different_digests) {
  test::Random random(3);
  const auto source = std::make_shared<const Character>(test::make_tube(12, 12, 4));
  const ModelPose pose = test::random_pose(*source, random);
  const Stroke stroke = test::random_stroke(*source, pose, random);
  auto a = TornModel::create(source), b = TornModel::create(source);
  ASSERT_TRUE(b->set_weights(kExact));
  ASSERT_TRUE(a->tear(pose, stroke));
  ASSERT_TRUE(b->tear(pose, stroke));
  EXPECT_NE(a->digest(), b->digest());
}

TEST(WeightPolicy, a_model_of_fixed_capacity_weighs_too) {
  test::Random random(4);
  auto model = test::make_model(test::make_tube(20, 24, 6), {4000, 8000, 20});
  const ModelPose pose = test::random_pose(model.source(), random, 0.8);
  for (const WeightOptions& weights : kAll) {
    TearOptions options;
    options.weights = weights;
    const auto report =
        model.tear(pose, test::random_stroke(model.source(), pose, random), options);
    ASSERT_TRUE(report) << report.error().text();
  }
  WeightsOperation wanted;
  ASSERT_TRUE(model.reweigh(wanted));
}

}  // namespace
}  // namespace sunder
