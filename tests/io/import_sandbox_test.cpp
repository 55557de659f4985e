// The limits of the helper process, in forks of this program that enter them and try what a file
// that has taken over its importer could try.

#include <cerrno>
#include <csignal>
#include <fcntl.h>
#include <fstream>
#include <functional>
#include <new>
#include <spawn.h>
#include <string>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <gtest/gtest.h>

#include "io/import_helper/sandbox.h"
#include "io/import_messages/messages.h"

namespace sunder {
namespace {

using import_helper::drop_privileges;
using import_helper::filter_system_calls;
using import_helper::hide_files;
using import_helper::set_limits;

constexpr int kAllowed = 10, kRefused = 11, kNoFilter = 12;

/// Runs `attempt` in a sandbox. @return its exit code, or minus the signal that ended it.
int outcome(const std::function<bool()>& attempt, bool with_filter = true) {
  const pid_t child = fork();
  if (child == 0) {
    set_limits({.memory = 256u << 20, .largest_memory = 256u << 20, .cpu_seconds = 5});
    if (with_filter && filter_system_calls()[0] != '\0') _exit(kNoFilter);
    _exit(attempt() ? kAllowed : kRefused);
  }
  int status = 0;
  waitpid(child, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
}

bool has_filter() {
  return outcome([] { return true; }) == kAllowed;
}

TEST(ImportSandbox, OpensNoFile) {
  if (!has_filter()) GTEST_SKIP() << "there is no filter of system calls here";
  EXPECT_EQ(outcome([] { return open("/etc/passwd", O_RDONLY) >= 0; }), kRefused);
  EXPECT_EQ(outcome([] { return open("/tmp/sunder_sandbox", O_WRONLY | O_CREAT, 0600) >= 0; }),
            kRefused);
  EXPECT_EQ(outcome([] { return unlink("/tmp/sunder_sandbox") == 0 || errno != EPERM; }), kRefused);
  EXPECT_EQ(outcome([] { return chdir("/") == 0; }), kRefused);
}

TEST(ImportSandbox, StartsNothing) {
  if (!has_filter()) GTEST_SKIP() << "there is no filter of system calls here";
  EXPECT_EQ(outcome([] { return fork() >= 0; }), -SIGSYS);
  EXPECT_EQ(outcome([] { return execl("/bin/true", "true", nullptr) == 0; }), -SIGSYS);
  EXPECT_EQ(outcome([] { return socket(AF_INET, SOCK_STREAM, 0) >= 0; }), -SIGSYS);
  EXPECT_EQ(outcome([] { return syscall(SYS_ptrace, 0, 0, 0, 0) == 0; }), -SIGSYS);
}

TEST(ImportSandbox, ReachesNoOtherProcess) {
  if (!has_filter()) GTEST_SKIP() << "there is no filter of system calls here";
  EXPECT_EQ(outcome([] { return kill(getppid(), 0) == 0; }), kRefused);
  EXPECT_EQ(outcome([] { return kill(getpid(), 0) == 0; }), kRefused);
  const pid_t other = getpid();
  EXPECT_EQ(outcome([other] { return syscall(SYS_tgkill, other, other, 0) == 0; }), kRefused);
}

TEST(ImportSandbox, CannotRaiseItsLimitsOrRunNewCode) {
  if (!has_filter()) GTEST_SKIP() << "there is no filter of system calls here";
  EXPECT_EQ(outcome([] {
              const rlimit limit{1 << 30, 1 << 30};
              return setrlimit(RLIMIT_AS, &limit) == 0;
            }),
            kRefused);
  EXPECT_EQ(outcome([] {
              return mmap(nullptr, 4096, PROT_READ | PROT_EXEC, MAP_PRIVATE | MAP_ANONYMOUS, -1,
                          0) != MAP_FAILED;
            }),
            kRefused);
  EXPECT_EQ(outcome([] { return send(import_messages::kSocket + 1, "", 1, 0) > 0; }), kRefused);
}

TEST(ImportSandbox, AllowsWhatAnImportNeeds) {
  if (!has_filter()) GTEST_SKIP() << "there is no filter of system calls here";
  EXPECT_EQ(outcome([] { return std::malloc(100u << 20) != nullptr; }), kAllowed);
  EXPECT_EQ(outcome([]() -> bool { std::abort(); }), -SIGABRT);
  EXPECT_EQ(outcome([] {
              try {
                throw 1;
              } catch (int) {
                return true;
              }
            }),
            kAllowed);
}

TEST(ImportSandbox, HasLimitsWithoutAFilterToo) {
  EXPECT_EQ(outcome(
                [] {
                  rlimit core{}, size{}, cpu{}, open{};
                  getrlimit(RLIMIT_CORE, &core);
                  getrlimit(RLIMIT_FSIZE, &size);
                  getrlimit(RLIMIT_CPU, &cpu);
                  getrlimit(RLIMIT_NOFILE, &open);
                  return core.rlim_max == 0 && size.rlim_max == 0 && cpu.rlim_cur == 5 &&
                         open.rlim_max <= 64;
                },
                false),
            kAllowed);
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
  EXPECT_EQ(outcome([] { return std::malloc(512u << 20) != nullptr; }, false), kRefused);
#endif
}

/// A capability in one of the lines of /proc/self/status: "CapEff", "CapPrm", "CapAmb".
bool has_capabilities() {
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);)
    for (const char* const set : {"CapInh:", "CapPrm:", "CapEff:", "CapAmb:"})
      if (line.starts_with(set) && line.find_first_of("123456789abcdef", 7) != std::string::npos)
        return true;
  return false;
}

TEST(ImportSandbox, HasNoPrivileges) {
  EXPECT_EQ(outcome(
                [] {
                  drop_privileges();
                  return !has_capabilities() && setresuid(0, 0, 0) != 0 && geteuid() != 0;
                },
                false),
            kAllowed);
  EXPECT_EQ(outcome(
                [] {
                  drop_privileges();
                  return prctl(PR_GET_NO_NEW_PRIVS, 0, 0, 0, 0) == 1 &&
                         prctl(PR_GET_DUMPABLE, 0, 0, 0, 0) == 0;
                },
                false),
            kAllowed);
  if (geteuid() != 0) return;
  EXPECT_EQ(outcome(
                [] {
                  drop_privileges();
                  return getgroups(0, nullptr) == 0;
                },
                false),
            kAllowed);
}

TEST(ImportSandbox, StartsNoProcessWithoutAFilter) {
  EXPECT_EQ(outcome(
                [] {
                  drop_privileges();
                  const pid_t child = fork();
                  if (child == 0) _exit(0);
                  return child >= 0;
                },
                false),
            kRefused);
}

TEST(ImportSandbox, LandlockHidesFilesWithoutAFilter) {
  const auto has_landlock = [] { return hide_files(); };
  if (outcome(has_landlock, false) != kAllowed) GTEST_SKIP() << "there is no Landlock here";
  EXPECT_EQ(outcome([] { return hide_files() && open("/etc/passwd", O_RDONLY) >= 0; }, false),
            kRefused);
  EXPECT_EQ(
      outcome([] { return hide_files() && open("/tmp", O_RDONLY | O_DIRECTORY) >= 0; }, false),
      kRefused);
  EXPECT_EQ(outcome([] { return hide_files() && unlink("/tmp/sunder_sandbox") == 0; }, false),
            kRefused);
  // What is open stays readable.
  EXPECT_EQ(outcome(
                [] {
                  const int file = open("/etc/passwd", O_RDONLY);
                  char one = 0;
                  return hide_files() && read(file, &one, 1) == 1;
                },
                false),
            kAllowed);
}

}  // namespace
}  // namespace sunder
