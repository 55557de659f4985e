#include "io/assimp/child_process.h"

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <fcntl.h>
#include <new>
#include <poll.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <thread>
#include <unistd.h>

// Sanitizers reserve terabytes of address space, so a limit on it would kill the child at once.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define SUNDER_UNDER_SANITIZER 1
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer) || \
    __has_feature(memory_sanitizer)
#define SUNDER_UNDER_SANITIZER 1
#endif
#endif

namespace sunder::assimp_import {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::uint32_t kMagic = 0x534E4452;  // "SNDR"
constexpr int kExitOutOfMemory = 61;
constexpr int kExitException = 62;
constexpr int kPipe = 3;  ///< The only descriptor that the child keeps in addition to 0, 1 and 2.

struct Header {
  std::uint32_t magic = kMagic;
  std::uint32_t reserved = 0;
  std::uint64_t head_bytes = 0;
  std::uint64_t body_bytes = 0;
};

bool in_child = false;

// ---- in the child

void set_limit(int resource, std::uint64_t value) {
  rlimit limit{};
  if (getrlimit(static_cast<decltype(RLIMIT_CPU)>(resource), &limit) != 0) return;
  const auto wanted = static_cast<rlim_t>(value);
  if (limit.rlim_max == RLIM_INFINITY || wanted < limit.rlim_max) limit.rlim_max = wanted;
  limit.rlim_cur = std::min(wanted, limit.rlim_max);
  setrlimit(static_cast<decltype(RLIMIT_CPU)>(resource), &limit);
}

/// Address space in use. The limit is added to it, because the fork shares the host's address
/// space.
[[maybe_unused]] std::uint64_t address_space_in_use() {
  unsigned long long pages = 0;
  if (std::FILE* statm = std::fopen("/proc/self/statm", "r")) {
    if (std::fscanf(statm, "%llu", &pages) != 1) pages = 0;
    std::fclose(statm);
  }
  return pages * static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE));
}

void set_limits(const ChildLimits& limits) {
  set_limit(RLIMIT_CORE, 0);
  set_limit(RLIMIT_FSIZE, 0);
  set_limit(RLIMIT_CPU, static_cast<std::uint64_t>(std::ceil(std::min(limits.seconds, 1e9))) + 1);
#if !defined(SUNDER_UNDER_SANITIZER)
  if (const std::uint64_t used = address_space_in_use(); used != 0)
    set_limit(RLIMIT_AS, used + limits.additional_memory);
#endif
}

/// The importer must not reach the host's files, sockets and crash handlers.
void leave_host(int pipe_end) {
  for (int signal = 1; signal < NSIG; ++signal) std::signal(signal, SIG_DFL);
  sigset_t none;
  sigemptyset(&none);
  sigprocmask(SIG_SETMASK, &none, nullptr);

  if (pipe_end != kPipe) dup2(pipe_end, kPipe);
  const int null = open("/dev/null", O_RDWR);
  for (int standard = 0; standard < 3; ++standard) dup2(null, standard);
#if defined(__linux__)
  if (close_range(kPipe + 1, ~0U, 0) == 0) return;
#endif
  const long last = sysconf(_SC_OPEN_MAX);
  for (int descriptor = kPipe + 1; descriptor < std::min(last < 0 ? 1024L : last, 65536L);
       ++descriptor)
    close(descriptor);
}

bool write_all(const void* data, std::size_t bytes) {
  const char* next = static_cast<const char*>(data);
  while (bytes > 0) {
    const ssize_t written = write(kPipe, next, std::min(bytes, std::size_t{1} << 20));
    if (written < 0) {
      if (errno == EINTR) continue;
      return false;
    }
    next += written;
    bytes -= static_cast<std::size_t>(written);
  }
  return true;
}

[[noreturn]] void run_child(const std::function<ChildReply()>& work, const ChildLimits& limits,
                            int pipe_end) {
  in_child = true;
  leave_host(pipe_end);
  std::set_terminate(std::abort);
  set_limits(limits);
  try {
    const ChildReply reply = work();
    const Header header{.head_bytes = reply.head.size(), .body_bytes = reply.body.size()};
    if (write_all(&header, sizeof header) && write_all(reply.head.data(), reply.head.size()))
      write_all(reply.body.data(), reply.body.size());
    _exit(0);  // Neither the host's nor assimp's destructors may run here.
  } catch (const std::bad_alloc&) {
    _exit(kExitOutOfMemory);
  } catch (...) {
    _exit(kExitException);
  }
}

// ---- in the parent

enum class Reading { complete, ended, timed_out, too_large };

/// Milliseconds until `deadline`, at least 0, for poll().
int remaining(Clock::time_point deadline) {
  const auto left =
      std::chrono::duration_cast<std::chrono::milliseconds>(deadline - Clock::now()).count();
  return static_cast<int>(std::clamp<std::int64_t>(left, 0, 1'000'000));
}

