#pragma once

#include <sunder/core/api.h>
#include <sunder/core/status.h>

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace sunder {

/// An output file: all bytes are written to a new file in the same folder, which takes the name
/// when it is committed. Without a commit nothing remains. All files that the library and the
/// command write are written by it.
///
/// - The new file has a random name and is created by O_EXCL, so it never follows a link.
/// - An earlier file is replaced. Its mode is kept, and its owner and group where the system allows
///   it; other hard links keep the earlier content.
/// - A symbolic link is replaced itself; the file to which it leads is left as it is.
/// - A character device is written to directly, and so is a FIFO that somebody reads, and a
///   descriptor of this process (/dev/stdout, /dev/fd/3). That happens at the commit, and a failure
///   may leave a part there.
/// - Anything else (a block device, a socket, a folder, another link in /dev or /proc) is refused.
class StagedFile {
 public:
  /// Creates the new file, if there is one, and writes all bytes.
  SUNDER_API StagedFile(const std::filesystem::path& file, std::span<const std::byte> bytes);
  SUNDER_API ~StagedFile();
  StagedFile(const StagedFile&) = delete;
  StagedFile& operator=(const StagedFile&) = delete;

  /// @return file_unreadable if the file cannot be created or written, or is refused.
  [[nodiscard]] const Status& status() const { return status_; }
  /// Once.
  /// @return the same; nothing has changed then, except for what a device has got.
  [[nodiscard]] SUNDER_API Status commit();

 private:
  void create(std::span<const std::byte> bytes);
  [[nodiscard]] Status failure(const char* why) const;

  std::filesystem::path file_;
  int folder_ = -1;                ///< Descriptor.
  std::string staged_;             ///< Name of the new file in the folder; empty without one.
  std::vector<std::byte> direct_;  ///< For a device.
  Status status_;
};

/// Writes all bytes, or nothing: a StagedFile that is committed at once.
/// @return file_unreadable.
[[nodiscard]] SUNDER_API Status write_file(const std::filesystem::path& file,
                                           std::span<const std::byte> bytes);

}  // namespace sunder
