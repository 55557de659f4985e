#pragma once

#include <sunder/core/status.h>

#include <cstdint>
#include <filesystem>
#include <set>
#include <string_view>
#include <vector>

#include "io/internal/descriptor.h"

namespace sunder::files {

struct OpenFile {
  Descriptor descriptor;  ///< For reading, without waiting; above 2, closed by exec.
  std::uint64_t bytes = 0;
  bool is_pipe = false;
};

/// Opens a regular file for reading. Symbolic links in `file` are followed.
/// @return file_not_found, file_unreadable (also if it is no regular file).
[[nodiscard]] Result<OpenFile> open_regular_file(const std::filesystem::path& file);
/// The same, and pipes; does not wait for their writers.
[[nodiscard]] Result<OpenFile> open_file_or_pipe(const std::filesystem::path& file);

/// The same for a canonical path, which was checked: fails if a part of it has become a link since.
[[nodiscard]] Result<OpenFile> open_checked_file(const std::filesystem::path& canonical);

/// The only files that a model can read: regular files below the roots, within a limit of bytes.
/// Links are resolved before the check, so none leads outside.
class AllowedFiles {
 public:
  /// @param folder  of the model: the first root.
  /// @param roots   further ones; a root that does not exist allows nothing.
  AllowedFiles(const std::filesystem::path& folder, const std::vector<std::filesystem::path>& roots,
               std::uint64_t maximum_bytes);

  /// The canonical path of a file that a model refers to, with / or \. A relative reference is
  /// searched for in the model's folder, then in the other roots.
  /// @return file_not_found, path_not_allowed.
  [[nodiscard]] Result<std::filesystem::path> resolve(std::string_view reference) const;
  /// Opens it, and subtracts its size from the limit, once per file.
  /// @return also limit_exceeded, file_unreadable.
  [[nodiscard]] Result<OpenFile> open(std::string_view reference);
  /// Subtracts the size of a file that was opened elsewhere.
  /// @return limit_exceeded if it does not fit.
  [[nodiscard]] Status charge(const std::filesystem::path& file, std::uint64_t bytes);
  /// The bytes that the limit still allows.
  [[nodiscard]] std::uint64_t bytes_left() const { return budget_; }

 private:
  [[nodiscard]] bool allows(const std::filesystem::path& file) const;

  std::vector<std::filesystem::path> roots_;  ///< Canonical; the first is the model's folder.
  std::uint64_t budget_;
  std::set<std::filesystem::path> charged_;
};

}  // namespace sunder::files
