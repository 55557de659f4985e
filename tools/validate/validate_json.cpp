#include <algorithm>
#include <cmath>

#include "tools/validate/validate.h"

namespace sunder::tools {
namespace {

const char* evidence_name(Evidence evidence) {
  switch (evidence) {
    case Evidence::exact: return "exact";
    case Evidence::certified: return "certified";
    case Evidence::sampled: return "sampled";
    case Evidence::not_tested: return "not tested";
  }
  return "not tested";
}

const char* verdict_name(Verdict verdict) {
  switch (verdict) {
    case Verdict::pass: return "Pass";
    case Verdict::fail: return "Fail";
    case Verdict::not_tested: return "Not tested";
  }
  return "Not tested";
}

/// A place in the target; its pointer is that of the accessor of weights in the target's document,
/// where the file is a glTF.
Json place_json(const FindingPlace& place, const LoadedCharacter& target) {
  const Character& character = *target.character;
  Json json = Json::object();
  if (place.mesh != kNone) {
    json["mesh"] = place.mesh;
    json["mesh_name"] = character.meshes[place.mesh].name;
    if (place.mesh < target.stored.size())
      json["pointer"] = target.stored[place.mesh].place + "/attributes/WEIGHTS_0";
  }
  if (place.vertex != kNone) json["vertex"] = place.vertex;
  if (place.bone != kNone && place.bone < character.skeleton.bones.size()) {
    json["bone"] = place.bone;
    json["bone_name"] = character.skeleton.bones[place.bone].name;
  }
  json["position"] = vector_json(place.position);
  json["value"] = place.value;
  return json;
}

Json finding_json(const Finding& finding, const LoadedCharacter& target) {
  Json places = Json::array();
  for (const FindingPlace& place : finding.places) places.push_back(place_json(place, target));
  return {{"code", finding.code},
          {"severity", severity_name(finding.severity)},
          {"evidence", evidence_name(finding.evidence)},
          {"text", finding.text},
          {"advice", finding.advice},
          {"gltf_validator", finding.gltf_code},
          {"value", finding.value},
          {"threshold", finding.threshold},
          {"unit", finding.unit},
          {"count", finding.count},
          {"places", std::move(places)}};
}

Json posed_json(const PosedFigures& figures, const LoadedCharacter& target) {
  if (figures.pose_count == 0)
    return {{"poses", figures.poses}, {"evidence", evidence_name(Evidence::not_tested)}};
  return {{"poses", figures.poses},
          {"evidence", evidence_name(Evidence::sampled)},
          {"n", figures.pose_count},
          {"samples", figures.sample_count},
          {"mean", figures.mean},
          {"rms", figures.rms},
          {"p95", figures.p95},
          {"max", figures.maximum},
          {"max_of_diagonal", figures.maximum_of_diagonal},
          {"max_of_edge", figures.maximum_of_edge},
          {"confidence", figures.covered_share > 0.0 ? 0.95 : 0.0},
          {"covered_share", figures.covered_share},
          {"worst", place_json(figures.worst, target)}};
}

/// A pose as an operation log takes it: one 3 x 4 matrix per bone, column by column.
Json pose_json(const ModelPose& pose) {
  Json matrices = Json::array();
  for (const Affine3d& matrix : pose.model_from_bone) {
    Json numbers = Json::array();
    for (int i = 0; i < 12; ++i) numbers.push_back(matrix.matrix()(i % 3, i / 3));
    matrices.push_back(std::move(numbers));
  }
  return matrices;
}

Json bracket_json(const DeviationBracket& bracket, const LoadedCharacter& target) {
  if (!bracket.is_tested)
    return {{"evidence", evidence_name(Evidence::not_tested)}, {"why", bracket.why}};
  Json json = {{"evidence", evidence_name(Evidence::certified)},
               {"found", bracket.found},
               {"certified", bracket.certified},
               {"uncertified_vertices", bracket.uncertified},
               {"why", bracket.why}};
  if (bracket.worst.vertex != kNone) {
    json["worst"] = place_json(bracket.worst, target);
    json["pose"] = pose_json(bracket.pose);
  }
  return json;
}

Json papers_json(const PaperFigures& papers) {
  if (!papers.is_tested) return {{"evidence", evidence_name(Evidence::not_tested)}};
  return {{"evidence", evidence_name(Evidence::sampled)},
          {"points", papers.points},
          {"frames", papers.frames},
          {"kg_error", papers.kg_error},
          {"rms_x1000_over_sqrt_3nf_of_diagonal", papers.rms_1000},
          {"rms", papers.rms},
          {"distance_mean", papers.distance_mean},
          {"distance_max", papers.distance_maximum},
          {"influence_precision", papers.influence_precision},
          {"influence_recall", papers.influence_recall},
          {"weight_l1", papers.weight_l1}};
}

Json matching_json(const MatchFigures& matching) {
  const auto direction = [](Index samples, Index unmatched, double distance) {
    return Json{{"samples", samples}, {"unmatched", unmatched}, {"max_distance", distance}};
  };
  return {{"target_on_source",
           direction(matching.target_samples, matching.target_unmatched, matching.target_distance)},
          {"source_on_target", direction(matching.source_samples, matching.source_unmatched,
                                         matching.source_distance)}};
}

}  // namespace

Json validation_json(const ValidatedPair& pair) {
  const ValidationReport& report = pair.report;
  Json verdicts = Json::object();
  for (const CodeVerdict& verdict : report.verdicts) {
    Json& of = verdicts[std::string(verdict.code)];
    of = {{"result", verdict_name(verdict.verdict)}};
    if (verdict.verdict == Verdict::not_tested) of["why"] = verdict.why;
  }
  Json counts = Json::object();
  for (const Severity severity : {Severity::error, Severity::warning, Severity::note})
    counts[std::string(severity_name(severity))] =
        std::ranges::count(report.findings, severity, &Finding::severity);
  Json findings = Json::array(), posed = Json::array(), histogram = Json::array();
  for (const Finding& finding : report.findings)
    findings.push_back(finding_json(finding, pair.target));
  for (const PosedFigures& figures : report.posed)
    posed.push_back(posed_json(figures, pair.target));
  for (const std::uint64_t count : report.influence_histogram) histogram.push_back(count);
  return {{"sunder_validation", 1},
          {"source", pair.source_file.string()},
          {"target", pair.target_file.string()},
          {"diagonal", report.diagonal},
          {"scale", report.scale},
          {"counts", std::move(counts)},
          {"verdicts", std::move(verdicts)},
          {"findings", std::move(findings)},
          {"matching", matching_json(report.matching)},
          {"posed", std::move(posed)},
          {"certificate", bracket_json(report.bracket, pair.target)},
          {"papers", papers_json(report.papers)},
          {"influences", std::move(histogram)}};
}

}  // namespace sunder::tools
