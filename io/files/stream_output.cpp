#include "io/files/stream_output.h"

#include <cerrno>
#include <charconv>
#include <csignal>
#include <ctime>
#include <fcntl.h>
#include <poll.h>
#include <string>
#include <sys/stat.h>
#include <system_error>
#include <unistd.h>

namespace sunder::files {

namespace fs = std::filesystem;

namespace {

/// Keeps from this thread the signals of a reader that has gone (SIGPIPE) and of a limit of the
/// size of files (SIGXFSZ), and takes those that a write has caused.
class WithoutWriteSignals {
 public:
  WithoutWriteSignals() {
    sigset_t pending;
    sigpending(&pending);
    sigemptyset(&caused_);
    sigset_t blocked;
    sigemptyset(&blocked);
    for (const int signal : {SIGPIPE, SIGXFSZ}) {
      sigaddset(&blocked, signal);
      if (sigismember(&pending, signal) == 0) sigaddset(&caused_, signal);
    }
    pthread_sigmask(SIG_BLOCK, &blocked, &before_);
  }
  ~WithoutWriteSignals() {
    const int error = errno;
    const timespec at_once = {};
    while (sigtimedwait(&caused_, nullptr, &at_once) > 0 || errno == EINTR) {
    }
    pthread_sigmask(SIG_SETMASK, &before_, nullptr);
    errno = error;
  }
  WithoutWriteSignals(const WithoutWriteSignals&) = delete;
  WithoutWriteSignals& operator=(const WithoutWriteSignals&) = delete;

 private:
  sigset_t caused_, before_;
};

}  // namespace

bool is_of_system(const fs::path& folder) {
  std::error_code error;
  const fs::path whole = fs::canonical(folder, error);
  const std::string name = whole.string() + '/';
  return !error && ((name.starts_with("/dev/") && !name.starts_with("/dev/shm/")) ||
                    name.starts_with("/proc/"));
}

std::optional<int> own_descriptor(const fs::path& file) {
  std::error_code error;
  fs::path link = file;
  if (fs::canonical(file.parent_path(), error) == "/dev" && fs::is_symlink(file, error))
    link = file.parent_path() / fs::read_symlink(file, error);  // /dev/stdout -> /proc/self/fd/1
  const fs::path folder = fs::canonical(link.parent_path(), error);
  if (error || folder != "/proc/" + std::to_string(getpid()) + "/fd") return {};
  const std::string name = link.filename().string();
  int number = -1;
  const auto [end, fault] = std::from_chars(name.data(), name.data() + name.size(), number);
  if (fault != std::errc() || end != name.data() + name.size()) return {};
  return number;
}

Descriptor open_stream(int folder, const char* name) {
  Descriptor opened(
      openat(folder, name, O_WRONLY | O_APPEND | O_NOFOLLOW | O_NONBLOCK | O_NOCTTY | O_CLOEXEC));
  struct stat about = {};
  if (!opened.is_open() || fstat(opened.value(), &about) != 0) return {};
  if (S_ISCHR(about.st_mode) || S_ISFIFO(about.st_mode)) return opened;
  errno = EINVAL;  // It has been exchanged.
  return {};
}

bool write_all(int descriptor, std::span<const std::byte> bytes) {
  const WithoutWriteSignals guard;
  while (!bytes.empty()) {
    const ssize_t written = write(descriptor, bytes.data(), bytes.size());
    if (written >= 0) {
      bytes = bytes.subspan(static_cast<std::size_t>(written));
    } else if (errno == EAGAIN || errno == EWOULDBLOCK) {
      pollfd ready{descriptor, POLLOUT, 0};
      poll(&ready, 1, -1);
    } else if (errno != EINTR) {
      return false;
    }
  }
  return true;
}

}  // namespace sunder::files
