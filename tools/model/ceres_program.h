#pragma once

#include <sunder/core/status.h>

namespace sunder::tools {

/// Replaces this process by `sunder-coupled-refit`, the same command with Ceres, which begins anew
/// with the same arguments. Inputs must not have been changed before, nor pipes been read.
/// @param work  for the text of a failure: "neighbours are fitted together".
/// @return only if it fails: unsupported_feature without that program; file_unreadable.
[[nodiscard]] Status become_ceres_program(const char* work);

}  // namespace sunder::tools
