#include "io/internal/staged_file.h"

#include <array>
#include <cerrno>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include "io/files/stream_output.h"

namespace sunder {
namespace {

using files::Descriptor;

/// A name that nobody can guess, so that nothing can be put there beforehand. It does not depend on
/// that of the file, which may be as long as the system allows.
std::string random_name() {
  std::array<unsigned char, 12> random{};
  if (getentropy(random.data(), random.size()) != 0) return {};
  std::string name = ".sunder-";
  for (const unsigned char byte : random) {
    name += "0123456789abcdef"[byte >> 4];
    name += "0123456789abcdef"[byte & 15];
  }
  return name;
}

/// Gives the new file what it can keep of the one that it replaces.
bool keep_owner_and_mode(int descriptor, const struct stat& earlier) {
  mode_t mode = earlier.st_mode & 0777;
  // Without the group, its rights would be those of another one.
  if (fchown(descriptor, earlier.st_uid, earlier.st_gid) != 0 &&
      fchown(descriptor, static_cast<uid_t>(-1), earlier.st_gid) != 0)
    mode &= ~static_cast<mode_t>(S_IRWXG);
  return fchmod(descriptor, mode) == 0;
}

enum class Output { new_file, stream, refused };

/// What is done with what stands under the name of an output.
/// @param about  gets what stands there; of mode 0 if nothing does.
Output output_at(int folder, const std::filesystem::path& file, struct stat& about) {
  about = {};
  if (fstatat(folder, file.filename().c_str(), &about, AT_SYMLINK_NOFOLLOW) != 0)
    return errno == ENOENT ? Output::new_file : Output::refused;
  switch (about.st_mode & S_IFMT) {
    case S_IFREG: return Output::new_file;
    case S_IFLNK:
      errno = ELOOP;
      return files::is_of_system(file.parent_path()) ? Output::refused : Output::new_file;
    case S_IFCHR:
    case S_IFIFO: return Output::stream;
    case S_IFDIR: errno = EISDIR; return Output::refused;
    default: errno = EINVAL; return Output::refused;
  }
}

}  // namespace

StagedFile::StagedFile(const std::filesystem::path& file, std::span<const std::byte> bytes)
    : file_(file) {
  if (!file_.has_parent_path()) file_ = "." / file_;
  if (files::own_descriptor(file_)) {
    direct_.assign(bytes.begin(), bytes.end());
    return;
  }
  folder_ = open(file_.parent_path().c_str(), O_PATH | O_DIRECTORY | O_CLOEXEC);
  if (folder_ < 0 || !file_.has_filename()) {
    status_ = failure(std::strerror(folder_ < 0 ? errno : EISDIR));
    return;
  }
  create(bytes);
}

StagedFile::~StagedFile() {
  if (!staged_.empty()) unlinkat(folder_, staged_.c_str(), 0);
  if (folder_ >= 0) close(folder_);
}

Status StagedFile::failure(const char* why) const {
  return Status::failure(StatusCode::file_unreadable, kNone, "cannot write '%.120s': %s",
                         file_.filename().c_str(), why);
}

void StagedFile::create(std::span<const std::byte> bytes) {
  struct stat earlier = {};
  const Output output = output_at(folder_, file_, earlier);
  if (output == Output::refused) {
    status_ = failure(std::strerror(errno));
    return;
  }
  if (output == Output::stream) {
    direct_.assign(bytes.begin(), bytes.end());
    return;
  }
  const bool replaces = S_ISREG(earlier.st_mode);
  Descriptor created;
  for (int attempt = 0; attempt < 3 && !created.is_open(); ++attempt) {
    staged_ = random_name();
    created = Descriptor(openat(folder_, staged_.c_str(),
                                O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC,
                                replaces ? 0600 : 0666));
    if (!created.is_open() && errno != EEXIST) break;
  }
  if (!created.is_open()) {
    status_ = failure(std::strerror(errno));
    staged_.clear();
    return;
  }
  if (!files::write_all(created.value(), bytes) ||
      (replaces && !keep_owner_and_mode(created.value(), earlier)) || !created.close_now())
    status_ = failure(std::strerror(errno));
}

Status StagedFile::commit() {
  if (!status_) return status_;
  if (const std::optional<int> own = files::own_descriptor(file_)) {
    std::fflush(stdout);  // What was printed before comes first.
    return files::write_all(*own, direct_) ? Status() : failure(std::strerror(errno));
  }
  struct stat now = {};
  const Output output = output_at(folder_, file_, now);
  const std::string name = file_.filename().string();
  if (output == Output::refused) return failure(std::strerror(errno));
  if ((output == Output::stream) != staged_.empty()) return failure("it has been exchanged");
  if (output == Output::stream) {
    const Descriptor stream = files::open_stream(folder_, name.c_str());
    if (!stream.is_open())
      return failure(errno == ENXIO ? "nobody reads this FIFO" : std::strerror(errno));
    return files::write_all(stream.value(), direct_) ? Status() : failure(std::strerror(errno));
  }
  if (renameat(folder_, staged_.c_str(), folder_, name.c_str()) != 0)
    return failure(std::strerror(errno));
  staged_.clear();
  return {};
}

Status write_file(const std::filesystem::path& file, std::span<const std::byte> bytes) {
  return StagedFile(file, bytes).commit();
}

}  // namespace sunder
