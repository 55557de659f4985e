#pragma once

#include <sunder/core/status.h>
#include <sunder/operation/aimed_operation.h>

#include <span>

namespace sunder::tools {

/// Lets the operations of a log fit neighbours together, if one of them asks for it. This program
/// does not link Ceres, whose Debian package links parts of SuiteSparse that are under the GPL: it
/// is replaced by `sunder-coupled-refit`, the same command with Ceres, which begins anew with the
/// same arguments. Call it before anything is printed or written.
///
/// @return ok if no operation asks, or this program has Ceres; does not return if the other one
///         starts; unsupported_feature if that is not installed, file_unreadable.
[[nodiscard]] Status provide_coupled_refits(std::span<const LoggedOperation> log);

}  // namespace sunder::tools
