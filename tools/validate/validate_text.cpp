#include <algorithm>

#include "tools/messages/printed.h"
#include "tools/validate/validate.h"

namespace sunder::tools {
namespace {

/// The name of a severity, eight wide, in its colour.
std::string label(Severity severity, bool in_colour) {
  const std::string name = printed("%-8s", std::string(severity_name(severity)).c_str());
  if (!in_colour) return name;
  const char* const colour = severity == Severity::error     ? "\x1b[31m"
                             : severity == Severity::warning ? "\x1b[33m"
                                                             : "\x1b[36m";
  return colour + name + "\x1b[0m";
}

std::string posed_lines(const ValidationReport& report) {
  std::string text;
  for (const PosedFigures& figures : report.posed) {
    if (figures.pose_count == 0) {
      text += printed("%-16s not tested\n", std::string(figures.poses).c_str());
      continue;
    }
    text += printed(
        "%-16s %4u poses  mean %.3g  rms %.3g  p95 %.3g  max %.3g m (%.3g %% of the "
        "diagonal, %.3g %% of an edge)\n",
        std::string(figures.poses).c_str(), figures.pose_count, figures.mean, figures.rms,
        figures.p95, figures.maximum, 100.0 * figures.maximum_of_diagonal,
        100.0 * figures.maximum_of_edge);
    if (figures.covered_share > 0.0)
      text +=
          printed("%-16s no more than this max in %.1f %% of such poses, with confidence 95 %%\n",
                  "", 100.0 * figures.covered_share);
  }
  return text;
}

std::string bracket_line(const DeviationBracket& bracket) {
  if (!bracket.is_tested) return printed("%-16s none: %s\n", "certificate", bracket.why.c_str());
  return printed("%-16s all poses within the limits: found %.4g m, certified %.4g m.%.300s\n",
                 "certificate", bracket.found, bracket.certified, bracket.why.c_str());
}

}  // namespace

std::string validation_text(const ValidatedPair& pair, bool in_colour) {
  const ValidationReport& report = pair.report;
  std::string text = pair.source_file.string() + " -> " + pair.target_file.string() + "\n";
  for (const Finding& finding : report.findings) {
    text += label(finding.severity, in_colour) + " " + std::string(finding.code) + "\n         " +
            finding.text + "\n";
    if (finding.severity > Severity::note) text += "         " + std::string(finding.advice) + "\n";
  }
  text += printed("%-16s %u of %u vertices unmatched; of the source %u of %u\n", "matching",
                  report.matching.target_unmatched, report.matching.target_samples,
                  report.matching.source_unmatched, report.matching.source_samples);
  text += posed_lines(report) + bracket_line(report.bracket);
  const auto count = [&](Severity severity) {
    return static_cast<unsigned>(std::ranges::count(report.findings, severity, &Finding::severity));
  };
  const auto untested =
      std::ranges::count(report.verdicts, Verdict::not_tested, &CodeVerdict::verdict);
  text += printed("%-16s %u errors, %u warnings, %u notes; %u of %zu checks not tested\n",
                  "verdict", count(Severity::error), count(Severity::warning),
                  count(Severity::note), static_cast<unsigned>(untested), report.verdicts.size());
  return text;
}

}  // namespace sunder::tools
