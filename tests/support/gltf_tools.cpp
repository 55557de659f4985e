#include "support/gltf_tools.h"

#include <algorithm>
#include <cstdio>
#include <cstdlib>

namespace sunder::test {

bool has_welding_tools() {
  static const bool are_there = [] {
    const auto packages = {"@gltf-transform/core", "@gltf-transform/functions", "gltfpack", "three"};
    const std::filesystem::path modules = std::filesystem::path(SUNDER_TESTS_NPM) / "node_modules";
    return std::all_of(packages.begin(), packages.end(),
                       [&](const char* name) { return std::filesystem::exists(modules / name); }) &&
           std::system("node --version > /dev/null 2>&1") == 0;
  }();
  return are_there;
}

std::string weld_by_tool(const std::string& tool, const std::filesystem::path& input, const std::filesystem::path& output) {
  const std::string command =
      "node '" SUNDER_TESTS_NPM "/weld.mjs' " + tool + " '" + input.string() + "' '" + output.string() + "' 2>&1";
  std::FILE* const pipe = popen(command.c_str(), "r");
  if (pipe == nullptr) return "it could not be started";
  std::string said;
  char buffer[4096];
  while (const std::size_t size = std::fread(buffer, 1, sizeof buffer, pipe)) said.append(buffer, size);
  if (pclose(pipe) == 0 && std::filesystem::exists(output)) return {};
  return "it failed: " + said;
}

}  // namespace sunder::test
