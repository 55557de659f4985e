#include "io/contained_import/helper_process.h"

#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <fcntl.h>
#include <poll.h>
#include <spawn.h>
#include <string>
#include <sys/socket.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <thread>
#include <unistd.h>
#include <utility>

#include "io/import_messages/messages.h"

namespace sunder::contained_import {

using import_messages::Clock;
using import_messages::Socket;

namespace {

/// The descriptor of the program in the new process, which closes it.
constexpr int kProgram = import_messages::kSocket + 1;

/// The actions of posix_spawn() in the new process before it executes the helper.
class SpawnPlan {
 public:
  SpawnPlan(int socket, int program) : program_("/proc/self/fd/" + std::to_string(kProgram)) {
    posix_spawn_file_actions_init(&actions_);
    posix_spawnattr_init(&attributes_);
    // The socket comes first: it may be 0, 1 or 2 if the program has closed these.
    posix_spawn_file_actions_adddup2(&actions_, socket, import_messages::kSocket);
    posix_spawn_file_actions_addopen(&actions_, 0, "/dev/null", O_RDWR, 0);
    posix_spawn_file_actions_adddup2(&actions_, 0, 1);
    posix_spawn_file_actions_adddup2(&actions_, 0, 2);
    // Without close-on-exec, so that scripts and emulators of other processors can read it.
    posix_spawn_file_actions_adddup2(&actions_, program, kProgram);

    sigset_t signals;
    sigfillset(&signals);
    posix_spawnattr_setsigdefault(&attributes_, &signals);
    sigemptyset(&signals);
    posix_spawnattr_setsigmask(&attributes_, &signals);
    short flags = POSIX_SPAWN_SETSIGDEF | POSIX_SPAWN_SETSIGMASK;
#if defined(POSIX_SPAWN_SETSID)
    flags |= POSIX_SPAWN_SETSID;  // Ctrl-C is for the program, which decides about its imports.
#endif
    posix_spawnattr_setflags(&attributes_, flags);
  }
  ~SpawnPlan() {
    posix_spawn_file_actions_destroy(&actions_);
    posix_spawnattr_destroy(&attributes_);
  }
  SpawnPlan(const SpawnPlan&) = delete;
  SpawnPlan& operator=(const SpawnPlan&) = delete;

  /// @param name  that the program is told.
  [[nodiscard]] int spawn(std::string name, pid_t& id) const {
    char* arguments[] = {name.data(), nullptr};
    // Large pages, and memory that is kept for later arrays: a third of the page faults.
    std::string memory =
        "GLIBC_TUNABLES=glibc.malloc.hugetlb=1:glibc.malloc.top_pad=16777216:"
        "glibc.malloc.mmap_threshold=33554432:glibc.malloc.trim_threshold=1073741824";
    std::string libraries;
    char* environment[] = {memory.data(), nullptr, nullptr};
    if (const char* const path = std::getenv("LD_LIBRARY_PATH")) {
      libraries = std::string("LD_LIBRARY_PATH=") + path;
      environment[1] = libraries.data();
    }
    return posix_spawn(&id, program_.c_str(), &actions_, &attributes_, arguments, environment);
  }

 private:
  posix_spawn_file_actions_t actions_;
  posix_spawnattr_t attributes_;
  std::string program_;  ///< Not the path of the helper, which may lead elsewhere by now.
};

/// Refers to the process for good, even after its number is used again. The number itself may be
/// that of another process already, where the program ignores SIGCHLD or waits for all its
/// children: but not if the other end of the socket, which only this process has, is still open
/// afterwards.
files::Descriptor descriptor_of_process([[maybe_unused]] pid_t id, [[maybe_unused]] int socket) {
#if defined(SYS_pidfd_open)
  files::Descriptor process(static_cast<int>(syscall(SYS_pidfd_open, id, 0)));
  pollfd end{socket, 0, 0};
  const bool has_ended = poll(&end, 1, 0) != 0;
  return has_ended ? files::Descriptor() : std::move(process);
#else
  return {};
#endif
}

}  // namespace

Result<HelperProcess> HelperProcess::start(const OwnProgram& helper, Clock::time_point deadline) {
  int ends[2];
  if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends) != 0)
    return Status::failure(StatusCode::limit_exceeded, kNone,
                           "cannot create a socket to the importer: %s", std::strerror(errno));
  files::Descriptor own(ends[0]), other(ends[1]);
  if (own.value() < 3) {  // where the program may write later
    own = files::Descriptor(fcntl(own.value(), F_DUPFD_CLOEXEC, 3));
    if (!own.is_open())
      return Status::failure(StatusCode::limit_exceeded, kNone, "too many open files");
  }
  pid_t id = -1;
  if (const int error =
          SpawnPlan(other.value(), helper.descriptor.value()).spawn(helper.path.string(), id);
      error != 0)
    return Status::failure(error == EAGAIN || error == ENOMEM ? StatusCode::limit_exceeded
                                                              : StatusCode::file_unreadable,
                           kNone, "cannot start the importer '%.120s': %s", helper.path.c_str(),
                           std::strerror(error));
  other.reset();
  return HelperProcess(id, Socket(std::move(own), deadline));
}

HelperProcess::HelperProcess(pid_t id, Socket socket)
    : id_(id), process_(descriptor_of_process(id, socket.value())), socket_(std::move(socket)) {}

HelperProcess::HelperProcess(HelperProcess&& other) noexcept
    : id_(std::exchange(other.id_, -1)),
      process_(std::move(other.process_)),
      socket_(std::move(other.socket_)) {}

HelperProcess::~HelperProcess() {
  if (id_ >= 0) finish(Clock::time_point::min());
}

void HelperProcess::kill_now() const {
#if defined(SYS_pidfd_send_signal)
  if (process_.is_open()) {
    (void)syscall(SYS_pidfd_send_signal, process_.value(), SIGKILL, nullptr, 0);
    return;
  }
#endif
  // A child that was not waited for keeps its number. One that somebody else has reaped does not,
  // and must not be killed by it.
  siginfo_t about{};
  if (waitid(P_PID, static_cast<id_t>(id_), &about, WEXITED | WNOHANG | WNOWAIT) == 0)
    kill(id_, SIGKILL);
}

int HelperProcess::finish(Clock::time_point deadline) {
  bool is_killed = false;
  for (;;) {
    int status = 0;
    const pid_t ended = waitpid(id_, &status, is_killed ? 0 : WNOHANG);
    if (ended == id_ || (ended < 0 && errno != EINTR)) {
      id_ = -1;
      return ended < 0 ? -1 : status;
    }
    if (is_killed || ended < 0) continue;
    if (Clock::now() >= deadline) {
      kill_now();
      is_killed = true;
    } else if (process_.is_open()) {
      pollfd waiting{process_.value(), POLLIN, 0};
      poll(&waiting, 1, import_messages::milliseconds_until(deadline) + 1);
    } else {
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
  }
}

}  // namespace sunder::contained_import
