#include "tools/run_command.h"

#include <cstdlib>
#include <fcntl.h>
#include <fstream>
#include <sstream>
#include <sys/wait.h>
#include <unistd.h>

#include "support/machine/temporary_folder.h"

namespace sunder::test {

std::string read_text(const std::filesystem::path& file) {
  std::ostringstream text;
  text << std::ifstream(file, std::ios::binary).rdbuf();
  return text.str();
}

namespace {

void redirect(int descriptor, const std::filesystem::path& file) {
  const int target = open(file.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
  if (target >= 0) dup2(target, descriptor);
}

/// Everything that is written to a terminal until its last writer closes it.
std::string read_terminal(int terminal) {
  std::string text;
  char part[4096];
  for (ssize_t size = 0; (size = read(terminal, part, sizeof part)) > 0;)
    text.append(part, static_cast<std::size_t>(size));
  return text;
}

}  // namespace

CommandResult run_sunder_on_terminal(
    const std::vector<std::string>& arguments,
    const std::vector<std::pair<std::string, std::string>>& environment) {
  std::vector<char*> argv = {const_cast<char*>(SUNDER_COMMAND)};
  for (const std::string& argument : arguments) argv.push_back(const_cast<char*>(argument.c_str()));
  argv.push_back(nullptr);
  CommandResult result;
  const int terminal = posix_openpt(O_RDWR | O_NOCTTY);
  if (terminal < 0 || grantpt(terminal) != 0 || unlockpt(terminal) != 0) return result;
  const int slave = open(ptsname(terminal), O_RDWR | O_NOCTTY);
  const pid_t child = fork();
  if (child == 0) {
    dup2(slave, STDERR_FILENO);
    redirect(STDOUT_FILENO, "/dev/null");
    for (const auto& [name, value] : environment) setenv(name.c_str(), value.c_str(), 1);
    execv(SUNDER_COMMAND, argv.data());
    _exit(127);
  }
  close(slave);
  result.err = read_terminal(terminal);
  int state = 0;
  if (child > 0 && waitpid(child, &state, 0) == child && WIFEXITED(state))
    result.exit_code = WEXITSTATUS(state);
  close(terminal);
  return result;
}

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
