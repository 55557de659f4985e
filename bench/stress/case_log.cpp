#include "bench/stress/case_log.h"

#include <fstream>

#include <nlohmann/json.hpp>

namespace sunder::stress {

using nlohmann::json;

std::string to_line(const Outcome& outcome, const Steps& steps) {
  const CaseReport& report = outcome.report;
  json violations = json::array();
  for (const Violation& violation : report.violations)
    violations.push_back({{"law", violation.law}, {"text", violation.text}});
  json line = {{"family", outcome.name.family},
               {"seed", outcome.name.seed},
               {"operations", report.operations},
               {"refused", report.refused},
               {"faces", report.faces},
               {"weight_sum_error", report.weight_sum_error},
               {"area_drift", report.area_drift},
               {"smallest_angle", report.smallest_angle},
               {"allocation_failures", report.allocation_failures},
               {"digest", report.digest},
               {"seconds", outcome.seconds},
               {"violations", violations}};
  if (!steps.is_all()) line["steps"] = steps.kept();
  return line.dump(-1, ' ', false, json::error_handler_t::replace);
}

bool from_line(const std::string& line, Outcome& outcome, Steps& steps) {
  const json object = json::parse(line, nullptr, false);
  if (!object.is_object() || !object.contains("family") || !object.contains("seed")) return false;
  try {
    CaseReport& report = outcome.report;
    object.at("family").get_to(outcome.name.family);
    object.at("seed").get_to(outcome.name.seed);
    report.operations = object.value("operations", report.operations);
    report.refused = object.value("refused", report.refused);
    report.faces = object.value("faces", report.faces);
    report.weight_sum_error = object.value("weight_sum_error", 0.0);
    report.area_drift = object.value("area_drift", 0.0);
    report.smallest_angle = object.value("smallest_angle", 180.0);
    report.allocation_failures = object.value("allocation_failures", report.allocation_failures);
    report.digest = object.value("digest", report.digest);
    outcome.seconds = object.value("seconds", 0.0);
    for (const json& violation : object.value("violations", json::array()))
      report.violations.push_back({violation.at("law"), violation.at("text")});
    if (object.contains("steps")) steps = Steps(object["steps"].get<std::set<std::uint32_t>>());
  } catch (const json::exception&) {
    return false;
  }
  return true;
}

std::vector<std::pair<Outcome, Steps>> read_log(const std::filesystem::path& file) {
  std::vector<std::pair<Outcome, Steps>> cases;
  std::ifstream in(file);
  for (std::string line; std::getline(in, line);) {
    Outcome outcome;
    Steps steps;
    if (from_line(line, outcome, steps)) cases.emplace_back(std::move(outcome), std::move(steps));
  }
  return cases;
}

}  // namespace sunder::stress
