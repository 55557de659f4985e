// The classic mistakes, made on purpose, are found under their own codes at the right vertices; what
// has no mistake gives no alarm.

#include <sunder/io/character_file.h>
#include <sunder/skinning/pose.h>
#include <sunder/tear/torn_model.h>
#include <sunder/validation/validation.h>

#include <algorithm>
#include <memory>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/own_models.h"
#include "support/planted_mistakes.h"
#include "support/rigs.h"
#include "support/shared_models.h"
#include "support/temporary_folder.h"

namespace sunder::test {
namespace {

using Shared = std::shared_ptr<const Character>;

Shared share(Character character) { return std::make_shared<const Character>(std::move(character)); }

const Finding* find_code(const ValidationReport& report, const std::string& code) {
  const auto found = std::ranges::find(report.findings, code, &Finding::code);
  return found == report.findings.end() ? nullptr : &*found;
}

/// All findings at warning or above, for messages.
std::string alarms(const ValidationReport& report) {
  std::string text;
  for (const Finding& finding : report.findings)
    if (finding.severity > Severity::note)
      text += std::string(finding.code) + ": " + finding.text + "\n";
  return text;
}

/// Three models of our own: a sheet with a seam and a morph target, a tube of eight bones with six
/// influences, and one whose default pose is not its bind pose.
const OwnModel& model_named(const std::string& file) {
  static const std::vector<OwnModel> models = make_own_models();
  return *std::ranges::find(models, file, &OwnModel::file);
}

class Mistakes : public testing::TestWithParam<std::tuple<int, const char*>> {
 protected:
  PlantedMistake planted_ =
      plant(static_cast<Mistake>(std::get<0>(GetParam())), model_named(std::get<1>(GetParam())).character);
};

TEST_P(Mistakes, are_found_under_their_own_code_at_the_right_places) {
  ValidationOptions options;
  options.stored_source = planted_.stored_source;
  options.stored_target = planted_.stored_target;
  const auto report = validate_skin(share(planted_.source), share(planted_.target), options);
  ASSERT_TRUE(report) << report.error().text();
  const Finding* const finding = find_code(*report, planted_.code);
  ASSERT_NE(finding, nullptr) << planted_.code << " is missing among\n" << alarms(*report);
  EXPECT_GE(finding->severity, Severity::warning) << finding->text;
  for (const FindingPlace& place : finding->places) {
    if (!planted_.touched.empty()) {
      EXPECT_TRUE(planted_.touched.contains({place.mesh, place.vertex}))
          << planted_.code << ": vertex " << place.vertex;
    }
    if (!planted_.bones.empty()) EXPECT_TRUE(planted_.bones.contains(place.bone)) << place.bone;
  }
  EXPECT_GE(finding->count, planted_.must.size()) << finding->text;
  EXPECT_LE(finding->count, std::max(planted_.touched.size(), planted_.bones.size()))
      << finding->text;
}

INSTANTIATE_TEST_SUITE_P(OnThreeModels, Mistakes,
                         testing::Combine(testing::Range(0, kMistakes),
                                          testing::Values("seamed_sheet.glb", "six_influences.glb",
                                                          "two_clips.glb")),
                         [](const auto& info) {
                           std::string name = std::get<1>(info.param);
                           name.resize(name.find('.'));
                           return "mistake_" + std::to_string(std::get<0>(info.param)) + "_" + name;
                         });

void expect_no_alarm(const ValidationReport& report, const std::string& what) {
  EXPECT_EQ(alarms(report), "") << what;
}

TEST(Untouched, models_of_our_own_give_no_alarm_and_certify_zero) {
  for (const OwnModel& model : make_own_models()) {
    const Shared character = share(model.character);
    ValidationOptions options;
    const auto stored = stored_as(model.character, model.options.weights);
    options.stored_source = options.stored_target = stored;
    const auto report = validate_skin(character, character, options);
    ASSERT_TRUE(report) << model.file << ": " << report.error().text();
    expect_no_alarm(*report, model.file);
    EXPECT_TRUE(report->bracket.is_tested) << model.file << report->bracket.why;
    EXPECT_EQ(report->bracket.certified, 0.0) << model.file;
    for (const PosedFigures& figures : report->posed) EXPECT_EQ(figures.maximum, 0.0) << model.file;
    EXPECT_EQ(report->matching.target_unmatched, 0u) << model.file;
    EXPECT_EQ(report->papers.kg_error, 0.0);
    EXPECT_EQ(report->papers.influence_precision, 1.0);
  }
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
    const ModelPose pose = i == 0 ? rest_pose(character) : random_pose(character, random, 0.3, 1.0);
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
        if (figures.poses == "random")
          EXPECT_LE(figures.maximum, report->bracket.certified * (1 + 1e-9) + 1e-12);
    }
  }
}

}  // namespace
}  // namespace sunder::test
