#pragma once

#include <sunder/operation/operation.h>

#include "tear/operation/outcome.h"
#include "tear/posed/workpiece.h"

namespace sunder::tear {

[[nodiscard]] Status validate_suture(const Suture& suture);

/// Ties threads between points of lips that lie on one another.
void tie_threads(const Suture& suture, const Workpiece& work, Outcome& outcome);

}  // namespace sunder::tear
