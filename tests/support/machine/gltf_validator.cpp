#include "support/machine/gltf_validator.h"

#include <cstdio>
#include <sstream>
#include <utility>

#include "support/machine/node_program.h"

namespace sunder::test {

bool has_gltf_validator() {
  static const bool is_there = has_node_packages({"gltf-validator"});
  return is_there;
}

ValidatorReport validate_glb(const std::filesystem::path& file) {
  ValidatorReport report;
  const auto run = run_node_program("validate.mjs", "'" + file.string() + "'");
  if (!run) return report;
  report.output = run->output;
  if (run->succeeded) std::sscanf(report.output.c_str(), "{\"errors\":%d", &report.errors);
  return report;
}

std::vector<ValidatorReport> validate_glbs_of(const std::filesystem::path& folder) {
  std::vector<ValidatorReport> reports;
  const auto run = run_node_program("validate.mjs", "--folder '" + folder.string() + "'");
  if (!run) return reports;
  std::istringstream lines(run->output);
  for (std::string line; std::getline(lines, line);) {
    ValidatorReport& report = reports.emplace_back();
    std::sscanf(line.c_str(), "{\"errors\":%d", &report.errors);
    report.output = std::move(line);
  }
  return reports;
}

}  // namespace sunder::test
