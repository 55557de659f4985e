// A history that was written and read reproduces the model, under any weight policy.

#include <sunder/io/operation_log.h>
#include <sunder/tear/torn_model.h>

#include <functional>
#include <limits>
#include <string>

#include <gtest/gtest.h>

#include "support/models/make_model.h"
#include "support/models/rigs.h"
#include "support/oracles/model_state.h"

namespace sunder {
namespace {

TearOperation bent_tear(double height, const WeightOptions& weights) {
  TearOperation tear;
  tear.pose = ClipPose{"Bend", 0.7};
  tear.stroke = {{{0.1, height, 2}, {0.1, height, 0}},
                 {{0.15, height + 0.3, 2}, {0.15, height + 0.3, 0}}};
  tear.options.weights = weights;
  return tear;
}

TornModel played(const Character& source, const std::vector<Operation>& operations) {
  TornModel model = test::make_model(source);
  for (const Operation& operation : operations) {
    const auto report = apply_operation(model, operation);
    EXPECT_TRUE(report) << report.error().text();
  }
  return model;
}

void expect_the_same(const TornModel& a, const TornModel& b) {
  EXPECT_EQ(a.digest(), b.digest());
  EXPECT_EQ(test::difference(test::state_of(a), test::state_of(b)), "");
  for (std::uint32_t mesh = 0; mesh < a.character().meshes.size(); ++mesh) {
    EXPECT_EQ(a.influence_positions(mesh).positions, b.influence_positions(mesh).positions);
    for (std::uint32_t vertex = 0; vertex < a.character().meshes[mesh].vertex_count(); ++vertex)
      ASSERT_EQ(a.weight_policy(mesh, vertex), b.weight_policy(mesh, vertex)) << vertex;
  }
}

struct Weighed {
  const char* name;
  WeightOptions options;
};

class LoggedWeights : public testing::TestWithParam<Weighed> {};

TEST_P(LoggedWeights, give_the_model_again) {
  const Character tube = test::make_tube(9, 10, 3);
  const std::vector<Operation> before = {bent_tear(0.3, {}), bent_tear(0.9, GetParam().options),
                                         bent_tear(1.5, {WeightPolicy::refit, 2})};
  std::vector<WeightsOperation> reweighed(6);
  reweighed[1].weights = {WeightPolicy::pose_exact, 4};
  reweighed[1].pose = ClipPose{"Bend", 1.2};
  reweighed[2].weights = {WeightPolicy::refit, 4};
  reweighed[3].weights.policy = WeightPolicy::refit;
  reweighed[3].refit.poses = {
      0, true, {{1, {0, 0, 1}, -0.2, 0.9}}, {ClipPose{"Bend", 0.1}, BindPose{}}};
  reweighed[3].refit.moves_bind = false;
  reweighed[3].first_operation = 1;
  reweighed[3].operation_count = 1;
  reweighed[4].weights.policy = WeightPolicy::exact;
  reweighed[5].weights.policy = WeightPolicy::exact;
  reweighed[5].operation_count = 1;
  for (std::size_t i = 0; i < reweighed.size(); ++i) {
    SCOPED_TRACE(i);
    std::vector<Operation> operations = before;
    operations.push_back(reweighed[i]);
    const TornModel model = played(tube, operations);
    ASSERT_EQ(model.history()->size(), 4u);
    const std::string log = *format_operations(*model.history());
    const auto read = parse_operations(log);
    ASSERT_TRUE(read) << read.error().text() << log;
    const TornModel again = played(tube, *read);
    expect_the_same(again, model);
    EXPECT_EQ(*format_operations(*again.history()), log);
  }
}

INSTANTIATE_TEST_SUITE_P(
    Policies, LoggedWeights,
    testing::Values(Weighed{"barycentric", {}},
                    Weighed{"barycentric_of_two", {WeightPolicy::barycentric, 2}},
                    Weighed{"pose_exact", {WeightPolicy::pose_exact, 0}},
                    Weighed{"pose_exact_of_four", {WeightPolicy::pose_exact, 4}},
                    Weighed{"refit", {WeightPolicy::refit, 0}},
                    Weighed{"exact", {WeightPolicy::exact, 0}}),
    [](const auto& instance) { return std::string(instance.param.name); });

TEST(LoggedDefaults, of_a_model_are_in_the_log_of_its_operations) {
  const Character tube = test::make_tube(9, 10, 3);
  TornModel model = test::make_model(tube);
  ASSERT_TRUE(model.set_weights({WeightPolicy::exact, 0}));
  TearOperation tear = bent_tear(0.9, {});
  tear.options.weights.reset();
  CutOperation cut;
  cut.cut.point = {0, 0.5, 0};
  cut.cut.normal = {0.1, 1, 0};
  ASSERT_TRUE(apply_operation(model, tear));
  ASSERT_TRUE(apply_operation(model, cut));
  const auto read = parse_operations(*format_operations(*model.history()));
  ASSERT_TRUE(read) << read.error().text();
  EXPECT_EQ(std::get<TearOperation>(read->at(0)).options.weights,
            (WeightOptions{WeightPolicy::exact, 0}));
  expect_the_same(played(tube, *read), model);
}

/// One number of an operation.
struct NumberOf {
  const char* name;
  std::function<Operation(double)> operation;
};

std::vector<NumberOf> numbers_of_operations() {
  const auto tear_with = [](std::function<void(TearOperation&, double)> set) {
    return [set](double value) {
      TearOperation tear = bent_tear(0.3, {});
      tear.pose = RestPose{};
      set(tear, value);
      return Operation(tear);
    };
  };
  const auto bore_with = [](std::function<void(Bore&, double)> set) {
    return [set](double value) {
      DrillOperation drill;
      drill.bore.origin = Vec3d(0, 0.5, 2);
      drill.bore.radius = 0.05;
      drill.bore.depth = 1;
      set(drill.bore, value);
      return Operation(drill);
    };
  };
  const auto cut_with = [](std::function<void(PlaneCut&, double)> set) {
    return [set](double value) {
      CutOperation cut;
      cut.cut.point = Vec3d(0, 0.5, 0);
      cut.cut.normal = Vec3d(0, 1, 0);
      set(cut.cut, value);
      return Operation(cut);
    };
  };
  return {
      {"width", tear_with([](TearOperation& of, double value) { of.options.width = value; })},
      {"wall_depth",
       tear_with([](TearOperation& of, double value) { of.options.wall_depth = value; })},
      {"lip_roll", tear_with([](TearOperation& of, double value) { of.options.lip_roll = value; })},
      {"blade", tear_with([](TearOperation& of, double value) {
         for (Blade& blade : of.stroke) blade.base.x() = blade.tip.x() = value;
       })},
      {"radius", bore_with([](Bore& bore, double value) { bore.radius = value; })},
      {"depth", bore_with([](Bore& bore, double value) { bore.depth = value; })},
      {"chord_tolerance",
       bore_with([](Bore& bore, double value) { bore.chord_tolerance = value; })},
      {"origin", bore_with([](Bore& bore, double value) { bore.origin.x() = value; })},
      {"point", cut_with([](PlaneCut& cut, double value) { cut.point.x() = value; })},
      {"section",
       cut_with([](PlaneCut& cut, double value) { cut.sections = {Vec3d(0, value, 0)}; })}};
}

/// A number that one of both refuses could be torn with, but not saved, or the other way round.
TEST(NumbersOfOperations, are_taken_by_the_log_where_the_model_takes_them) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  for (const NumberOf& number : numbers_of_operations())
    for (const double value :
         {0.0,     -0.0,  1e-320,    1e-40,      1e-31,
          1e-20,   1e-6,  0.04,      0.06,       1.0,
          1e8,     2e9,   1e12,      1e29,       9e29,
          1.1e30,  1e45,  9e59,      1.1e60,     1e300,
          -1e-320, -0.01, -1.0,      -2e9,       -1e31,
          -9e59,   -1e61, kInfinity, -kInfinity, std::numeric_limits<double>::quiet_NaN()}) {
      // What is not above zero is not written: there is no rim.
      if (std::string(number.name) == "lip_roll" && !(value > 0)) continue;
      const Operation operation = number.operation(value);
      TornModel model = test::make_model(test::make_tube(9, 10, 3));
      const auto report = apply_operation(model, operation);
      const std::string text = *format_operations({&operation, 1});
      const auto read = parse_operations(text);
      EXPECT_EQ(static_cast<bool>(report), static_cast<bool>(read))
          << number.name << " " << value << ": " << (report ? "" : report.error().text()) << "; "
          << (read ? "" : read.error().text());
    }
}

}  // namespace
}  // namespace sunder
