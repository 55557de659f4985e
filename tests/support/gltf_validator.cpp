#include "support/gltf_validator.h"

#include <cstdio>

#include "support/node_program.h"

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

}  // namespace sunder::test
