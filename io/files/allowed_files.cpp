#include "io/files/allowed_files.h"

#include <algorithm>
#include <cerrno>
#include <fcntl.h>
#include <string>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <system_error>

#if defined(__linux__) && defined(SYS_openat2) && defined(__has_include)
#if __has_include(<linux/openat2.h>)
#define SUNDER_HAS_OPENAT2 1
#endif
#endif

namespace sunder::files {

namespace fs = std::filesystem;

namespace {

constexpr int kForReading = O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOCTTY;

/// A program that has closed its standard input or output may write to descriptor 0, 1 or 2 later.
Descriptor above_standard(Descriptor descriptor) {
  if (descriptor.value() < 0 || descriptor.value() > 2) return descriptor;
  return Descriptor(fcntl(descriptor.value(), F_DUPFD_CLOEXEC, 3));
}

const char* kind_of(mode_t mode) {
  if (S_ISDIR(mode)) return "a folder";
  if (S_ISCHR(mode) || S_ISBLK(mode)) return "a device";
  return S_ISFIFO(mode) ? "a pipe" : "a socket";
}

/// Checks what was opened, rather than what the path leads to by now.
Result<OpenFile> checked(Descriptor descriptor, const fs::path& file, bool takes_pipes = false) {
  if (!descriptor.is_open())
    return errno == ENOENT || errno == ENOTDIR
               ? Status::failure(StatusCode::file_not_found, kNone, "no file '%s'",
                                 file.filename().c_str())
               : Status::failure(StatusCode::file_unreadable, kNone, "cannot read '%s'",
                                 file.filename().c_str());
  struct stat about = {};
  if (fstat(descriptor.value(), &about) != 0)
    return Status::failure(StatusCode::file_unreadable, kNone, "cannot read '%s'",
                           file.filename().c_str());
  const bool is_pipe = S_ISFIFO(about.st_mode);
  if (!S_ISREG(about.st_mode) && !(is_pipe && takes_pipes))
    return Status::failure(StatusCode::file_unreadable, kNone,
                           "'%s' is %s; expected a regular file%s", file.filename().c_str(),
                           kind_of(about.st_mode), takes_pipes ? " or a pipe" : "");
  OpenFile opened{above_standard(std::move(descriptor)), static_cast<std::uint64_t>(about.st_size),
                  is_pipe};
  if (!opened.descriptor.is_open())
    return Status::failure(StatusCode::limit_exceeded, kNone, "too many open files");
  return opened;
}

/// Opens a canonical path; fails if a part of it has become a link since it was resolved.
Descriptor open_canonical(const fs::path& file) {
#if defined(SUNDER_HAS_OPENAT2)
  struct {
    std::uint64_t flags, mode, resolve;
  } how = {static_cast<std::uint64_t>(kForReading), 0, 0x04};  // RESOLVE_NO_SYMLINKS
  const long opened = syscall(SYS_openat2, AT_FDCWD, file.c_str(), &how, sizeof how);
  if (opened >= 0) return Descriptor(static_cast<int>(opened));
  if (errno != ENOSYS && errno != EPERM) return {};
#endif
  return Descriptor(::open(file.c_str(), kForReading | O_NOFOLLOW));
}

bool is_inside(const fs::path& file, const fs::path& folder) {
  return std::mismatch(folder.begin(), folder.end(), file.begin(), file.end()).first ==
         folder.end();
}

}  // namespace

Result<OpenFile> open_regular_file(const fs::path& file) {
  return checked(Descriptor(::open(file.c_str(), kForReading)), file);
}

Result<OpenFile> open_checked_file(const fs::path& canonical) {
  return checked(open_canonical(canonical), canonical);
}

Result<OpenFile> open_file_or_pipe(const fs::path& file) {
  return checked(Descriptor(::open(file.c_str(), kForReading)), file, true);
}

AllowedFiles::AllowedFiles(const fs::path& folder, const std::vector<fs::path>& roots,
                           std::uint64_t maximum_bytes)
    : budget_(maximum_bytes) {
  std::error_code error;
  roots_.push_back(fs::canonical(folder.empty() ? "." : folder, error));
  for (const fs::path& root : roots)
    if (fs::path whole = fs::canonical(root, error); !error) roots_.push_back(std::move(whole));
}

bool AllowedFiles::allows(const fs::path& file) const {
  return std::any_of(roots_.begin(), roots_.end(),
                     [&](const fs::path& root) { return !root.empty() && is_inside(file, root); });
}

Result<fs::path> AllowedFiles::resolve(std::string_view reference) const {
  std::string text(reference.substr(0, reference.find('\0')));
  std::replace(text.begin(), text.end(), '\\', '/');
  bool is_outside = false;
  for (const fs::path& root : roots_) {
    if (root.empty()) continue;
    std::error_code error;
    // If `text` is absolute, the root is ignored.
    const fs::path file = fs::weakly_canonical(root / text, error);
    if (error) continue;
    if (!allows(file))
      is_outside = true;
    else if (fs::is_regular_file(file, error))
      return file;
  }
  if (is_outside)
    return Status::failure(StatusCode::path_not_allowed, kNone,
                           "'%.160s' is outside the model's own folder (LoadOptions::roots)",
                           text.c_str());
  return Status::failure(StatusCode::file_not_found, kNone, "no file '%.200s'", text.c_str());
}

Result<OpenFile> AllowedFiles::open(std::string_view reference) {
  const Result<fs::path> file = resolve(reference);
  if (!file) return file.error();
  Result<OpenFile> opened = open_checked_file(*file);
  if (!opened) return opened;
  if (const Status fits = charge(*file, opened->bytes); !fits) return fits;
  return opened;
}

Status AllowedFiles::charge(const fs::path& file, std::uint64_t bytes) {
  if (charged_.contains(file)) return {};
  if (bytes > budget_)
    return Status::failure(StatusCode::limit_exceeded, kNone,
                           "'%.100s' and the other files exceed LoadOptions::maximum_bytes",
                           file.filename().c_str());
  budget_ -= bytes;
  charged_.insert(file);
  return {};
}

}  // namespace sunder::files
