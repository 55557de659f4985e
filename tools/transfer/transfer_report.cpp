#include "tools/transfer/transfer_report.h"

#include <sunder/validation/validation.h>

#include "tools/messages/printed.h"

namespace sunder::tools {
namespace {

const char* method_name(TransferMethod method) {
  return method == TransferMethod::inpainting ? "inpainting" : "closest";
}

void add_count(Lines& lines, const char* what, std::uint32_t count, std::uint32_t of,
               const char* how) {
  lines.add(
      printed("  %-12s %9u  %5.1f %%  %s", what, count, of == 0 ? 0.0 : 100.0 * count / of, how));
}

}  // namespace

Json to_json(const Finding& finding) {
  Json places = Json::array();
  for (const FindingPlace& place : finding.places)
    places.push_back({{"mesh", index_json(place.mesh)},
                      {"vertex", index_json(place.vertex)},
                      {"bone", index_json(place.bone)},
                      {"position", vector_json(place.position)},
                      {"value", place.value}});
  return {{"code", finding.code},       {"severity", severity_name(finding.severity)},
          {"text", finding.text},       {"advice", finding.advice},
          {"value", finding.value},     {"threshold", finding.threshold},
          {"unit", finding.unit},       {"count", finding.count},
          {"places", std::move(places)}};
}

Json transfer_json(const TransferRequest& request, const TransferResult& result) {
  const TransferOptions& options = request.options;
  Json steps = Json::array(), fuzzy = Json::array(), findings = Json::array();
  for (const TransferStep& step : result.steps)
    steps.push_back({{"name", step.name},
                     {"points", step.points},
                     {"mean", step.mean},
                     {"largest", step.largest}});
  for (const BoneNames& pair : result.fuzzy_bones)
    fuzzy.push_back({{"target", pair.target}, {"source", pair.source}});
  for (const Finding& finding : result.findings) findings.push_back(to_json(finding));
  return {{"sunder_transfer", 1},
          {"source", request.source.string()},
          {"target", request.target.string()},
          {"output", options.dry_run ? Json(nullptr) : Json(request.output.string())},
          {"method", method_name(options.method)},
          {"distance", {{"of_diagonal", options.distance}, {"metres", result.largest_distance}}},
          {"angle", options.angle},
          {"vertices", result.vertices},
          {"coincident", result.coincident},
          {"matched", result.matched},
          {"inpainted", result.inpainted},
          {"nearest", result.nearest},
          {"locked", result.locked},
          {"too_far", result.too_far},
          {"turned_away", result.turned_away},
          {"matched_share", result.matched_share()},
          {"points", result.points},
          {"parts", result.parts},
          {"parts_without_match", result.parts_without_match},
          {"edges", result.edges},
          {"clamped_edges", result.clamped_edges},
          {"floored_points", result.floored_points},
          {"has_adopted_skeleton", result.has_adopted_skeleton},
          {"fuzzy_bones", std::move(fuzzy)},
          {"steps", std::move(steps)},
          {"findings", std::move(findings)}};
}

Lines transfer_table(const TransferRequest& request, const TransferResult& result) {
  const TransferOptions& options = request.options;
  Lines lines;
  lines.add(printed("%s, matches within %g m (%g of the diagonal) and %.3g degrees",
                    method_name(options.method), result.largest_distance, options.distance,
                    options.angle * 57.295779513082323));
  lines.add(printed("  %-12s %9u", "vertices", result.vertices));
  add_count(lines, "coincident", result.coincident, result.vertices, "on a vertex of the source");
  add_count(lines, "matched", result.matched, result.vertices, "interpolated on its surface");
  add_count(lines, "inpainted", result.inpainted, result.vertices, "continued from the matched");
  add_count(lines, "nearest", result.nearest, result.vertices, "closest place without limits");
  add_count(lines, "locked", result.locked, result.vertices, "kept");
  lines.add(printed("  refused matches: %u too far, %u turned away; parts: %u, without match %u",
                    result.too_far, result.turned_away, result.parts, result.parts_without_match));
  for (const TransferStep& step : result.steps)
    if (step.points > 0)
      lines.add(printed("  step '%.*s' changed %u points by %.3g on average, %.3g at most",
                        static_cast<int>(step.name.size()), step.name.data(), step.points,
                        step.mean, step.largest));
  for (const Finding& finding : result.findings)
    lines.add(std::string(severity_name(finding.severity)) + " " + std::string(finding.code) +
              ": " + finding.text);
  return lines;
}

}  // namespace sunder::tools
