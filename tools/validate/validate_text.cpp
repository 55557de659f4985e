#include <algorithm>

#include "tools/messages/printed.h"
#include "tools/validate/validate.h"

namespace sunder::tools {
namespace {

Colour colour_of(Severity severity) {
  return severity == Severity::error     ? Colour::red
         : severity == Severity::warning ? Colour::yellow
                                         : Colour::cyan;
}

void add_posed(Lines& lines, const ValidationReport& report) {
  for (const PosedFigures& figures : report.posed) {
    if (figures.pose_count == 0) {
      lines.add(printed("%-16s not tested", std::string(figures.poses).c_str()));
      continue;
    }
    lines.add(
        printed("%-16s %4u poses  mean %.3g  rms %.3g  p95 %.3g  max %.3g m (%.3g %% of the "
                "diagonal, %.3g %% of an edge)",
                std::string(figures.poses).c_str(), figures.pose_count, figures.mean, figures.rms,
                figures.p95, figures.maximum, 100.0 * figures.maximum_of_diagonal,
                100.0 * figures.maximum_of_edge));
    if (figures.covered_share > 0.0)
      lines.add(
          printed("%-16s no more than this max in %.1f %% of such poses, with confidence 95 %%", "",
                  100.0 * figures.covered_share));
  }
}

/// "worst deviation …; " over all poses that were tried; empty if none was.
std::string worst_deviation(const ValidationReport& report) {
  double worst = -1;
  for (const PosedFigures& figures : report.posed)
    if (figures.pose_count > 0) worst = std::max(worst, figures.maximum);
  if (worst < 0) return {};
  // Without a finding of the weights, what is left is the interpolation on the source's faces.
  const bool is_of_weights = std::ranges::find(report.findings, "SUNDER_W_DEVIATION",
                                               &Finding::code) != report.findings.end();
  const bool is_large = worst > ValidationOptions().maximum_deviation * report.diagonal;
  return printed("worst deviation %.3g m, %.3g %% of the diagonal%s; ", worst,
                 report.diagonal > 0 ? 100 * worst / report.diagonal : 0.0,
                 is_large && !is_of_weights ? ", by interpolation on faces, not by weights" : "");
}

std::string bracket_line(const DeviationBracket& bracket) {
  if (!bracket.is_tested) return printed("%-16s none: %s", "certificate", bracket.why.c_str());
  return printed("%-16s all poses within the limits: found %.4g m, certified %.4g m.%.300s",
                 "certificate", bracket.found, bracket.certified, bracket.why.c_str());
}

}  // namespace

Lines validation_text(const ValidatedPair& pair, Severity fail_on, bool in_colour) {
  const ValidationReport& report = pair.report;
  Lines lines;
  lines.add(pair.source_file.string() + " -> " + pair.target_file.string());
  for (const Finding& finding : report.findings) {
    lines.add(in_colour ? colour_of(finding.severity) : Colour::none,
              printed("%-8s", std::string(severity_name(finding.severity)).c_str()),
              " " + std::string(finding.code));
    lines.add("         " + finding.text);
    if (finding.severity > Severity::note) lines.add("         " + std::string(finding.advice));
  }
  lines.add(printed("%-16s %u of %u vertices unmatched; of the source %u of %u", "matching",
                    report.matching.target_unmatched, report.matching.target_samples,
                    report.matching.source_unmatched, report.matching.source_samples));
  add_posed(lines, report);
  lines.add(bracket_line(report.bracket));
  const auto count = [&](Severity severity) {
    return static_cast<unsigned>(std::ranges::count(report.findings, severity, &Finding::severity));
  };
  const auto untested =
      std::ranges::count(report.verdicts, Verdict::not_tested, &CodeVerdict::verdict);
  const bool fails = has_findings(report, fail_on);
  lines.add(!in_colour ? Colour::none
            : fails    ? Colour::red
                       : Colour::cyan,
            printed("%-16s %s", "verdict", fails ? "FAIL" : "PASS"),
            printed(": %u errors, %u warnings, %u notes; %s%u of %zu checks not tested",
                    count(Severity::error), count(Severity::warning), count(Severity::note),
                    worst_deviation(report).c_str(), static_cast<unsigned>(untested),
                    report.verdicts.size()));
  return lines;
}

}  // namespace sunder::tools
