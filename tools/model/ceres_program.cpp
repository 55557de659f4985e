#include "tools/model/ceres_program.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <system_error>
#include <unistd.h>
#include <vector>

#include "io/internal/own_program.h"

namespace sunder::tools {

namespace fs = std::filesystem;

namespace {

constexpr const char* kName = "sunder-coupled-refit";

/// Only in places that belong to this program's installation, or to its build: neither the current
/// folder nor PATH is searched, also if the place of this program is not known: without /proc, or
/// after it was deleted.
Result<OwnProgram> find_program(const char* work) {
  std::error_code error;
  const fs::path own = fs::canonical("/proc/self/exe", error);
  if (!error)
    for (const char* const place : {SUNDER_LIBEXEC_FROM_BIN, "."}) {
      Result<OwnProgram> program = open_own_program(own.parent_path() / place / kName);
      if (program || program.error().code() != StatusCode::file_not_found) return program;
    }
  return Status::failure(StatusCode::unsupported_feature, kNone,
                         "%s by the program '%s', which is not installed beside this one (CMake "
                         "option SUNDER_CERES)",
                         work, kName);
}

std::vector<std::string> own_arguments() {
  std::ifstream file("/proc/self/cmdline", std::ios::binary);
  std::vector<std::string> arguments;
  for (std::string argument; std::getline(file, argument, '\0');) arguments.push_back(argument);
  return arguments;
}

}  // namespace

Status become_ceres_program(const char* work) {
  const Result<OwnProgram> program = find_program(work);
  if (!program) return program.error();
  std::vector<std::string> arguments = own_arguments();
  std::vector<char*> pointers;
  std::transform(arguments.begin(), arguments.end(), std::back_inserter(pointers),
                 [](std::string& argument) { return argument.data(); });
  pointers.push_back(nullptr);
  // The file that was checked; kept open, so that scripts can be read.
  fexecve(fcntl(program->descriptor.value(), F_DUPFD, 0), pointers.data(), environ);
  return Status::failure(StatusCode::file_unreadable, kNone, "cannot start '%.160s': %s",
                         program->path.c_str(), std::strerror(errno));
}

}  // namespace sunder::tools
