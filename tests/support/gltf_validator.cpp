#include "support/gltf_validator.h"

#include <cstdio>
#include <cstdlib>

namespace sunder::test {

bool has_gltf_validator() {
  static const bool is_there =
      std::filesystem::exists(std::filesystem::path(SUNDER_TESTS_NPM) / "node_modules" / "gltf-validator") &&
      std::system("node --version > /dev/null 2>&1") == 0;
  return is_there;
}

ValidatorReport validate_glb(const std::filesystem::path& file) {
  ValidatorReport report;
  const std::string command = "node '" SUNDER_TESTS_NPM "/validate.mjs' '" + file.string() + "' 2>&1";
  std::FILE* const pipe = popen(command.c_str(), "r");
  if (pipe == nullptr) return report;
  char buffer[4096];
  while (const std::size_t size = std::fread(buffer, 1, sizeof buffer, pipe)) report.output.append(buffer, size);
  if (pclose(pipe) == 0) std::sscanf(report.output.c_str(), "{\"errors\":%d", &report.errors);
  return report;
}

}  // namespace sunder::test
