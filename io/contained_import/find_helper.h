#pragma once

#include <sunder/core/status.h>

#include <filesystem>

#include "io/internal/own_program.h"

namespace sunder::contained_import {

/// Opens the helper executable `sunder-import`: `named` if it is not empty, else the first that
/// exists of
/// - the one beside the library, or beside the program,
/// - that in `libexec` of the installation whose library or program this is,
/// - that in the build tree, if the library or the program is there,
/// - that where the build would install it.
///
/// The current folder, PATH and the name by which the program was started have no influence, and
/// open_own_program() refuses what another user could have written.
/// @return file_not_found, with the places; file_unreadable if `named`, or every file that was
///         found, cannot be executed or is refused.
[[nodiscard]] Result<OwnProgram> find_helper(const std::filesystem::path& named);

}  // namespace sunder::contained_import
