#include "pipeline/validation/checks/finding_list.h"

#include <algorithm>
#include <cinttypes>
#include <cstdio>
#include <utility>

namespace sunder {
namespace validation {
namespace {

constexpr std::size_t kMostPlaces = 64;

/// Worst first; equal values in the order of vertices, so that the report has the same bits.
bool is_worse(const FindingPlace& a, const FindingPlace& b) {
  if (a.value != b.value) return a.value > b.value;
  if (a.mesh != b.mesh) return a.mesh < b.mesh;
  return a.vertex != b.vertex ? a.vertex < b.vertex : a.bone < b.bone;
}

void keep_worst(Places& places) {
  const auto kept = static_cast<std::ptrdiff_t>(std::min(places.size(), kMostPlaces));
  std::partial_sort(places.begin(), places.begin() + kept, places.end(), is_worse);
  places.resize(static_cast<std::size_t>(kept));
  places.shrink_to_fit();
}

std::string number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.4g", value);
  return text;
}

}  // namespace

FindingList::FindingList(const Character& target) : target_(target) {
  for (const FindingKind& kind : finding_kinds())
    verdicts_.push_back({kind.code, Verdict::not_tested, "not applicable"});
}

std::string FindingList::place_text(const FindingPlace& place) const {
  std::string text;
  if (place.vertex != kNone) text += " at vertex " + std::to_string(place.vertex);
  if (place.mesh != kNone)
    text += std::string(place.vertex == kNone ? " in" : " of") + " mesh " +
            std::to_string(place.mesh) + " '" + target_.meshes[place.mesh].name + "'";
  if (place.bone != kNone && place.bone < target_.skeleton.bones.size())
    text += ", bone '" + target_.skeleton.bones[place.bone].name + "'";
  return text;
}

void FindingList::mark_tested(Code code, Verdict verdict) {
  CodeVerdict& of = verdicts_[static_cast<std::size_t>(code)];
  if (of.verdict != Verdict::fail) of.verdict = verdict;
  of.why.clear();
}

void FindingList::not_tested(Code code, const std::string& why) {
  CodeVerdict& of = verdicts_[static_cast<std::size_t>(code)];
  if (of.verdict == Verdict::not_tested) of.why = why;
}

void FindingList::add_finding(Code code, Severity severity, Evidence evidence, std::string text,
                              Places places, double value) {
  const FindingKind& kind = kind_of(code);
  Finding finding;
  finding.code = kind.code;
  finding.severity = severity;
  finding.evidence = evidence;
  finding.text = std::move(text);
  finding.advice = kind.advice;
  finding.gltf_code = kind.gltf_code;
  finding.value = value;
  finding.threshold = kind.threshold;
  finding.unit = kind.unit;
  finding.count = places.size();
  keep_worst(places);
  finding.places = std::move(places);
  findings_.push_back(std::move(finding));
  mark_tested(code, severity == Severity::note ? Verdict::pass : Verdict::fail);
}

void FindingList::raise_to_error(Code code) {
  for (Finding& finding : findings_)
    if (finding.code == kind_of(code).code) finding.severity = Severity::error;
}

void FindingList::add(Code code, Places places, const std::string& detail, Evidence evidence) {
  add_new(code, std::move(places), {}, detail, evidence);
}

void FindingList::add_new(Code code, Places places, const Places& inherited,
                          const std::string& detail, Evidence evidence) {
  if (places.empty() && inherited.empty()) return mark_tested(code, Verdict::pass);
  const bool is_inherited = places.empty();
  const Places& shown = is_inherited ? inherited : places;
  const FindingKind& kind = kind_of(code);
  const FindingPlace& worst = *std::min_element(shown.begin(), shown.end(), is_worse);
  std::string text = std::to_string(shown.size()) + ": " + std::string(kind.meaning) + "; worst " +
                     number(worst.value) + " " + std::string(kind.unit) + place_text(worst) + ".";
  if (!detail.empty()) text += " " + detail;
  if (is_inherited)
    text += " Inherited: the source has the same fault at the same place.";
  else if (!inherited.empty())
    text += " " + std::to_string(inherited.size()) + " more are inherited from the source.";
  const double value = worst.value;
  add_finding(code, is_inherited ? Severity::note : kind.severity, evidence, std::move(text),
              is_inherited ? Places(inherited) : std::move(places), value);
}

void FindingList::finish(ValidationReport& report) {
  const auto row = [](const Finding& finding) {
    const auto kinds = finding_kinds();
    return std::find_if(kinds.begin(), kinds.end(),
                        [&](const FindingKind& kind) { return kind.code == finding.code; }) -
           kinds.begin();
  };
  std::stable_sort(findings_.begin(), findings_.end(), [&](const Finding& a, const Finding& b) {
    return a.severity != b.severity ? a.severity > b.severity : row(a) < row(b);
  });
  report.findings = std::move(findings_);
  report.verdicts = std::move(verdicts_);
}

}  // namespace validation

std::string_view severity_name(Severity severity) {
  switch (severity) {
    case Severity::note: return "note";
    case Severity::warning: return "warning";
    case Severity::error: return "error";
  }
  return "note";
}

}  // namespace sunder
