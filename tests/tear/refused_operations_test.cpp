// Arguments that no operation takes: each is refused with the error that the interface documents,
// and the model stays as it was.

#include <sunder/skinning/pose.h>
#include <sunder/tear/tear_stroke.h>
#include <sunder/tear/torn_model.h>

#include <functional>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include "support/models/make_model.h"
#include "support/models/rigs.h"
#include "support/oracles/model_state.h"

namespace sunder {
namespace {

using test::down_at;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kFar = 1e61;

struct Refusal {
  const char* name;
  StatusCode code;
  std::function<Status(TornModel&, const ModelPose&)> call;
};

Refusal cut(const char* name, StatusCode code, std::function<void(PlaneCut&)> spoil) {
  return {name, code, [spoil](TornModel& model, const ModelPose& pose) {
            PlaneCut cut;
            cut.point = Vec3d(0.5, 0.5, 0);
            cut.normal = Vec3d(1, 0, 0);
            cut.bounds = {{0.5, 0, -1}, {0.5, 1, -1}, {0.5, 1, 1}, {0.5, 0, 1}};
            spoil(cut);
            return model.cut(pose, cut).error();
          }};
}

Refusal drill(const char* name, StatusCode code, std::function<void(Bore&)> spoil) {
  return {name, code, [spoil](TornModel& model, const ModelPose& pose) {
            Bore bore;
            bore.origin = Vec3d(0.5, 0.5, 1);
            bore.direction = Vec3d(0, 0, -1);
            bore.radius = 0.1;
            bore.depth = 2;
            spoil(bore);
            return model.drill(pose, bore).error();
          }};
}

Refusal tear(const char* name, StatusCode code, std::function<void(TearOperation&)> spoil) {
  return {name, code, [spoil](TornModel& model, const ModelPose& pose) {
            TearOperation tear;
            tear.stroke = {down_at(0.3, 0.3), down_at(0.5, 0.4)};
            spoil(tear);
            return model.tear(pose, tear.stroke, tear.options).error();
          }};
}

Refusal sampled(const char* name, StatusCode code, StrokeSampling sampling) {
  return {name, code, [sampling](TornModel& model, const ModelPose& pose) {
            return TearStroke::create(model, pose, down_at(0.3, 0.3), {}, sampling).error();
          }};
}

class RefusedOperation : public testing::TestWithParam<Refusal> {};

TEST_P(RefusedOperation, changes_nothing) {
  TornModel model = test::make_model(test::make_sheet(6));
  const ModelPose pose = *bind_pose(model.source());
  ASSERT_TRUE(model.tear(pose, Stroke{down_at(0.2, 0.2), down_at(0.4, 0.3)}));
  ASSERT_TRUE(model.tear(pose, Stroke{down_at(0.6, 0.6), down_at(0.8, 0.7)}));
  ASSERT_TRUE(model.undo());
  const test::ModelState before = test::state_of(model);
  const Status status = GetParam().call(model, pose);
  EXPECT_EQ(status.code(), GetParam().code) << status.text();
  EXPECT_FALSE(status.text().empty());
  EXPECT_EQ(test::difference(test::state_of(model), before), "");
  EXPECT_EQ(model.undo_count(), 1u);
  EXPECT_EQ(model.redo_count(), 1u);
}

constexpr StatusCode kInvalid = StatusCode::invalid_argument,
                     kNotFinite = StatusCode::non_finite_value;

std::vector<Refusal> refusals() {
  return {
      cut("far_plane", kInvalid, [](PlaneCut& c) { c.point.x() = kFar; }),
      cut("normal_of_nan", kNotFinite, [](PlaneCut& c) { c.normal.y() = kNan; }),
      cut("two_corners", kInvalid, [](PlaneCut& c) { c.bounds.resize(2); }),
      cut("corner_of_nan", kNotFinite, [](PlaneCut& c) { c.bounds[1].z() = kNan; }),
      cut("far_corner", kInvalid, [](PlaneCut& c) { c.bounds[1].z() = -kFar; }),
      cut("bounds_that_cross_themselves", kInvalid,
          [](PlaneCut& c) { std::swap(c.bounds[1], c.bounds[2]); }),
      cut("bounds_without_area", kInvalid, [](PlaneCut& c) { c.bounds.assign(3, c.bounds[0]); }),
      cut("far_ray", kInvalid,
          [](PlaneCut& c) {
            c.first_hit = {Vec3d(0, kFar, 0), Vec3d(0, 1, 0)};
          }),
      cut("section_of_nan", kNotFinite, [](PlaneCut& c) { c.sections = {Vec3d(kNan, 0, 0)}; }),
      cut("far_section", kInvalid, [](PlaneCut& c) { c.sections = {Vec3d(kFar, 0, 0)}; }),
      drill("origin_of_nan", kNotFinite, [](Bore& b) { b.origin.x() = kNan; }),
      drill("direction_of_nan", kNotFinite, [](Bore& b) { b.direction.x() = kNan; }),
      drill("far_origin", kInvalid, [](Bore& b) { b.origin.x() = kFar; }),
      drill("far_direction", kInvalid, [](Bore& b) { b.direction.x() = -kFar; }),
      drill("radius_of_nan", kNotFinite, [](Bore& b) { b.radius = kNan; }),
      drill("huge_depth", kInvalid, [](Bore& b) { b.depth = 1e31; }),
      drill("negative_chord_tolerance", kInvalid, [](Bore& b) { b.chord_tolerance = -0.01; }),
      drill("chords_finer_than_1536_sides", kInvalid, [](Bore& b) { b.chord_tolerance = 1e-300; }),
      drill("chords_longer_than_the_radius", kInvalid, [](Bore& b) { b.chord_tolerance = 0.2; }),
      tear("blade_of_nan", kNotFinite, [](TearOperation& t) { t.stroke[1].tip.x() = kNan; }),
      tear("far_blade", kInvalid, [](TearOperation& t) { t.stroke[1].base.x() = kFar; }),
      tear("far_tip", kInvalid, [](TearOperation& t) { t.stroke[0].tip.x() = kFar; }),
      tear("blade_turned_over", kInvalid,
           [](TearOperation& t) { std::swap(t.stroke[1].tip, t.stroke[1].base); }),
      tear("unknown_layers", kInvalid,
           [](TearOperation& t) { t.options.layers = static_cast<Layers>(7); }),
      tear("negative_lip_roll", kInvalid, [](TearOperation& t) { t.options.lip_roll = -1; }),
      tear("huge_width", kInvalid, [](TearOperation& t) { t.options.width = 1e31; }),
      tear("unknown_weight_policy", kInvalid,
           [](TearOperation& t) {
             t.options.weights.emplace().policy = static_cast<WeightPolicy>(99);
           }),
      tear("exact_weights_of_few_influences", kInvalid,
           [](TearOperation& t) {
             t.options.weights.emplace().policy = WeightPolicy::exact;
             t.options.weights->maximum_influences = 4;
           }),
      sampled("negative_distance_of_blades", kInvalid, {-1, 0}),
      sampled("distance_of_blades_of_nan", kNotFinite, {kNan, 0}),
      sampled("negative_time_between_blades", kInvalid, {0, -1}),
      sampled("endless_time_between_blades", kNotFinite,
              {0, std::numeric_limits<double>::infinity()})};
}

INSTANTIATE_TEST_SUITE_P(contract, RefusedOperation, testing::ValuesIn(refusals()),
                         [](const auto& test) { return test.param.name; });

}  // namespace
}  // namespace sunder
