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

/// The only place that an import reads from: regular files in the model's own folder and below,
/// within a budget of bytes. Links are followed before the check, so none leads out.
class AssetFolder {
 public:
  AssetFolder(const std::filesystem::path& folder, std::uint64_t maximum_bytes);

  /// The file behind a reference as model files write it: relative or absolute, with / or \.
  /// @return file_not_found, path_not_allowed, limit_exceeded (the budget would be passed).
  [[nodiscard]] Result<std::filesystem::path> resolve(std::string_view reference) const;
  /// Takes a file's size off the budget, once. @return limit_exceeded where it does not fit.
  [[nodiscard]] Status charge(const std::filesystem::path& file);
  /// A whole file; none where resolve() refuses it.
  [[nodiscard]] std::optional<std::vector<std::byte>> read(std::string_view reference);

 private:
  std::filesystem::path folder_;  ///< Canonical.
  std::uint64_t budget_;
  std::set<std::filesystem::path> charged_;
};

}  // namespace sunder::assimp_import