/// Reads at most `bytes` bytes. The target grows with the bytes that arrive, not by a declared
/// size.
template <class Container>
Reading read_some(int descriptor, std::uint64_t bytes, Clock::time_point deadline,
                  Container& target) {
  constexpr std::uint64_t kChunk = std::uint64_t{1} << 20;
  std::uint64_t have = 0;
  while (have < bytes) {
    pollfd waiting{descriptor, POLLIN, 0};
    const int ready = poll(&waiting, 1, remaining(deadline));
    if (ready < 0 && errno != EINTR) return Reading::ended;
    if (ready <= 0) {
      if (Clock::now() >= deadline) return Reading::timed_out;
      continue;
    }
    target.resize(have + std::min(kChunk, bytes - have));
    const ssize_t got = read(descriptor, target.data() + have, target.size() - have);
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) {
      target.resize(have);
      return Reading::ended;
    }
    have += static_cast<std::uint64_t>(got);
  }
  target.resize(have);
  return Reading::complete;
}

Reading read_reply(int descriptor, const ChildLimits& limits, Clock::time_point deadline,
                   ChildReply& reply) {
  std::string raw;
  if (const Reading header_reading = read_some(descriptor, sizeof(Header), deadline, raw);
      header_reading != Reading::complete)
    return header_reading;
  Header header;
  std::memcpy(&header, raw.data(), sizeof header);
  if (header.magic != kMagic) return Reading::ended;
  if (header.head_bytes > limits.maximum_reply ||
      header.body_bytes > limits.maximum_reply - header.head_bytes)
    return Reading::too_large;
  const Reading reading = read_some(descriptor, header.head_bytes, deadline, reply.head);
  return reading == Reading::complete
             ? read_some(descriptor, header.body_bytes, deadline, reply.body)
             : reading;
}

/// waitpid() until `deadline`, then SIGKILL.
/// @return the wait status, or -1 if the host ignores SIGCHLD and the status is lost.
int reap(pid_t child, Clock::time_point deadline) {
  for (bool killed = false;;) {
    int status = 0;
    const pid_t ended = waitpid(child, &status, killed ? 0 : WNOHANG);
    if (ended == child) return status;
    if (ended < 0 && errno != EINTR) return -1;
    if (!killed && Clock::now() >= deadline) {
      kill(child, SIGKILL);
      killed = true;
    } else if (ended == 0) {
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
  }
}

Status failure_of(Reading reading, int wait_status, const ChildLimits& limits,
                  const std::string& name) {
  const char* file = name.c_str();
  if (reading == Reading::timed_out)
    return Status::failure(StatusCode::limit_exceeded, kNone,
                           "%s: not imported within %g seconds (LoadOptions::import_seconds)", file,
                           limits.seconds);
  if (reading == Reading::too_large)
    return Status::failure(StatusCode::limit_exceeded, kNone,
                           "%s: more than %llu bytes after import (LoadOptions::maximum_bytes)",
                           file, static_cast<unsigned long long>(limits.maximum_reply));
  if (wait_status != -1 && WIFSIGNALED(wait_status)) {
    const int signal = WTERMSIG(wait_status);
    if (signal == SIGXCPU)
      return Status::failure(StatusCode::limit_exceeded, kNone,
                             "%s: not imported within %g seconds (LoadOptions::import_seconds)",
                             file, limits.seconds);
    if (signal == SIGKILL)
      return Status::failure(StatusCode::limit_exceeded, kNone,
                             "%s: the importer ran out of memory and was killed", file);
    return Status::failure(StatusCode::malformed_file, kNone,
                           "the importer crashed (signal %d) on %s", signal, file);
  }
  if (wait_status != -1 && WIFEXITED(wait_status) && WEXITSTATUS(wait_status) == kExitOutOfMemory)
    return Status::failure(StatusCode::limit_exceeded, kNone,
                           "%s: the importer ran out of its %llu MiB of memory", file,
                           static_cast<unsigned long long>(limits.additional_memory >> 20));
  return Status::failure(StatusCode::internal_error, kNone,
                         "%s: the importer ended without a result", file);
}

}  // namespace

bool is_import_child() { return in_child; }

Result<ChildReply> run_in_child(const std::function<ChildReply()>& work, const ChildLimits& limits,
                                const std::string& name) {
  const auto deadline =
      Clock::now() + std::chrono::duration_cast<Clock::duration>(
                         std::chrono::duration<double>(std::min(limits.seconds, 1e8)));
  int ends[2];
  if (pipe2(ends, O_CLOEXEC) != 0)
    return Status::failure(StatusCode::limit_exceeded, kNone,
                           "cannot create a pipe to the importer: %s", std::strerror(errno));
  const pid_t child = fork();
  if (child < 0) {
    const int error = errno;
    close(ends[0]);
    close(ends[1]);
    return Status::failure(StatusCode::limit_exceeded, kNone,
                           "cannot start a process for the importer: %s", std::strerror(error));
  }
  if (child == 0) run_child(work, limits, ends[1]);
  close(ends[1]);

  ChildReply reply;
  Reading reading = Reading::ended;
  bool out_of_memory = false;
  try {
    reading = read_reply(ends[0], limits, deadline, reply);
  } catch (const std::bad_alloc&) {
    out_of_memory = true;
  }
  const bool give_up =
      out_of_memory || reading == Reading::timed_out || reading == Reading::too_large;
  const int wait_status = reap(child, give_up ? Clock::now() : deadline);
  close(ends[0]);
  if (out_of_memory)
    return Status::failure(StatusCode::limit_exceeded, kNone,
                           "%s: out of memory while reading the imported model", name.c_str());
  if (reading != Reading::complete) return failure_of(reading, wait_status, limits, name);
  return reply;
}

}  // namespace sunder::assimp_import
