#pragma once

#include <optional>
#include <string>

#include "tools/tear/report.h"
#include "tools/tear/torn_place.h"

namespace sunder::tools {

/// "tear at (0, 1.2, 0.1) on 'Spine': 24 faces crossed, 0.251 m long, 1.3 ms"; one line.
/// @param place  empty if the operation created no faces.
[[nodiscard]] std::string operation_line(const OperationOutcome& outcome,
                                         const std::optional<TornPlace>& place);

/// The details that -v adds: runs, segments, vertices, weights.
[[nodiscard]] std::string operation_details(const OperationOutcome& outcome);

}  // namespace sunder::tools
