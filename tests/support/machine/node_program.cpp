#include "support/machine/node_program.h"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>

namespace sunder::test {

bool has_node_packages(std::initializer_list<const char*> packages) {
  const std::filesystem::path modules = std::filesystem::path(SUNDER_TESTS_NPM) / "node_modules";
  return std::all_of(packages.begin(), packages.end(),
                     [&](const char* name) { return std::filesystem::exists(modules / name); }) &&
         std::system("node --version > /dev/null 2>&1") == 0;
}

std::optional<ProgramRun> run_node_program(const std::string& program,
                                           const std::string& arguments) {
  const std::string command = "node '" SUNDER_TESTS_NPM "/" + program + "' " + arguments + " 2>&1";
  std::FILE* const pipe = popen(command.c_str(), "r");
  if (pipe == nullptr) return {};
  ProgramRun run;
  char buffer[4096];
  while (const std::size_t size = std::fread(buffer, 1, sizeof buffer, pipe))
    run.output.append(buffer, size);
  run.succeeded = pclose(pipe) == 0;
  return run;
}

}  // namespace sunder::test
