#pragma once

#include <sunder/core/status.h>

#include <filesystem>

#include "io/files/descriptor.h"

namespace sunder::contained_import {

/// An executable that was opened before it was checked, so that the file that is executed is the
/// one that was checked.
struct HelperFile {
  std::filesystem::path path;
  files::Descriptor descriptor;  ///< O_PATH, above the descriptors that a new process gets.
};

/// Opens the helper executable `sunder-import`: `named` if it is not empty, else the first that
/// exists of
/// - the one beside the library, or beside the program,
/// - that in `libexec` of the installation whose library or program this is,
/// - that in the build tree, if the library or the program is there,
/// - that where the build would install it.
///
/// The current folder, PATH and the name by which the program was started have no influence, and a
/// file is refused if another user could have written it: it and its folder must belong to root or
/// to the effective user, and neither the group nor others may write to them. (The group may, if it
/// is the user's private one: its number is the user's, and not 0.)
/// @return file_not_found, with the places; file_unreadable if `named`, or every file that was
///         found, cannot be executed or is refused.
[[nodiscard]] Result<HelperFile> find_helper(const std::filesystem::path& named);

}  // namespace sunder::contained_import
