// Operation logs that are read: every field, files, the examples of the page.

#include <sunder/io/operation_log.h>

#include <filesystem>
#include <fstream>
#include <set>
#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "io/operation_log_texts.h"
#include "support/machine/temporary_folder.h"

namespace sunder {
namespace {
using test::cut_with;
using test::drill_with;
using test::log_text_of;
using test::refit_with;
using test::tear_with;

TearOperation parsed_operation(const std::string& json) {
  auto operations = parse_operations(json);
  EXPECT_TRUE(operations) << operations.error().text();
  if (!operations || operations->empty()) return {};
  return std::get<TearOperation>(operations->front());
}

TEST(OperationLog, ReadsEveryField) {
  const TearOperation tear = parsed_operation(
      tear_with(R"("pose": {"clip": "Walk", "time": 0.4}, "width": 0.0, "layers": "nearest")"));
  const ClipPose pose = std::get<ClipPose>(tear.pose);
  EXPECT_EQ(std::get<std::string>(pose.clip), "Walk");
  EXPECT_EQ(pose.time, 0.4);
  const Stroke expected = {{{0, 0, 1}, {0, 0, 0}}, {{0.1, 0, 1}, {0.1, 0, 0}}};
  EXPECT_EQ(tear.stroke, expected);
}

TEST(OperationLog, ReadsWidthLayersAndWalls) {
  const TearOperation tear =
      parsed_operation(tear_with(R"("width": 0.02, "layers": "all", "wall_depth": 0.01)"));
  EXPECT_EQ(tear.options, (TearOptions{0.02, Layers::all, 0.01}));
  EXPECT_EQ(parsed_operation(tear_with(R"("width": 0)")).options, TearOptions{});
}

TEST(OperationLog, MaterialsAndRolledLipsGoRoundTheLog) {
  const auto operations = parse_operations(log_text_of(R"(
      {"op": "tear", "wall_depth": 0.1, "wall_material": 3, "lip_roll": 0.02,
       "stroke": [{"base": [0,0,1], "tip": [0,0,0]}, {"base": [1,0,1], "tip": [1,0,0]}]},
      {"op": "cut", "plane": {"point": [0,0,0], "normal": [0,1,0]}, "caps": true, "cap_material": 4},
      {"op": "drill", "axis": {"origin": [0,0,1], "direction": [0,0,-1]}, "radius": 1, "depth": 2,
       "wall": true, "wall_material": 5})"));
  ASSERT_TRUE(operations) << operations.error().text();
  const auto again = parse_operations(format_operations(*operations).value());
  ASSERT_TRUE(again) << again.error().text();
  for (const auto& of : {*operations, *again}) {
    EXPECT_EQ(std::get<TearOperation>(of[0]).options.wall_material, 3u);
    EXPECT_EQ(std::get<TearOperation>(of[0]).options.lip_roll, 0.02);
    EXPECT_EQ(std::get<CutOperation>(of[1]).cut.cap_material, 4u);
    EXPECT_EQ(std::get<DrillOperation>(of[2]).bore.wall_material, 5u);
  }
  EXPECT_FALSE(parse_operations(log_text_of(R"({"op": "tear", "lip_roll": -1,
      "stroke": [{"base": [0,0,1], "tip": [0,0,0]}, {"base": [1,0,1], "tip": [1,0,0]}]})")));
}

TEST(OperationLog, ABladeMayBringItsPose) {
  const TearOperation tear = parsed_operation(log_text_of(R"({"op": "tear", "stroke": [
      {"base": [0,0,1], "tip": [0,0,0]}, {"base": [1,0,1], "tip": [1,0,0], "pose": "bind"},
      {"base": [2,0,1], "tip": [2,0,0]}, {"base": [3,0,1], "tip": [3,0,0], "pose": {"clip": "Walk", "time": 1}}]})"));
  ASSERT_EQ(tear.pose_changes.size(), 2u);
  EXPECT_EQ(tear.pose_changes[0].blade, 1u);
  EXPECT_TRUE(std::holds_alternative<BindPose>(tear.pose_changes[0].pose));
  EXPECT_EQ(tear.pose_changes[1].blade, 3u);
  EXPECT_EQ(std::get<ClipPose>(tear.pose_changes[1].pose).time, 1.0);
}

TEST(OperationLog, ReadsACut) {
  const auto operations = parse_operations(log_text_of(R"({"op": "cut", "pose": "bind",
      "plane": {"point": [1, 2, 3], "normal": [0, -2, 0]}, "bounds": [[0,0,0], [1,0,0], [0,0,1]], "caps": true,
      "sections": [[4, 5, 6], [7, 8, 9]], "first_hit": {"origin": [1, 2, 3], "direction": [0, 0, -4]},
      "bone": "forearm"},
      {"op": "cut", "plane": {"point": [0,0,0], "normal": [0,0,1]}})"));
  ASSERT_TRUE(operations) << operations.error().text();
  const auto& cut = std::get<CutOperation>(operations->at(0));
  EXPECT_TRUE(std::holds_alternative<BindPose>(cut.pose));
  PlaneCut expected = {
      {1, 2, 3}, {0, -2, 0}, {{0, 0, 0}, {1, 0, 0}, {0, 0, 1}}, true, {{4, 5, 6}, {7, 8, 9}}};
  expected.first_hit = {{1, 2, 3}, {0, 0, -4}};
  expected.bone = "forearm";
  EXPECT_EQ(cut.cut, expected);
  EXPECT_EQ(std::get<CutOperation>(operations->at(1)).cut, PlaneCut{});
}

TEST(OperationLog, ReadsABore) {
  const auto operations = parse_operations(
      log_text_of(R"({"op": "drill", "axis": {"origin": [1, 2, 3], "direction": [0, 0, -3]},
      "radius": 0.5, "depth": 4, "chord_tolerance": 0.001, "wall": true},
      {"op": "drill", "axis": {"origin": [0,0,0], "direction": [0,0,-1]}, "radius": 1, "depth": 1})"));
  ASSERT_TRUE(operations) << operations.error().text();
  EXPECT_EQ(std::get<DrillOperation>(operations->at(0)).bore,
            (Bore{{1, 2, 3}, {0, 0, -3}, 0.5, 4, 0.001, true}));
  EXPECT_EQ(std::get<DrillOperation>(operations->at(1)).bore,
            (Bore{{0, 0, 0}, {0, 0, -1}, 1, 1, 0, false}));
}

TEST(OperationLog, ReadsADetachment) {
  const auto operations = parse_operations(log_text_of(
      R"({"op": "detach", "pose": "bind", "piece": {"near": [1, 2, 3], "bone": "hand"}},
      {"op": "detach", "piece": {"near": [0, 0, 1]}},
      {"op": "detach", "piece": {"mesh": 2, "triangle": 7}},
      {"op": "detach", "piece": {"triangle": 7}})"));
  ASSERT_TRUE(operations) << operations.error().text();
  const auto piece = [&](std::size_t i) {
    return std::get<DetachOperation>(operations->at(i)).piece;
  };
  EXPECT_TRUE(std::holds_alternative<BindPose>(std::get<DetachOperation>(operations->at(0)).pose));
  EXPECT_EQ(piece(0), PiecePlace(PieceNear{{1, 2, 3}, "hand"}));
  EXPECT_EQ(piece(1), PiecePlace(PieceNear{{0, 0, 1}}));
  EXPECT_EQ(piece(2), PiecePlace(PieceOfTriangle{2, 7}));
  EXPECT_EQ(piece(3), PiecePlace(PieceOfTriangle{0, 7}));
}

TEST(OperationLog, ATearACutAndABoreMayBringWeights) {
  EXPECT_EQ(parsed_operation(tear_with(R"("weights": {"policy": "pose_exact", "influences": 4})"))
                .options.weights,
            (WeightOptions{WeightPolicy::pose_exact, 4}));
  EXPECT_EQ(parsed_operation(tear_with(R"("weights": {"influences": 8})")).options.weights,
            (WeightOptions{WeightPolicy::barycentric, 8}));
  EXPECT_EQ(parsed_operation(tear_with(R"("weights": {})")).options.weights, WeightOptions{});
  EXPECT_EQ(parsed_operation(tear_with(R"("width": 0)")).options.weights, std::nullopt);
  const auto cut = parse_operations(cut_with(R"("weights": {"policy": "exact", "influences": 0})"));
  ASSERT_TRUE(cut) << cut.error().text();
  EXPECT_EQ(std::get<CutOperation>(cut->at(0)).cut.weights,
            (WeightOptions{WeightPolicy::exact, 0}));
  const auto bore =
      parse_operations(drill_with(R"("radius": 1, "depth": 1, "weights": {"policy": "refit"})"));
  ASSERT_TRUE(bore) << bore.error().text();
  EXPECT_EQ(std::get<DrillOperation>(bore->at(0)).bore.weights,
            (WeightOptions{WeightPolicy::refit, 0}));
}

TEST(OperationLog, ReadsWeightsOfEarlierOperations) {
  const auto operations = parse_operations(log_text_of(R"({"op": "weights", "first": 2, "count": 3,
      "weights": {"policy": "pose_exact", "influences": 4}, "pose": {"clip": "Walk", "time": 0.5}},
      {"op": "weights", "weights": {"policy": "exact"}}, {"op": "weights", "weights": {"policy": "refit"}})"));
  ASSERT_TRUE(operations) << operations.error().text();
  const auto& first = std::get<WeightsOperation>(operations->at(0));
  EXPECT_EQ(first.first_operation, 2u);
  EXPECT_EQ(first.operation_count, 3u);
  EXPECT_EQ(first.weights, (WeightOptions{WeightPolicy::pose_exact, 4}));
  EXPECT_EQ(std::get<ClipPose>(first.pose).time, 0.5);
  const auto& exact = std::get<WeightsOperation>(operations->at(1));
  EXPECT_EQ(exact.first_operation, 0u);
  EXPECT_EQ(exact.operation_count, kNone);
  EXPECT_EQ(exact.weights, (WeightOptions{WeightPolicy::exact, 0}));
  const auto& refit = std::get<WeightsOperation>(operations->at(2)).refit;
  EXPECT_EQ(refit.poses.clip_samples, 32u);
  EXPECT_EQ(refit.importance, RefitImportance{});
  EXPECT_EQ(refit.bound, 1.25);
  EXPECT_FALSE(refit.poses.range_of_motion);
  EXPECT_TRUE(refit.poses.joint_limits.empty());
  EXPECT_TRUE(refit.poses.poses.empty());
  EXPECT_TRUE(refit.moves_bind);
  EXPECT_FALSE(refit.is_coupled);
  EXPECT_EQ(refit.smoothness, 0.01);
}

TEST(OperationLog, ReadsWhatARefitIsOver) {
  const auto operations =
      parse_operations(refit_with(R"({"poses": {"clip_samples": 0, "range_of_motion": true,
      "joint_limits": [{"bone": 7, "axis": [0, -2, 0], "lower": -0.5, "upper": 1.5}, {"bone": 0, "axis": [1, 0, 0], "lower": 0, "upper": 0}],
      "poses": ["bind", {"clip": 1, "time": 0.25}]}, "importance": {"clips": 2, "of_clip": [{"clip": "Walk", "factor": 3}], "range_of_motion": 0.5, "poses": 0},
      "bound": 2, "moves_bind": false, "coupled": true, "smoothness": 0})"));
  ASSERT_TRUE(operations) << operations.error().text();
  const RefitOptions& refit = std::get<WeightsOperation>(operations->at(0)).refit;
  EXPECT_EQ(refit.importance, (RefitImportance{2, {{"Walk", 3}}, 0.5, 0}));
  EXPECT_EQ(refit.bound, 2);
  EXPECT_EQ(refit.poses.clip_samples, 0u);
  EXPECT_TRUE(refit.poses.range_of_motion);
  ASSERT_EQ(refit.poses.joint_limits.size(), 2u);
  EXPECT_EQ(refit.poses.joint_limits[0].bone, 7u);
  EXPECT_EQ(refit.poses.joint_limits[0].axis, Vec3d(0, -2, 0));
  EXPECT_EQ(refit.poses.joint_limits[0].lower, -0.5);
  EXPECT_EQ(refit.poses.joint_limits[0].upper, 1.5);
  ASSERT_EQ(refit.poses.poses.size(), 2u);
  EXPECT_TRUE(std::holds_alternative<BindPose>(refit.poses.poses[0]));
  EXPECT_EQ(std::get<ClipPose>(refit.poses.poses[1]).time, 0.25);
  EXPECT_FALSE(refit.moves_bind);
  EXPECT_TRUE(refit.is_coupled);
  EXPECT_EQ(refit.smoothness, 0.0);
}

TEST(OperationLog, ReadsUndoAndRedo) {
  const auto operations = parse_operations(log_text_of(
      R"({"op": "undo"}, {"op": "undo", "count": 3}, {"op": "redo"}, {"op": "redo", "count": 4294967294})"));
  ASSERT_TRUE(operations) << operations.error().text();
  EXPECT_EQ(std::get<UndoOperation>(operations->at(0)).count, 1u);
  EXPECT_EQ(std::get<UndoOperation>(operations->at(1)).count, 3u);
  EXPECT_EQ(std::get<RedoOperation>(operations->at(2)).count, 1u);
  EXPECT_EQ(std::get<RedoOperation>(operations->at(3)).count, 4294967294u);
}

TEST(OperationLog, MatricesAreRows) {
  const ModelPose pose = std::get<ModelPose>(
      parsed_operation(
          tear_with(
              R"("pose": {"matrices": [[1,2,3,4, 5,6,7,8, 9,10,11,1e30]], "morph_weights": [0.5, -2]})"))
          .pose);
  ASSERT_EQ(pose.model_from_bone.size(), 1u);
  Eigen::Matrix<double, 3, 4> expected;
  expected << 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 1e30;
  EXPECT_EQ(pose.model_from_bone[0].matrix(), expected);
  EXPECT_EQ(pose.morph_weights, (std::vector<float>{0.5f, -2.0f}));
  const ModelPose empty =
      std::get<ModelPose>(parsed_operation(tear_with(R"("pose": {"matrices": []})")).pose);
  EXPECT_TRUE(empty.model_from_bone.empty());
  EXPECT_TRUE(empty.morph_weights.empty());
}

TEST(OperationLog, RestIsTheDefaultPose) {
  EXPECT_TRUE(std::holds_alternative<RestPose>(parsed_operation(tear_with(R"("width": 0)")).pose));
  EXPECT_TRUE(
      std::holds_alternative<RestPose>(parsed_operation(tear_with(R"("pose": "rest")")).pose));
  EXPECT_TRUE(
      std::holds_alternative<BindPose>(parsed_operation(tear_with(R"("pose": "bind")")).pose));
}

TEST(OperationLog, ClipByIndex) {
  const ClipPose pose =
      std::get<ClipPose>(parsed_operation(tear_with(R"("pose": {"clip": 2, "time": 0})")).pose);
  EXPECT_EQ(std::get<std::uint32_t>(pose.clip), 2u);
}

TEST(OperationLog, BonesKeepTheirOrderAndWhatIsNotGivenStaysOpen) {
  const BonesPose pose = std::get<BonesPose>(
      parsed_operation(
          tear_with(
              R"("pose": {"bones": {"Spine": {"rotation": [0, 0, 0, 2]}, "Arm": {"translation": [1, 2, 3], "scale": [1, 1, 2]}}})"))
          .pose);
  ASSERT_EQ(pose.bones.size(), 2u);
  EXPECT_EQ(pose.bones[0].name, "Spine");
  EXPECT_FALSE(pose.bones[0].translation);
  EXPECT_EQ(pose.bones[0].rotation->coeffs(), Quatf::Identity().coeffs());  // Normalised.
  EXPECT_EQ(pose.bones[1].name, "Arm");
  EXPECT_EQ(*pose.bones[1].translation, Vec3f(1, 2, 3));
  EXPECT_EQ(*pose.bones[1].scale, Vec3f(1, 1, 2));
  EXPECT_FALSE(pose.bones[1].rotation);
}

TEST(OperationLog, MayBeEmpty) {
  const auto operations = parse_operations(log_text_of(""));
  ASSERT_TRUE(operations);
  EXPECT_TRUE(operations->empty());
}
TEST(OperationLog, FromAFile) {
  const test::TemporaryFolder folder;
  const auto file = folder.write("log.json", std::string_view(tear_with(R"("width": 0)")));
  const auto operations = load_operations(file);
  ASSERT_TRUE(operations) << operations.error().text();
  EXPECT_EQ(operations->size(), 1u);

  EXPECT_EQ(load_operations(folder.path() / "absent.json").error().code(),
            StatusCode::file_not_found);
  EXPECT_EQ(load_operations(folder.path()).error().code(), StatusCode::file_unreadable);
}

/// The code must accept what the documentation page and the schema show.
TEST(OperationLog, DocumentedExamplesAreRead) {
  const std::filesystem::path docs = std::filesystem::path(SUNDER_SOURCE_DIR) / "docs";
  std::ifstream page(docs / "operation_log.md");
  ASSERT_TRUE(page);
  const std::string text{std::istreambuf_iterator<char>(page), {}};
  std::set<std::size_t> kinds, aimed_kinds;
  for (std::size_t start = text.find("```json\n"); start != std::string::npos;
       start = text.find("```json\n", start + 1)) {
    std::string example = text.substr(start + 8, text.find("```", start + 8) - start - 8);
    if (example.find("sunder_operations") == std::string::npos) example = log_text_of(example);
    const auto operations = parse_aimed_operations(example);
    ASSERT_TRUE(operations) << example << operations.error().text();
    for (const LoggedOperation& logged : *operations)
      if (const auto* const operation = std::get_if<Operation>(&logged))
        kinds.insert(operation->index());
      else
        aimed_kinds.insert(std::get<AimedOperation>(logged).index());
  }
  EXPECT_EQ(kinds.size(), std::variant_size_v<Operation>) << "an operation without example";
  EXPECT_EQ(aimed_kinds.size(), std::variant_size_v<AimedOperation>);

  std::ifstream schema(docs / "operation_log.schema.json");
  const nlohmann::json parsed_schema = nlohmann::json::parse(schema);
  EXPECT_EQ(parsed_schema["properties"]["sunder_operations"]["const"], 1);
  EXPECT_EQ(parsed_schema["properties"]["operations"]["items"]["oneOf"].size(),
            std::variant_size_v<Operation> + std::variant_size_v<AimedOperation>);
}

Character with_materials() {
  Character character;
  character.meshes.resize(1);
  character.meshes[0].submeshes = {{"Skin", 2}, {"Flesh", 4}};
  return character;
}

TEST(OperationLog, NamesMaterialsOfAModel) {
  const Character model = with_materials();
  const std::string log = log_text_of(R"({"op": "tear", "wall_material": "Flesh",
      "stroke": [{"base": [0,0,1], "tip": [0,0,0]}, {"base": [1,0,1], "tip": [1,0,0]}]},
      {"op": "cut", "plane": {"point": [0,0,0], "normal": [0,1,0]}, "cap_material": "Skin"},
      {"op": "drill", "axis": {"origin": [0,0,1], "direction": [0,0,-1]}, "radius": 1, "depth": 2,
       "wall_material": "Flesh"})");
  const auto named = parse_operations(log, &model);
  ASSERT_TRUE(named) << named.error().text();
  EXPECT_EQ(std::get<TearOperation>((*named)[0]).options.wall_material, 4u);
  EXPECT_EQ(std::get<CutOperation>((*named)[1]).cut.cap_material, 2u);
  EXPECT_EQ(std::get<DrillOperation>((*named)[2]).bore.wall_material, 4u);
  const auto without = parse_operations(log);
  ASSERT_FALSE(without);
  EXPECT_NE(without.error().text().find("/operations/0/wall_material: 'Flesh' needs a model"),
            std::string_view::npos)
      << without.error().text();
  const auto unknown = parse_aimed_operations(
      log_text_of(R"({"op": "sever", "bone": "Arm", "cap_material": "Fles"})"), &model);
  ASSERT_FALSE(unknown);
  EXPECT_EQ(unknown.error().code(), StatusCode::not_found);
  EXPECT_NE(unknown.error().text().find("did you mean 'Flesh'?"), std::string_view::npos)
      << unknown.error().text();
}

TEST(OperationLog, IndicesOfMaterialsMeanTheSameWithAModel) {
  const Character model = with_materials();
  const std::string log = log_text_of(R"({"op": "cut", "cap_material": 9,
      "plane": {"point": [0,0,0], "normal": [0,1,0]}})");
  for (const Character* const of : {static_cast<const Character*>(nullptr), &model})
    EXPECT_EQ(std::get<CutOperation>(parse_operations(log, of)->front()).cut.cap_material, 9u);
}

}  // namespace
}  // namespace sunder
