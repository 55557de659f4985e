#include "io/urdf/findings.h"

#include <algorithm>
#include <utility>

#include "io/urdf/finding_kinds.h"

namespace sunder::urdf {
namespace {

/// Names come from the file and may have any length.
constexpr std::size_t kLongestName = 80;
constexpr std::size_t kMostOfOneCode = 100;

}  // namespace

Place place_of(std::string_view kind, std::string_view name, std::uint32_t line) {
  return {std::string(kind) + " '" + std::string(name.substr(0, kLongestName)) + "'", line};
}

void Findings::add(std::string_view code, const Place& place, std::string text) {
  const FindingKind& kind = kind_of(code);
  Count& count = counts_[kind.code];
  if (++count.added > kMostOfOneCode) return;
  count.last = all_.size();
  const bool is_refusal = strict_ && kind.severity == RobotSeverity::warning;
  all_.push_back({kind.code, is_refusal ? RobotSeverity::error : kind.severity, place.name,
                  place.line, std::move(text)});
}

Status Findings::status() const {
  for (const RobotFinding& finding : all_) {
    if (finding.severity != RobotSeverity::error) continue;
    const std::string where = finding.place.empty() ? std::string() : finding.place + ": ";
    const std::string line =
        finding.line == 0 ? std::string() : "line " + std::to_string(finding.line) + ": ";
    return Status::failure(kind_of(finding.code).status, finding.line == 0 ? kNone : finding.line,
                           "%s%s%s", line.c_str(), where.c_str(), finding.text.c_str());
  }
  return {};
}

std::vector<RobotFinding> Findings::take() {
  for (const auto& [code, count] : counts_)
    if (count.added > kMostOfOneCode)
      all_[count.last].text += "; and " + std::to_string(count.added - kMostOfOneCode) + " more";
  std::stable_sort(all_.begin(), all_.end(),
                   [](const RobotFinding& a, const RobotFinding& b) { return a.line < b.line; });
  return std::move(all_);
}

}  // namespace sunder::urdf
