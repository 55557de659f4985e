#include "bench/harness/process_times.h"

#include <cstdio>
#include <cstdlib>
#include <fcntl.h>
#include <spawn.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "bench/harness/measure.h"

extern char** environ;

namespace sunder::bench {
namespace {

[[noreturn]] void give_up(const Command& command) {
  std::fprintf(stderr, "%s cannot be run\n", command.front().c_str());
  std::exit(1);
}

double seconds(const timeval& time) {
  return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
}

/// Its processor seconds.
double run(const Command& command) {
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
  rusage usage{};
  if (failure != 0 || wait4(child, &state, 0, &usage) != child || !WIFEXITED(state) ||
      WEXITSTATUS(state) == 127)
    give_up(command);
  return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

}  // namespace

std::vector<ProcessTimes> time_processes(const std::vector<Command>& commands, int rounds) {
  for (const Command& command : commands) run(command);
  std::vector<std::vector<double>> wall(commands.size()), cpu(commands.size());
  for (int round = 0; round < rounds; ++round)
    for (std::size_t i = 0; i < commands.size(); ++i)
      wall[i].push_back(seconds_of([&] { cpu[i].push_back(run(commands[i])); }));
  std::vector<ProcessTimes> times;
  for (std::size_t i = 0; i < commands.size(); ++i)
    times.push_back({median(wall[i]), median(cpu[i])});
  return times;
}

}  // namespace sunder::bench
