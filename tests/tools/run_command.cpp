#include "tools/run_command.h"

#include <cstdlib>
#include <fcntl.h>
#include <fstream>
#include <sstream>
#include <sys/wait.h>
#include <unistd.h>

#include "support/temporary_folder.h"

namespace sunder::test {
namespace {

std::string read_text(const std::filesystem::path& file) {
  std::ostringstream text;
  text << std::ifstream(file, std::ios::binary).rdbuf();
  return text.str();
}

void redirect(int descriptor, const std::filesystem::path& file) {
  const int target = open(file.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
  if (target >= 0) dup2(target, descriptor);
}

}  // namespace

CommandResult run_sunder(const std::vector<std::string>& arguments,
                         const std::vector<std::pair<std::string, std::string>>& environment) {
  return run_program(SUNDER_COMMAND, arguments, environment);
}

CommandResult run_sunder_without_page(const std::vector<std::string>& arguments) {
  return run_program(SUNDER_COMMAND_WITHOUT_PAGE, arguments);
}

CommandResult run_program(const char* program, const std::vector<std::string>& arguments,
                          const std::vector<std::pair<std::string, std::string>>& environment) {
  const TemporaryFolder folder;
  const auto out = folder.path() / "out", err = folder.path() / "err";
  std::vector<char*> argv = {const_cast<char*>(program)};
  for (const std::string& argument : arguments) argv.push_back(const_cast<char*>(argument.c_str()));
  argv.push_back(nullptr);

  const pid_t child = fork();
  if (child == 0) {
    redirect(STDOUT_FILENO, out);
    redirect(STDERR_FILENO, err);
    for (const auto& [name, value] : environment) setenv(name.c_str(), value.c_str(), 1);
    execv(program, argv.data());
    _exit(127);
  }
  int state = 0;
  CommandResult result;
  if (child < 0 || waitpid(child, &state, 0) != child) return result;
  if (WIFEXITED(state)) result.exit_code = WEXITSTATUS(state);
  result.out = read_text(out);
  result.err = read_text(err);
  return result;
}

}  // namespace sunder::test
