#include "bench/process_times.h"

#include <cstdio>
#include <cstdlib>
#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include "bench/in_turns.h"

extern char** environ;

namespace sunder::bench {
namespace {

[[noreturn]] void give_up(const Command& command) {
  std::fprintf(stderr, "%s cannot be run\n", command.front().c_str());
  std::exit(1);
}

void run(const Command& command) {
  std::vector<char*> arguments;
  for (const std::string& argument : command)
    arguments.push_back(const_cast<char*>(argument.c_str()));
  arguments.push_back(nullptr);
  posix_spawn_file_actions_t files;
  posix_spawn_file_actions_init(&files);
  posix_spawn_file_actions_addopen(&files, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
  posix_spawn_file_actions_addopen(&files, STDERR_FILENO, "/dev/null", O_WRONLY, 0);
  pid_t child = 0;
  const int failure = posix_spawn(&child, arguments[0], &files, nullptr, arguments.data(), environ);
  posix_spawn_file_actions_destroy(&files);
  int state = 0;
  if (failure != 0 || waitpid(child, &state, 0) != child || !WIFEXITED(state) ||
      WEXITSTATUS(state) == 127)
    give_up(command);
}

}  // namespace

std::vector<double> time_processes(const std::vector<Command>& commands, int rounds) {
  std::vector<Candidate> candidates;
  for (const Command& command : commands)
    candidates.push_back(
        {[&command] { return seconds_of([&command] { run(command); }); }, {1, 0, 1}, rounds, 0});
  for (const Command& command : commands) run(command);
  measure_in_turns(candidates);
  std::vector<double> seconds;
  for (const Candidate& candidate : candidates) seconds.push_back(median(candidate.seconds));
  return seconds;
}

}  // namespace sunder::bench
