#pragma once

#include <sunder/core/status.h>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <set>
#include <string_view>
#include <vector>

namespace sunder::assimp_import {

/// The only files that an import can read: regular files in the model's folder and below, within a
/// limit of bytes. Links are resolved before the check, so none leads outside.
class AssetFolder {
 public:
  AssetFolder(const std::filesystem::path& folder, std::uint64_t maximum_bytes);

  /// The file behind a reference of a model file, relative or absolute, with / or \.
  /// @return file_not_found, path_not_allowed, limit_exceeded (the byte limit would be exceeded).
  [[nodiscard]] Result<std::filesystem::path> resolve(std::string_view reference) const;
  /// Subtracts a file's size from the limit, once per file. @return limit_exceeded if it does not
  /// fit.
  [[nodiscard]] Status charge(const std::filesystem::path& file);
  /// The content of a file; empty if resolve() refuses it.
  [[nodiscard]] std::optional<std::vector<std::byte>> read(std::string_view reference);

  /// Canonical.
 private:
  std::filesystem::path folder_;
  std::uint64_t budget_;
  std::set<std::filesystem::path> charged_;
};

}  // namespace sunder::assimp_import
