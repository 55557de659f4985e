#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "io/gltf/side_files.h"

namespace sunder::gltf {

/// The files of a model's folder, and of other folders that the caller allows.
class FolderFiles : public SideFiles {
 public:
  FolderFiles(const std::filesystem::path& folder, const std::vector<std::filesystem::path>& roots);

  /// The bytes of the regular file that the URI names. The file that was checked is the one that is
  /// read: a part of its path that has become a link since is refused.
  [[nodiscard]] std::vector<std::byte> read(const std::string& uri, const std::string& place,
                                            std::uint64_t maximum_bytes) const override;
  [[nodiscard]] bool exists(const std::string& uri, const std::string& place) const override;

 private:
  /// The file that a relative URI names: in the folder, else in the first of the roots that has it.
  /// Refuses (path_not_allowed) absolute paths, other schemes, and files that, after links are
  /// resolved, are neither in the folder nor in one of the roots or below.
  [[nodiscard]] std::filesystem::path resolve(const std::string& uri,
                                              const std::string& place) const;

  std::filesystem::path folder_;              ///< Absolute, like the others.
  std::vector<std::filesystem::path> roots_;  ///< LoadOptions::roots.
};

/// The bytes of a regular file that the caller names. Refuses a file that is missing, unreadable or
/// larger than `maximum_bytes`.
[[nodiscard]] std::vector<std::byte> read_file(const std::filesystem::path& file,
                                               std::uint64_t maximum_bytes,
                                               const std::string& place);

}  // namespace sunder::gltf
