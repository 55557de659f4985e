#pragma once

#include <sunder/core/status.h>
#include <sunder/operation/aimed_operation.h>

#include <optional>
#include <string>

namespace sunder::tools {

/// Reads an option of `sunder tear`: "LeftForeArm@0.4,from=back,length=0.8w,turn=30". The fields
/// are those of docs/operation_log.md; "0.8w" is a length in widths, "0/0/1" a direction, and a
/// field without a value is true.
/// @param kind  "slash", "sever" or "puncture".
/// @param pose  "rest", "bind" or "Walk@0.5"; empty: rest.
/// @return malformed_file: what is wrong.
[[nodiscard]] Result<AimedOperation> parse_aimed_option(const std::string& kind,
                                                        const std::string& text,
                                                        const std::optional<std::string>& pose);

}  // namespace sunder::tools
