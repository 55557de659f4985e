#pragma once

#include <sunder/core/status.h>

#include <filesystem>

namespace sunder::contained_import {

/// The helper executable `sunder-import`: `named` if it is not empty, else the first that exists of
/// those beside the library, beside the program, in ../libexec and ../bin of both, in the build
/// tree if the library or the program is there, and where the build would install it.
/// @return file_not_found, with the places; file_unreadable if `named` cannot be executed.
[[nodiscard]] Result<std::filesystem::path> find_helper(const std::filesystem::path& named);

}  // namespace sunder::contained_import
