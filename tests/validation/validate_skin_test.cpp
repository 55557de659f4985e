// validate_skin(): figures against independent oracles, refusals, and the table of codes.

#include <sunder/skinning/deform.h>
#include <sunder/skinning/pose.h>
#include <sunder/validation/validation.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>
#include <memory>
#include <set>
#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/models/rigs.h"
#include "validation/shared_character.h"

namespace sunder::test {
namespace {

using testing::HasSubstr;
/// A tube and a copy whose first bone lost a tenth of its weight to the second one.
std::pair<Character, Character> tube_and_copy() {
  Character source = make_tube(16, 12, 4), target = source;
  SkinWeights weights;
  for (Index v = 0; v < target.meshes[0].vertex_count(); ++v) {
    std::vector<Influence> influences(target.meshes[0].weights.of(v).begin(),
                                      target.meshes[0].weights.of(v).end());
    if (influences.size() > 1) {
      const float moved = 0.1f * influences[0].weight;
      influences[0].weight -= moved;
      influences[1].weight += moved;
    }
    weights.append(influences);
  }
  target.meshes[0].weights = weights;
  return {source, target};
}

/// Two rigid parts that move alike, each attached to its bone: by a skin each, which has no bind
/// pose, or by one, whose bind pose is not the rest pose.
Character two_parts(bool have_one_skin) {
  Character character = make_tube(8, 8, 2);
  character.skeleton.bones[1].rest.translation = Vec3f(5, 0, 0);
  character.meshes.push_back(character.meshes[0]);
  const Vec3f place(0, have_one_skin ? 4.0f : 0.0f, 0);  // of the second part at bind
  for (Vec3f& position : character.meshes[1].positions) position += place;
  Skin skin;
  skin.bone_from_bind = {Affine3f::Identity(), Affine3f::Identity()};
  skin.bone_from_bind[1].translation() = -place;
  skin.bones = {0, 1};
  character.skins = {skin};
  if (!have_one_skin) {
    character.skins.push_back(skin);
    for (Index part = 0; part < 2; ++part) {
      character.skins[part].bones = {part};
      character.skins[part].bone_from_bind.resize(1);
    }
  }
  for (Index part = 0; part < 2; ++part) {
    Mesh& mesh = character.meshes[part];
    mesh.name = "part" + std::to_string(part);
    mesh.skin = have_one_skin ? 0 : part;
    SkinWeights weights;
    for (Index v = 0; v < mesh.vertex_count(); ++v)
      weights.append(std::vector<Influence>{{have_one_skin ? part : 0, 1.0f}});
    mesh.weights = std::move(weights);
  }
  return character;
}

TEST(ValidateSkin, parts_without_a_bind_pose_match_those_of_one_skin) {
  for (const bool have_one_skin : {false, true}) {
    const auto report =
        validate_skin(share(two_parts(have_one_skin)), share(two_parts(!have_one_skin)));
    ASSERT_TRUE(report) << report.error().text();
    EXPECT_EQ(report->matching.target_unmatched, 0u);
    for (const Finding& finding : report->findings)
      EXPECT_NE(finding.code, "SUNDER_W_DEVIATION") << finding.text;
  }
}

TEST(ValidateSkin, a_large_deviation_is_an_error_and_a_small_one_a_warning) {
  const auto [source, target] = tube_and_copy();
  ValidationOptions options;
  const auto severity = [&, &source = source, &target = target] {
    const auto report = validate_skin(share(source), share(target), options);
    EXPECT_TRUE(report) << report.error().text();
    for (const Finding& finding : report->findings)
      if (finding.code == "SUNDER_W_DEVIATION")
        return std::pair(finding.severity, finding.value / report->diagonal);
    return std::pair(Severity::note, 0.0);
  };
  const double share_of_diagonal = severity().second;
  ASSERT_GT(share_of_diagonal, 1e-3);
  options.maximum_deviation = 0.5 * share_of_diagonal;
  options.error_deviation = 1.01 * share_of_diagonal;
  EXPECT_EQ(severity().first, Severity::warning);
  options.error_deviation = 0.99 * share_of_diagonal;
  EXPECT_EQ(severity().first, Severity::error);
  options.maximum_deviation = 2 * share_of_diagonal;
  EXPECT_EQ(severity().first, Severity::error) << "errors may begin below the limit of warnings";
  options.error_deviation = 100;
  options.maximum_deviation = 0.099 * share_of_diagonal;
  EXPECT_EQ(severity().first, Severity::error) << "more than ten times the limit";
  options.maximum_deviation = 0.101 * share_of_diagonal;
  EXPECT_EQ(severity().first, Severity::warning);
  for (double* const member : {&options.maximum_deviation, &options.error_deviation,
                               &options.random_angle, &options.clip_margin}) {
    const double before = *member;
    for (const double bad : {-0.1, std::numeric_limits<double>::quiet_NaN()}) {
      *member = bad;
      EXPECT_EQ(validate_skin(share(source), share(target), options).error().code(),
                bad < 0 ? StatusCode::invalid_argument : StatusCode::non_finite_value);
    }
    *member = before;
  }
}

TEST(ValidateSkin, the_worst_pose_shows_the_largest_deviation) {
  const auto [source, target] = tube_and_copy();
  const auto report = validate_skin(share(source), share(target));
  ASSERT_TRUE(report) << report.error().text();
  double largest = 0;
  for (const PosedFigures& figures : report->posed) largest = std::max(largest, figures.maximum);
  ASSERT_GT(largest, 0.0);
  const auto a = posed_positions(source, 0, report->worst_pose),
             b = posed_positions(target, 0, report->worst_pose);
  double far = 0;
  for (std::size_t v = 0; v < a.size(); ++v) far = std::max(far, (a[v] - b[v]).norm());
  EXPECT_NEAR(far, largest, 1e-5 * largest);
  // The pose of the bracket shows what was found, and nothing sampled is beyond the certificate.
  const auto c = posed_positions(source, 0, report->bracket.pose),
             d = posed_positions(target, 0, report->bracket.pose);
  const Index worst = report->bracket.worst.vertex;
  EXPECT_NEAR((c[worst] - d[worst]).norm(), report->bracket.found, 1e-5 * report->bracket.found);
  EXPECT_LE(report->bracket.found, report->bracket.certified * (1 + 1e-9));
  EXPECT_LE(far, report->bracket.certified * (1 + 1e-5));
}

TEST(ValidateSkin, statistics_are_ordered_and_the_covered_share_is_that_of_wilks) {
  const auto [source, target] = tube_and_copy();
  for (const std::uint32_t n : {59u, 64u, 299u}) {
    ValidationOptions options;
    options.random_poses = n;
    const auto report = validate_skin(share(source), share(target), options);
    ASSERT_TRUE(report) << report.error().text();
    const PosedFigures& random = report->posed.back();
    EXPECT_EQ(random.poses, "random");
    EXPECT_EQ(random.pose_count, n);
    EXPECT_LE(random.mean, random.rms);
    EXPECT_LE(random.rms, random.maximum);
    EXPECT_LE(random.p95, random.maximum);
    EXPECT_GE(1.0 - std::pow(random.covered_share, n), 0.95 - 1e-9);
    EXPECT_GE(random.covered_share, n == 299 ? 0.99 : 0.95);
  }
}

TEST(ValidateSkin, deviation_over_time_is_that_of_each_sampled_pose) {
  auto [source, target] = tube_and_copy();
  Clip still;
  still.name = "Still";
  source.clips.insert(source.clips.begin(), still);
  EXPECT_TRUE(validate_skin(share(source), share(target))->over_time.empty());
  for (const std::uint32_t most : {2u, 25u, 1000u}) {
    ValidationOptions options;
    options.times_per_clip = most;
    const auto report = validate_skin(share(source), share(target), options);
    ASSERT_TRUE(report) << report.error().text();
    ASSERT_EQ(report->over_time.size(), 1u) << "a clip without duration has no times";
    const ClipDeviation& deviation = report->over_time[0];
    const Clip& clip = source.clips[1];
    EXPECT_EQ(deviation.clip, 1u);
    ASSERT_EQ(deviation.times.size(), std::min(most, 61u)) << "two seconds";
    EXPECT_EQ(deviation.times.front(), 0.0);
    EXPECT_EQ(deviation.times.back(), static_cast<double>(clip.duration));
    Pose pose = *local_rest_pose(source);
    ModelPose model_pose;
    for (std::size_t i = 0; i < deviation.times.size(); ++i) {
      ASSERT_TRUE(sample_clip(clip, deviation.times[i], pose));
      ASSERT_TRUE(compute_model_pose(source.skeleton, pose, model_pose));
      model_pose.morph_weights.assign(source.rest_morph_weights.size(), 0.0f);
      const auto a = posed_positions(source, 0, model_pose),
                 b = posed_positions(target, 0, model_pose);
      double maximum = 0, square = 0;
      for (std::size_t v = 0; v < a.size(); ++v) {
        maximum = std::max(maximum, (a[v] - b[v]).norm());
        square += (a[v] - b[v]).squaredNorm();
      }
      EXPECT_NEAR(deviation.maximum[i], maximum, 1e-6);
      EXPECT_NEAR(deviation.rms[i], std::sqrt(square / static_cast<double>(a.size())), 1e-6);
    }
    if (most > 2) {  // at both ends of the clip the tube stands straight
      EXPECT_GT(*std::ranges::max_element(deviation.maximum), 1e-3);
    }
  }
}

TEST(ValidateSkin, figures_of_papers_follow_their_formulas) {
  const auto [source, target] = tube_and_copy();
  ValidationOptions options;
  options.random_poses = 10;
  const auto report = validate_skin(share(source), share(target), options);
  ASSERT_TRUE(report) << report.error().text();
  const PaperFigures& papers = report->papers;
  ASSERT_TRUE(papers.is_tested);
  EXPECT_EQ(papers.frames, 10u);
  const PosedFigures& random = report->posed.back();
  EXPECT_NEAR(papers.rms, random.rms, 1e-9 * random.rms);
  EXPECT_NEAR(papers.distance_maximum, random.maximum, 1e-9 * random.maximum);
  EXPECT_NEAR(papers.distance_mean, random.mean, 1e-9 * random.mean);
  EXPECT_NEAR(papers.rms_1000, 1000 * papers.rms / std::sqrt(3.0) / report->diagonal,
              1e-9 * papers.rms_1000);
  EXPECT_GT(papers.kg_error, 0.0);
  EXPECT_EQ(papers.influence_precision, 1.0);
  EXPECT_GT(papers.weight_l1, 0.0);
}

TEST(ValidateSkin, wrong_input_is_refused) {
  const Shared tube = share(make_tube(8, 8, 3));
  EXPECT_EQ(validate_skin(nullptr, tube).error().code(), StatusCode::empty_input);
  ValidationOptions options;
  const std::vector<StoredInfluences> two(2);
  options.stored_target = two;
  EXPECT_EQ(validate_skin(tube, tube, options).error().code(), StatusCode::size_mismatch);
  options = {};
  options.bone_names = {{"bone", "no such bone"}};
  EXPECT_FALSE(validate_skin(tube, tube, options));
  Character broken = *tube;
  broken.meshes[0].weights.influences[0].weight = -1.0f;
  EXPECT_EQ(validate_skin(tube, share(broken)).error().code(), StatusCode::weights_not_normalized);
}

TEST(ValidateSkin, the_result_has_the_same_bits_each_time) {
  const auto [source, target] = tube_and_copy();
  const auto first = validate_skin(share(source), share(target)),
             second = validate_skin(share(source), share(target));
  ASSERT_TRUE(first && second);
  ASSERT_EQ(first->findings.size(), second->findings.size());
  for (std::size_t i = 0; i < first->findings.size(); ++i) {
    EXPECT_EQ(first->findings[i].text, second->findings[i].text);
    EXPECT_EQ(first->findings[i].value, second->findings[i].value);
  }
  EXPECT_EQ(first->bracket.certified, second->bracket.certified);
}

TEST(ValidateSkin, a_profile_that_keeps_all_costs_nothing_and_bytes_cost_something) {
  const Shared tube = share(make_tube(16, 12, 4));
  ValidationOptions options;
  options.profile = TargetProfile::unity4;
  const auto kept = validate_skin(tube, tube, options);
  ASSERT_TRUE(kept);
  options.profile = TargetProfile::gltf4;
  const auto bytes = validate_skin(tube, tube, options);
  ASSERT_TRUE(bytes);
  const auto cost = [](const ValidationReport& report) {
    const auto found =
        std::ranges::find(report.findings, std::string_view("SUNDER_W_PROFILE"), &Finding::code);
    return found == report.findings.end() ? -1.0 : found->value;
  };
  EXPECT_EQ(cost(*kept), 0.0);
  EXPECT_GT(cost(*bytes), 0.0);
}

TEST(FindingKinds, codes_are_unique_and_every_one_has_a_verdict) {
  std::set<std::string_view> codes;
  for (const FindingKind& kind : finding_kinds()) {
    EXPECT_TRUE(kind.code.starts_with("SUNDER_W_"));
    EXPECT_TRUE(codes.insert(kind.code).second) << kind.code;
    EXPECT_TRUE(kind.advice.ends_with('.')) << kind.code;
  }
  const Shared tube = share(make_tube(8, 8, 3));
  const auto report = validate_skin(tube, tube);
  ASSERT_TRUE(report);
  ASSERT_EQ(report->verdicts.size(), finding_kinds().size());
  for (const CodeVerdict& verdict : report->verdicts) {
    EXPECT_NE(verdict.verdict, Verdict::fail) << verdict.code;
    EXPECT_EQ(verdict.why.empty(), verdict.verdict != Verdict::not_tested) << verdict.code;
  }
}

/// The row of the table in docs/validation_codes.md.
std::string row_of(const FindingKind& kind) {
  std::ostringstream row;
  row << "| `" << kind.code << "` | " << severity_name(kind.severity) << " | " << kind.threshold
      << ' ' << kind.unit << " | " << kind.meaning << " | " << kind.advice << " | "
      << (kind.gltf_code.empty() ? "" : "`" + std::string(kind.gltf_code) + "`") << " |";
  return row.str();
}

TEST(FindingKinds, the_documentation_has_the_same_table) {
  std::ostringstream text;
  text << std::ifstream(SUNDER_SOURCE_DIR "/docs/validation_codes.md").rdbuf();
  std::size_t at = 0;
  for (const FindingKind& kind : finding_kinds()) {
    const std::size_t found = text.str().find(row_of(kind), at);
    ASSERT_NE(found, std::string::npos) << row_of(kind);
    at = found;
  }
  const std::string all = text.str();
  std::size_t rows = 0;
  for (std::size_t i = all.find("\n| `SUNDER_W_"); i != std::string::npos;
       i = all.find("\n| `SUNDER_W_", i + 1))
    ++rows;
  EXPECT_EQ(rows, finding_kinds().size());
}

}  // namespace
}  // namespace sunder::test
