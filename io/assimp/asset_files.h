#pragma once

#include <sunder/core/status.h>

#include <cstddef>
#include <optional>
#include <string_view>
#include <vector>

#include "io/files/allowed_files.h"

namespace sunder::assimp_import {

/// The files besides the model itself that an import may read. In the helper process they are
/// requested from the caller, who opens them.
class AssetFiles {
 public:
  virtual ~AssetFiles() = default;

  /// Whether a reference of the model leads to a file that may be read.
  /// @return file_not_found, path_not_allowed.
  [[nodiscard]] virtual Status look_up(std::string_view reference) = 0;
  /// @return also limit_exceeded, file_unreadable.
  [[nodiscard]] virtual Result<files::OpenFile> open(std::string_view reference) = 0;

  /// The content of a file; empty if open() refuses it.
  [[nodiscard]] std::optional<std::vector<std::byte>> read(std::string_view reference);
};

}  // namespace sunder::assimp_import
