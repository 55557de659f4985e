#pragma once

#include <sunder/core/status.h>

#include <filesystem>

#include "io/internal/descriptor.h"

namespace sunder {

/// An executable that was opened before it was checked, so that the file that is executed is the
/// one that was checked.
struct OwnProgram {
  std::filesystem::path path;
  files::Descriptor descriptor;  ///< O_PATH, above the descriptors that a new process gets.
};

/// Opens a program of this installation. It is refused if another user could have written it: it
/// and its folder must belong to root or to the effective user, and neither the group nor others
/// may write to them. (The group may, if it is the user's private one: its number is the user's,
/// and not 0.) Links are resolved first: what counts is what is executed.
/// @param file  absolute.
/// @return file_not_found if nothing is there; file_unreadable if it cannot be executed or is
///         refused; limit_exceeded without a free descriptor.
[[nodiscard]] SUNDER_API Result<OwnProgram> open_own_program(const std::filesystem::path& file);

}  // namespace sunder
