// Logs with operations that name bones or places of the surface.
#include <sunder/io/operation_log.h>

#include <numbers>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace sunder {
namespace {

using testing::HasSubstr;

std::string log_of(const std::string& operations) {
  return R"({"sunder_operations": 1, "operations": [)" + operations + "]}";
}

template <class Kind>
Kind parsed(const std::string& operation) {
  const auto operations = parse_aimed_operations(log_of(operation));
  EXPECT_TRUE(operations) << operations.error().text();
  if (!operations) return {};
  return std::get<Kind>(std::get<AimedOperation>(operations->at(0)));
}

TEST(AimedLog, reads_a_slash) {
  const auto slash = parsed<SlashOperation>(R"({"op": "slash", "around": "LeftForeArm", "at": 0.4,
      "from": "back", "length": 0.1, "turn": 30, "depth": {"widths": 0.2}, "width": 0.01,
      "layers": "all", "wall_depth": 0.002, "weights": {"influences": 4},
      "pose": {"clip": "Walk", "time": 0.5}})");
  EXPECT_EQ(slash.place, (LimbPlace{"LeftForeArm", 0.4}));
  EXPECT_EQ(std::get<ViewSide>(slash.from.value()), ViewSide::back);
  EXPECT_EQ(slash.length, (AimedLength{0.1, AimedLength::Unit::metres}));
  EXPECT_NEAR(slash.turn, std::numbers::pi / 6, 1e-15);
  EXPECT_EQ(slash.depth, (AimedLength{0.2, AimedLength::Unit::widths}));
  EXPECT_EQ(slash.options,
            (TearOptions{0.01, Layers::all, 0.002, WeightOptions{WeightPolicy::barycentric, 4}}));
  EXPECT_EQ(std::get<ClipPose>(slash.pose).time, 0.5);
}

TEST(AimedLog, gives_a_slash_its_defaults) {
  const auto slash = parsed<SlashOperation>(R"({"op": "slash", "around": "Tail"})");
  EXPECT_EQ(slash.place, (LimbPlace{"Tail", 0.5}));
  EXPECT_FALSE(slash.from.has_value());
  EXPECT_EQ(slash.length, SlashOperation{}.length);
  EXPECT_EQ(slash.turn, 0.0);
  EXPECT_FALSE(slash.depth);
  EXPECT_EQ(slash.options, TearOptions{});
  EXPECT_TRUE(std::holds_alternative<RestPose>(slash.pose));
}

TEST(AimedLog, reads_directions_of_model_and_bone) {
  const auto of_model =
      parsed<SlashOperation>(R"({"op": "slash", "around": "A", "from": [1, 2, 3]})");
  EXPECT_EQ(std::get<ViewDirection>(of_model.from.value()),
            (ViewDirection{{1, 2, 3}, ViewDirection::Space::model}));
  const auto of_bone =
      parsed<SlashOperation>(R"({"op": "slash", "around": "A", "from": {"bone": [0, 0, -1]}})");
  EXPECT_EQ(std::get<ViewDirection>(of_bone.from.value()),
            (ViewDirection{{0, 0, -1}, ViewDirection::Space::bone}));
}

TEST(AimedLog, reads_a_sever) {
  const auto sever = parsed<SeverOperation>(R"({"op": "sever", "bone": "LeftHand", "at": 0.25,
      "tilt": -45, "from": "top", "caps": false, "pose": "bind"})");
  EXPECT_EQ(sever.place, (LimbPlace{"LeftHand", 0.25}));
  EXPECT_NEAR(sever.tilt, -std::numbers::pi / 4, 1e-15);
  EXPECT_EQ(std::get<ViewSide>(sever.from.value()), ViewSide::top);
  EXPECT_FALSE(sever.caps);
  EXPECT_TRUE(std::holds_alternative<BindPose>(sever.pose));
  const auto plain = parsed<SeverOperation>(R"({"op": "sever", "bone": "LeftHand"})");
  EXPECT_EQ(plain.place.at, 0.0);
  EXPECT_TRUE(plain.caps);
}

TEST(AimedLog, reads_a_puncture) {
  const auto puncture = parsed<PunctureOperation>(R"({"op": "puncture", "around": "Chest",
      "at": 0.5, "radius": {"widths": 0.1}, "through": true, "chord_tolerance": 0.001,
      "wall": true})");
  EXPECT_EQ(puncture.radius, (AimedLength{0.1, AimedLength::Unit::widths}));
  EXPECT_TRUE(puncture.is_through);
  EXPECT_FALSE(puncture.depth);
  EXPECT_EQ(puncture.chord_tolerance, 0.001);
  EXPECT_TRUE(puncture.wall);
}

