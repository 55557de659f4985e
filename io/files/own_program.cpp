#include "io/internal/own_program.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <system_error>
#include <unistd.h>
#include <utility>

namespace sunder {

namespace fs = std::filesystem;

namespace {

/// A new process gets its streams and its socket below this one.
constexpr int kLeastDescriptor = 10;

/// Whether nobody but root and the effective user can change it.
bool is_ours(const struct stat& about) {
  const uid_t user = geteuid();
  if (about.st_uid != 0 && about.st_uid != user) return false;
  if ((about.st_mode & S_IWOTH) != 0) return false;
  const bool is_private_group = user != 0 && about.st_uid == user && about.st_gid == user;
  return (about.st_mode & S_IWGRP) == 0 || is_private_group;
}

Status unusable(const fs::path& file, const char* why) {
  return Status::failure(StatusCode::file_unreadable, kNone, "the helper executable '%.140s' %s",
                         file.c_str(), why);
}

}  // namespace

Result<OwnProgram> open_own_program(const fs::path& file) {
  std::error_code error;
  const fs::path whole = fs::canonical(file, error);
  if (error)
    return Status::failure(StatusCode::file_not_found, kNone, "no file '%.200s'", file.c_str());
  const files::Descriptor folder(
      ::open(whole.parent_path().c_str(), O_PATH | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC));
  const files::Descriptor opened(
      openat(folder.value(), whole.filename().c_str(), O_PATH | O_NOFOLLOW | O_CLOEXEC));
  struct stat of_file = {}, of_folder = {};
  if (!opened.is_open() || fstat(folder.value(), &of_folder) != 0 ||
      fstat(opened.value(), &of_file) != 0)
    return unusable(file, "cannot be opened");
  if (!S_ISREG(of_file.st_mode) ||
      faccessat(folder.value(), whole.filename().c_str(), X_OK, AT_EACCESS) != 0)
    return unusable(file, "is not an executable file");
  if (!is_ours(of_file))
    return unusable(file, "is refused: another user owns it or can write to it");
  if (!is_ours(of_folder))
    return unusable(file, "is refused: another user owns its folder or can write to it");
  files::Descriptor above(fcntl(opened.value(), F_DUPFD_CLOEXEC, kLeastDescriptor));
  if (!above.is_open())
    return Status::failure(StatusCode::limit_exceeded, kNone, "too many open files");
  return OwnProgram{file, std::move(above)};
}

}  // namespace sunder
