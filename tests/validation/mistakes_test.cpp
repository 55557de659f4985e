// The classic mistakes, made on purpose, are found under their own codes at the right vertices.

#include <sunder/validation/validation.h>

#include <algorithm>
#include <memory>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/models/own_models.h"
#include "support/models/planted_mistakes.h"
#include "validation/shared_character.h"

namespace sunder::test {
namespace {

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
  PlantedMistake planted_ = plant(static_cast<Mistake>(std::get<0>(GetParam())),
                                  model_named(std::get<1>(GetParam())).character);
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
    if (!planted_.bones.empty()) {
      EXPECT_TRUE(planted_.bones.contains(place.bone)) << place.bone;
    }
  }
  EXPECT_GE(finding->count, planted_.must.size()) << finding->text;
  EXPECT_LE(finding->count, std::max(planted_.touched.size(), planted_.bones.size()))
      << finding->text;
}

std::string name_of(const testing::TestParamInfo<std::tuple<int, const char*>>& instance) {
  const auto& [mistake, file] = instance.param;
  const std::string name = file;
  return "mistake_" + std::to_string(mistake) + "_" + name.substr(0, name.find('.'));
}

INSTANTIATE_TEST_SUITE_P(OnThreeModels, Mistakes,
                         testing::Combine(testing::Range(0, kMistakes),
                                          testing::Values("seamed_sheet.glb", "six_influences.glb",
                                                          "two_clips.glb")),
                         name_of);

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

}  // namespace
}  // namespace sunder::test
