#pragma once

#include <initializer_list>
#include <optional>
#include <string>

namespace sunder::test {

/// Whether node and these packages of tests/npm are installed.
bool has_node_packages(std::initializer_list<const char*> packages);

struct ProgramRun {
  bool succeeded = false;
  std::string output;  ///< Standard output and standard error.
};

/// Runs a program of tests/npm ("weld.mjs") by node; nothing if it could not be started.
/// @param arguments  as for the shell.
std::optional<ProgramRun> run_node_program(const std::string& program,
                                           const std::string& arguments);

}  // namespace sunder::test
