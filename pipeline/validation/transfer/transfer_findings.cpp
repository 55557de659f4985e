#include "pipeline/validation/transfer/transfer_findings.h"

#include <algorithm>
#include <string>

namespace sunder::validation {
namespace {

constexpr std::size_t kMostTransferPlaces = 64;
constexpr double kFewMatches = 0.5;
constexpr double kManyClamped = 0.05;

std::string percent(double share) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3g %%", 100 * share);
  return text;
}

void find_parts_without_match(const TransferFacts& facts, TransferResult& result) {
  if (result.parts_without_match == 0) return;
  Finding finding;
  finding.code = "SUNDER_T_PART";
  finding.severity = Severity::warning;
  finding.advice =
      "Check that these parts belong to the source, or raise the distance and the angle.";
  finding.unit = "count";
  finding.value = result.parts_without_match;
  std::vector<bool> is_listed(facts.parts.count, false);
  for (Index v = 0; v < facts.surface.vertex_count(); ++v) {
    const Index part = facts.parts.of[facts.points.point_of_vertex[v]];
    if (facts.part_has_match[part]) continue;
    ++finding.count;
    if (is_listed[part] || finding.places.size() == kMostTransferPlaces) continue;
    is_listed[part] = true;
    const Index mesh = facts.surface.mesh_of_vertex(v);
    finding.places.push_back(
        {mesh, v - facts.surface.first_vertex[mesh], kNone, facts.surface.positions[v], 0});
  }
  finding.text = std::to_string(result.parts_without_match) + " of " +
                 std::to_string(result.parts) + " connected parts (" +
                 std::to_string(finding.count) +
                 " vertices) have no accepted match; their vertices take the weights of the "
                 "closest place on the source";
  result.findings.push_back(std::move(finding));
}

void find_few_matches(TransferResult& result) {
  if (result.matched_share() >= kFewMatches) return;
  Finding finding;
  finding.code = "SUNDER_T_FEW_MATCHES";
  finding.severity = Severity::warning;
  finding.text = "only " + percent(result.matched_share()) +
                 " of the vertices have an accepted match: " + std::to_string(result.too_far) +
                 " are too far, " + std::to_string(result.turned_away) + " are turned away";
  finding.advice = "Check that both models stand in the same place, pose and unit.";
  finding.unit = "share";
  finding.value = result.matched_share();
  finding.threshold = kFewMatches;
  finding.count = result.too_far + result.turned_away;
  result.findings.push_back(std::move(finding));
}

void find_lost_bones(const TransferFacts& facts, TransferResult& result) {
  const auto& lost = facts.bones.lost;
  if (lost.empty()) return;
  Finding finding;
  finding.code = "SUNDER_T_BONE_LOST";
  finding.severity = Severity::warning;
  finding.advice = "Name the counterparts of these bones, or give the target the skeleton.";
  finding.unit = "count";
  finding.value = static_cast<double>(lost.size());
  finding.count = lost.size();
  finding.text = "the target lacks " + std::to_string(lost.size()) +
                 " bones that move the source; their weights go to their ancestors:";
  for (std::size_t i = 0; i < std::min<std::size_t>(lost.size(), 8); ++i)
    finding.text += (i == 0 ? " '" : ", '") + facts.source.skeleton.bones[lost[i]].name + "'";
  if (lost.size() > 8) finding.text += ", …";
  for (std::size_t i = 0; i < std::min(lost.size(), kMostTransferPlaces); ++i)
    finding.places.push_back({kNone, kNone, facts.bones.of_source[lost[i]], Vec3d::Zero(), 0});
  result.findings.push_back(std::move(finding));
}

void find_fuzzy_bones(TransferResult& result) {
  if (result.fuzzy_bones.empty()) return;
  Finding finding;
  finding.code = "SUNDER_T_BONE_FUZZY";
  finding.advice = "Check these pairs; name the right ones where they are wrong.";
  finding.unit = "count";
  finding.count = result.fuzzy_bones.size();
  finding.value = static_cast<double>(finding.count);
  finding.text = std::to_string(finding.count) + " bones were matched by similar names:";
  for (std::size_t i = 0; i < std::min<std::size_t>(result.fuzzy_bones.size(), 8); ++i)
    finding.text += (i == 0 ? " '" : ", '") + result.fuzzy_bones[i].target + "' = '" +
                    result.fuzzy_bones[i].source + "'";
  if (result.fuzzy_bones.size() > 8) finding.text += ", …";
  result.findings.push_back(std::move(finding));
}

void find_poor_triangles(TransferResult& result) {
  if (result.inpainted == 0 || result.clamped_edges <= kManyClamped * result.edges) return;
  Finding finding;
  finding.code = "SUNDER_T_TRIANGLES";
  finding.text = std::to_string(result.clamped_edges) + " of " + std::to_string(result.edges) +
                 " edges have a cotangent weight that had to be clamped";
  finding.advice = "Remesh parts with obtuse or thin triangles for smoother weights.";
  finding.unit = "share";
  finding.value = static_cast<double>(result.clamped_edges) / result.edges;
  finding.threshold = kManyClamped;
  finding.count = result.clamped_edges;
  result.findings.push_back(std::move(finding));
}

void find_adopted_skeleton(const TransferFacts& facts, TransferResult& result) {
  if (!result.has_adopted_skeleton) return;
  Finding finding;
  finding.code = "SUNDER_T_SKELETON";
  finding.count = facts.bones.skeleton.bones.size() - facts.target.skeleton.bones.size();
  finding.value = static_cast<double>(finding.count);
  finding.unit = "count";
  finding.text = "no bone of the source moves the target; it got " + std::to_string(finding.count) +
                 " bones of the source";
  finding.advice = "Name the counterparts of the bones if the target has a skeleton of its own.";
  result.findings.push_back(std::move(finding));
}

}  // namespace

void add_findings(const TransferFacts& facts, TransferResult& result) {
  find_few_matches(result);
  find_parts_without_match(facts, result);
  find_lost_bones(facts, result);
  find_fuzzy_bones(result);
  find_adopted_skeleton(facts, result);
  find_poor_triangles(result);
}

}  // namespace sunder::validation
