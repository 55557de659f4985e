#include "bench/stress/summary.h"

#include <algorithm>
#include <cstdio>
#include <set>

#include "bench/harness/json_object.h"

namespace sunder::stress {
namespace {

double count_of(const std::map<std::string, std::uint64_t>& violations,
                const std::set<std::string>& laws) {
  double count = 0;
  for (const auto& [law, cases] : violations)
    if (laws.contains(law)) count += static_cast<double>(cases);
  return count;
}

}  // namespace

void Summary::add(const Outcome& outcome) {
  OfFamily& family = families_[outcome.name.family];
  const CaseReport& report = outcome.report;
  ++family.cases;
  family.seconds += outcome.seconds;
  CaseReport& total = family.total;
  total.operations += report.operations;
  total.refused += report.refused;
  total.allocation_failures += report.allocation_failures;
  total.faces = std::max(total.faces, report.faces);
  total.weight_sum_error = std::max(total.weight_sum_error, report.weight_sum_error);
  total.area_drift = std::max(total.area_drift, report.area_drift);
  total.smallest_angle = std::min(total.smallest_angle, report.smallest_angle);
  std::set<std::string> laws;
  for (const Violation& violation : report.violations) laws.insert(violation.law);
  for (const std::string& law : laws) ++violations_[law];
  if (!laws.empty()) ++family.failed;
}

void Summary::print_table() const {
  std::printf("%-12s %9s %10s %9s %7s %11s %11s %12s\n", "family", "cases", "operations", "refused",
              "failed", "weight sum", "area drift", "us per op");
  for (const auto& [name, family] : families_)
    std::printf("%-12s %9llu %10llu %9llu %7llu %11.2g %11.2g %12.0f\n", name.c_str(),
                static_cast<unsigned long long>(family.cases),
                static_cast<unsigned long long>(family.total.operations),
                static_cast<unsigned long long>(family.total.refused),
                static_cast<unsigned long long>(family.failed), family.total.weight_sum_error,
                family.total.area_drift,
                1e6 * family.seconds /
                    static_cast<double>(std::max<std::uint64_t>(family.total.operations, 1)));
  for (const auto& [law, cases] : violations_)
    std::printf("broken: %s, in %llu cases\n", law.c_str(), static_cast<unsigned long long>(cases));
}

void Summary::print_json() const {
  CaseReport all;
  double adversarial = 0;
  for (const auto& [name, family] : families_) {
    all.operations += family.total.operations;
    all.allocation_failures += family.total.allocation_failures;
    all.weight_sum_error = std::max(all.weight_sum_error, family.total.weight_sum_error);
    if (find_family(name)->is_adversarial)
      adversarial += static_cast<double>(family.total.operations);
  }
  const auto of = [&](const char* name) {
    const auto at = families_.find(name);
    return at == families_.end() ? nullptr : &at->second.total;
  };
  const CaseReport *cuts = of("cuts"), *region = of("region");
  double violations = 0;
  for (const auto& [law, cases] : violations_)
    if (law != "crash" && law != "hang") violations += static_cast<double>(cases);
  bench::JsonObject json;
  json.add("operations", static_cast<double>(all.operations));
  json.add("adversarial", adversarial);
  json.add("violations", violations);
  json.add("crashes", count_of(violations_, {"crash", "hang"}));
  json.add("area_drift_300", cuts ? std::optional(cuts->area_drift) : std::nullopt);
  json.add("weight_sum_error", all.weight_sum_error);
  json.add("undo_mismatches", count_of(violations_, {"undo", "redo"}));
  json.add("digest_mismatches",
           count_of(violations_, {"replay", "failing call changes nothing", "memory", "snapshot",
                                  "same bits in every build"}));
  json.add("allocation_failures_tried", static_cast<double>(all.allocation_failures));
  json.add("faces_after_1000",
           region ? std::optional(static_cast<double>(region->faces)) : std::nullopt);
  json.add("angle_p1_after_1000", region ? std::optional(region->smallest_angle) : std::nullopt);
  json.end();
}

}  // namespace sunder::stress
