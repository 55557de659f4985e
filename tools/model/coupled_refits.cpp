#include "tools/model/coupled_refits.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <sys/stat.h>
#include <system_error>
#include <unistd.h>
#include <variant>
#include <vector>

#include "weights/internal/coupled_refit.h"

namespace sunder::tools {

namespace fs = std::filesystem;

namespace {

constexpr const char* kName = "sunder-coupled-refit";

bool asks_for_coupled_refit(const LoggedOperation& logged) {
  const auto* const operation = std::get_if<Operation>(&logged);
  const auto* const weights =
      operation == nullptr ? nullptr : std::get_if<WeightsOperation>(operation);
  return weights != nullptr && weights->weights.policy == WeightPolicy::refit &&
         weights->refit.is_coupled;
}

/// Whether every user can change it.
bool is_writable_by_all(const fs::path& file) {
  struct stat about = {};
  return stat(file.c_str(), &about) != 0 || (about.st_mode & S_IWOTH) != 0;
}

/// Only in places that belong to this program's installation, or to its build: neither the current
/// folder nor PATH is searched.
Result<fs::path> find_program() {
  std::error_code error;
  const fs::path own = fs::canonical("/proc/self/exe", error).parent_path();
  for (const char* const place : {SUNDER_LIBEXEC_FROM_BIN, "."}) {
    const fs::path folder = fs::canonical(own / place, error);
    const fs::path program = folder / kName;
    if (error || !fs::exists(program, error)) continue;
    if (is_writable_by_all(folder) || is_writable_by_all(program))
      return Status::failure(StatusCode::file_unreadable, kNone,
                             "'%.160s' is not run: every user can change it", program.c_str());
    return program;
  }
  return Status::failure(
      StatusCode::unsupported_feature, kNone,
      "neighbours are fitted together (\"coupled\") by the program '%s', which is not installed "
      "beside this one (CMake option SUNDER_CERES)",
      kName);
}

std::vector<std::string> own_arguments() {
  std::ifstream file("/proc/self/cmdline", std::ios::binary);
  std::vector<std::string> arguments;
  for (std::string argument; std::getline(file, argument, '\0');) arguments.push_back(argument);
  return arguments;
}

}  // namespace

Status provide_coupled_refits(std::span<const LoggedOperation> log) {
  if (has_coupled_refit() || std::none_of(log.begin(), log.end(), asks_for_coupled_refit))
    return {};
  const Result<fs::path> program = find_program();
  if (!program) return program.error();
  std::vector<std::string> arguments = own_arguments();
  std::vector<char*> pointers;
  std::transform(arguments.begin(), arguments.end(), std::back_inserter(pointers),
                 [](std::string& argument) { return argument.data(); });
  pointers.push_back(nullptr);
  execv(program->c_str(), pointers.data());
  return Status::failure(StatusCode::file_unreadable, kNone, "cannot start '%.160s': %s",
                         program->c_str(), std::strerror(errno));
}

}  // namespace sunder::tools