TEST(AimedLog, reads_an_incision) {
  const auto incision =
      parsed<IncisionOperation>(R"({"op": "incision", "depth": 0.01, "width": 0.002,
      "points": [{"mesh": "Body", "triangle": 12, "barycentrics": [0.2, 0.3, 0.5]},
                 {"mesh": 1, "triangle": 7, "barycentrics": [1, 1, 1]}]})");
  ASSERT_EQ(incision.points.size(), 2u);
  EXPECT_EQ(incision.points[0], (SurfacePlace{std::string("Body"), 12, {0.2, 0.3, 0.5}}));
  EXPECT_EQ(incision.points[1], (SurfacePlace{1u, 7, {1, 1, 1}}));
  EXPECT_EQ(incision.depth, 0.01);
  EXPECT_EQ(incision.options.width, 0.002);
}

TEST(AimedLog, may_mix_both_kinds) {
  const auto operations = parse_aimed_operations(
      log_of(R"({"op": "sever", "bone": "LeftHand"}, {"op": "undo"}, {"op": "cut",
             "plane": {"point": [0,0,0], "normal": [0,0,1]}})"));
  ASSERT_TRUE(operations) << operations.error().text();
  ASSERT_EQ(operations->size(), 3u);
  EXPECT_TRUE(std::holds_alternative<AimedOperation>(operations->at(0)));
  EXPECT_TRUE(std::holds_alternative<UndoOperation>(std::get<Operation>(operations->at(1))));
  EXPECT_TRUE(std::holds_alternative<CutOperation>(std::get<Operation>(operations->at(2))));
}

TEST(AimedLog, needs_a_model) {
  for (const char* const name : {"slash", "sever", "puncture", "incision"}) {
    const auto operations =
        parse_operations(log_of(R"({"op": "undo"}, {"op": ")" + std::string(name) + "\"}"));
    ASSERT_FALSE(operations);
    EXPECT_EQ(operations.error().code(), StatusCode::unsupported_feature);
    EXPECT_EQ(operations.error().index(), 1u);
    EXPECT_THAT(std::string(operations.error().text()), HasSubstr("needs a model"));
    EXPECT_THAT(std::string(operations.error().text()), HasSubstr("/operations/1/op"));
  }
}

struct AimedRefusal {
  const char* operation;
  const char* text;
};

TEST(AimedLog, refuses_naming_the_place) {
  for (const AimedRefusal& refusal : {
           AimedRefusal{R"({"op": "slash"})", "'around' is missing"},
           AimedRefusal{R"({"op": "slash", "around": ""})", "/around: a bone's name"},
           AimedRefusal{R"({"op": "slash", "around": "A", "at": 1.5})",
                        "/at: at is 1.5; it must be from 0 to 1"},
           AimedRefusal{R"({"op": "slash", "around": "A", "from": "above"})",
                        "/from: unknown side"},
           AimedRefusal{R"({"op": "slash", "around": "A", "from": [0, 0, 0]})", "of zero length"},
           AimedRefusal{R"({"op": "slash", "around": "A", "length": "0.8w"})", "/length: expected"},
           AimedRefusal{R"({"op": "slash", "around": "A", "length": 0})",
                        "/length: length is 0 m; it must be above 1e-30 and at most 1e+30 m"},
           AimedRefusal{R"({"op": "slash", "around": "A", "length": {"widths": -1}})",
                        "/length/widths: widths is -1; it must be above 0 and at most 1e+30"},
           AimedRefusal{R"({"op": "slash", "around": "A", "bone": "B"})", "unknown field 'bone'"},
           AimedRefusal{R"({"op": "slash", "around": "A", "dept": 1})",
                        "unknown field 'dept'; did you mean 'depth'"},
           AimedRefusal{R"({"op": "sever", "around": "A"})", "unknown field 'around'"},
           AimedRefusal{R"({"op": "sever", "bone": "A", "from": "left"})", "/from: without a tilt"},
           AimedRefusal{R"({"op": "puncture", "around": "A", "through": true, "depth": 1})",
                        "/depth: a puncture through"},
           AimedRefusal{R"({"op": "incision", "points": [{"mesh": 0, "triangle": 0,
                            "barycentrics": [1,0,0]}]})",
                        "/points: an incision needs at least two"},
           AimedRefusal{R"({"op": "incision", "points": [{"mesh": 0, "triangle": 0,
                            "barycentrics": [0,0,0]}, 3]})",
                        "/points/0/barycentrics: all are zero"},
       }) {
    const auto operations = parse_aimed_operations(log_of(refusal.operation));
    ASSERT_FALSE(operations) << refusal.operation;
    EXPECT_EQ(operations.error().code(), StatusCode::malformed_file);
    EXPECT_EQ(operations.error().index(), 0u);
    EXPECT_THAT(std::string(operations.error().text()), HasSubstr("/operations/0"));
    EXPECT_THAT(std::string(operations.error().text()), HasSubstr(refusal.text));
  }
}

}  // namespace
}  // namespace sunder
