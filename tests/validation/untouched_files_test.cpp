// Files without mistakes give no alarm: rigged models beside themselves, and our own torn outputs.

#include <sunder/io/character_file.h>
#include <sunder/skinning/pose.h>
#include <sunder/tear/torn_model.h>
#include <sunder/validation/validation.h>

#include <algorithm>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/machine/temporary_folder.h"
#include "support/models/own_models.h"
#include "support/models/rigs.h"
#include "support/models/shared_models.h"

namespace sunder::test {
namespace {

using testing::Contains;
using testing::HasSubstr;
using testing::IsEmpty;

void expect_nothing_found(const ValidationReport& report, const std::string& what) {
  for (const Finding& finding : report.findings)
    EXPECT_EQ(finding.severity, Severity::note)
        << what << ": " << finding.code << ": " << finding.text;
}

LoadOptions keep_stored() {
  LoadOptions options;
  options.keep_stored_influences = true;
  return options;
}

TEST(Untouched, rigged_files_give_no_alarm_and_certify_zero) {
  for (const auto& file : rigged_models({".glb", ".gltf", ".fbx", ".dae", ".x", ".b3d"})) {
    const auto loaded = load_character(file, keep_stored());
    ASSERT_TRUE(loaded) << file << loaded.error().text();
    ValidationOptions options;
    options.stored_source = options.stored_target = loaded->stored;
    const auto report = validate_skin(loaded->character, loaded->character, options);
    ASSERT_TRUE(report) << file << report.error().text();
    expect_nothing_found(*report, file.string());
    EXPECT_EQ(report->bracket.certified, 0.0) << file;
    EXPECT_EQ(report->bracket.uncertified, 0u) << file << report->bracket.why;
  }
}

/// A cut, a tear that stays closed and one with a gap, in different poses.
std::vector<Operation> some_operations(const Character& character, Random& random) {
  std::vector<Operation> operations;
  for (int i = 0; i < 3; ++i) {
    TearOperation tear;
    const ModelPose pose =
        i == 0 ? *rest_pose(character) : random_pose(character, random, 0.3, 1.0);
    tear.pose = pose;
    tear.stroke = random_stroke(character, pose, random);
    tear.options.width = i == 2 ? 0.01 * posed_diagonal(character, pose) : 0.0;
    operations.emplace_back(tear);
  }
  return operations;
}

TEST(Untouched, our_own_torn_outputs_give_no_alarm) {
  const TemporaryFolder folder;
  Random random(7);
  for (const OwnModel& model : make_own_models()) {
    ASSERT_TRUE(save_glb(folder.path() / "source.glb", model.character));
    const auto source = load_character(folder.path() / "source.glb", keep_stored());
    ASSERT_TRUE(source) << source.error().text();
    auto torn = TornModel::create(source->character);
    ASSERT_TRUE(torn);
    const std::vector<Operation> operations = some_operations(*source->character, random);
    for (const Operation& operation : operations)
      ASSERT_TRUE(apply_operation(*torn, operation)) << model.file;
    ASSERT_TRUE(save_glb(folder.path() / "torn.glb", torn->character(), *source, {kAllInfluences}));
    const auto target = load_character(folder.path() / "torn.glb", keep_stored());
    ASSERT_TRUE(target) << target.error().text();
    for (const bool with_log : {false, true}) {
      ValidationOptions options;
      options.stored_source = source->stored;
      options.stored_target = target->stored;
      if (with_log) options.operations = operations;
      const auto report = validate_skin(source->character, target->character, options);
      ASSERT_TRUE(report) << report.error().text();
      expect_nothing_found(*report, model.file + (with_log ? " with its log" : ""));
      EXPECT_GE(report->bracket.certified, report->bracket.found * (1 - 1e-9));
      for (const PosedFigures& figures : report->posed)
        if (figures.poses == "random") {
          EXPECT_LE(figures.maximum, report->bracket.certified * (1 + 1e-9) + 1e-12) << model.file;
        }
    }
  }
}

/// Walls and caps stand on the surface with attributes of their own, and policies move the bind
/// positions of new vertices: neither is a wrong attribute.
TEST(Untouched, attributes_of_walls_caps_and_moved_vertices_give_no_alarm) {
  Random random(11);
  for (const OwnModel& model : make_own_models())
    for (const WeightPolicy policy : {WeightPolicy::barycentric, WeightPolicy::pose_exact}) {
      const auto source = std::make_shared<const Character>(model.character);
      auto torn = TornModel::create(source);
      ASSERT_TRUE(torn);
      const ModelPose pose = random_pose(*source, random, 0.5, 1.0);
      std::vector<Operation> operations;
      TearOperation tear;
      tear.pose = pose;
      tear.stroke = random_stroke(*source, pose, random);
      tear.options.width = 0.01 * posed_diagonal(*source, pose);
      tear.options.wall_depth = 0.05 * posed_diagonal(*source, pose);
      tear.options.weights = WeightOptions{policy, 0};
      operations.emplace_back(tear);
      CutOperation cut;
      cut.pose = pose;
      for (const Vec3d& place : posed_positions(*source, 0, pose))
        cut.cut.point += place / source->meshes[0].vertex_count();
      cut.cut.normal = random.direction();
      cut.cut.caps = true;
      cut.cut.weights = WeightOptions{policy, 0};
      operations.emplace_back(cut);
      for (const Operation& operation : operations)
        ASSERT_TRUE(apply_operation(*torn, operation)) << model.file;
      const auto target = std::make_shared<const Character>(torn->character());
      for (const bool with_log : {false, true}) {
        ValidationOptions options;
        if (with_log) options.operations = operations;
        const auto report = validate_skin(source, target, options);
        ASSERT_TRUE(report) << report.error().text();
        for (const Finding& finding : report->findings)
          if (finding.code == "SUNDER_W_NORMALS" || finding.code == "SUNDER_W_TANGENTS" ||
              finding.code == "SUNDER_W_UV" || finding.code == "SUNDER_W_MORPH_LOST") {
            ADD_FAILURE() << model.file << (with_log ? " with its log: " : ": ") << finding.code
                          << ": " << finding.text;
          }
      }
    }
}

/// A tube whose last bone moves its lower half a little: a fault of the source, which the walls and
/// caps of operations take over.
std::shared_ptr<const Character> bleeding_tube() {
  Character tube = make_tube(60, 16, 6);
  Mesh& mesh = tube.meshes[0];
  const SkinWeights old = mesh.weights;
  const auto last = static_cast<Index>(tube.skins[mesh.skin].bones.size() - 1);
  mesh.weights = {};
  for (Index v = 0; v < mesh.vertex_count(); ++v) {
    std::vector<Influence> row(old.of(v).begin(), old.of(v).end());
    if (mesh.positions[v].y() < 1.5f) {
      for (Influence& influence : row) influence.weight *= 0.8f;
      row.push_back({last, 0.2f});
      std::ranges::stable_sort(row, std::greater<>(), &Influence::weight);
    }
    mesh.weights.append(row);
  }
  return std::make_shared<const Character>(std::move(tube));
}

std::vector<std::string> warnings_of(const std::shared_ptr<const Character>& source,
                                     const Character& target,
                                     const std::vector<Operation>& operations) {
  ValidationOptions options;
  options.operations = operations;
  const auto report = validate_skin(source, std::make_shared<const Character>(target), options);
  EXPECT_TRUE(report) << report.error().text();
  std::vector<std::string> warnings;
  if (report)
    for (const Finding& finding : report->findings)
      if (finding.severity > Severity::note)
        warnings.push_back(std::string(finding.code) + ": " + finding.text);
  return warnings;
}

/// Walls and caps have no place on the source, but their weights are those that the operations of
/// the log give them.
TEST(Untouched, faults_of_the_source_are_not_new_in_walls_and_caps) {
  const auto source = bleeding_tube();
  const ModelPose pose = *rest_pose(*source);
  TearOperation tear;
  tear.pose = pose;
  for (const double y : {0.8, 1.0, 1.2}) tear.stroke.push_back({Vec3d(0, y, 2), Vec3d(0, y, 0.1)});
  tear.options.wall_depth = 0.1;
  CutOperation cut;
  cut.pose = pose;
  cut.cut.point = Vec3d(0, 0.5, 0);
  cut.cut.normal = Vec3d(0, 1, 0);
  cut.cut.caps = true;
  const std::vector<Operation> operations = {tear, cut};
  auto torn = TornModel::create(source);
  ASSERT_TRUE(torn);
  for (const Operation& operation : operations) ASSERT_TRUE(apply_operation(*torn, operation));
  EXPECT_THAT(warnings_of(source, torn->character(), operations), IsEmpty());

  Character changed = torn->character();
  SkinWeights& weights = changed.meshes[0].weights;
  Index in_wall = source->meshes[0].vertex_count();
  const auto& places = changed.meshes[0].positions;
  while (torn->birth(0, in_wall).triangle < source->meshes[0].triangle_count() ||
         std::ranges::count(places, places[in_wall]) > 1)
    ++in_wall;
  for (Index i = weights.first[in_wall]; i < weights.first[in_wall + 1]; ++i)
    weights.influences[i].weight =
        0.9f * weights.influences[i].weight + (weights.influences[i].slot == 5 ? 0.1f : 0.0f);
  EXPECT_THAT(warnings_of(source, changed, operations), Contains(HasSubstr("SUNDER_W_BLEED")));
}

}  // namespace
}  // namespace sunder::test
