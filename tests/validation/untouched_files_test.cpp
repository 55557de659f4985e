// Files without mistakes give no alarm: rigged models beside themselves, and our own torn outputs.

#include <sunder/io/character_file.h>
#include <sunder/skinning/pose.h>
#include <sunder/tear/torn_model.h>
#include <sunder/validation/validation.h>

#include <gtest/gtest.h>

#include "support/own_models.h"
#include "support/rigs.h"
#include "support/shared_models.h"
#include "support/temporary_folder.h"

namespace sunder::test {
namespace {

void expect_no_alarm(const ValidationReport& report, const std::string& what) {
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
    expect_no_alarm(*report, file.string());
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
    ASSERT_TRUE(save_glb(folder.path() / "torn.glb", torn->character(), *source));
    const auto target = load_character(folder.path() / "torn.glb", keep_stored());
    ASSERT_TRUE(target) << target.error().text();
    for (const bool with_log : {false, true}) {
      ValidationOptions options;
      options.stored_source = source->stored;
      options.stored_target = target->stored;
      if (with_log) options.operations = operations;
      const auto report = validate_skin(source->character, target->character, options);
      ASSERT_TRUE(report) << report.error().text();
      expect_no_alarm(*report, model.file + (with_log ? " with its log" : ""));
      EXPECT_GE(report->bracket.certified, report->bracket.found * (1 - 1e-9));
      for (const PosedFigures& figures : report->posed)
        if (figures.poses == "random") {
          EXPECT_LE(figures.maximum, report->bracket.certified * (1 + 1e-9) + 1e-12) << model.file;
        }
    }
  }
}

}  // namespace
}  // namespace sunder::test
