#pragma once

#include <sunder/core/status.h>

#include <optional>
#include <string>

#include "tools/verbs.h"

namespace sunder::tools {

/// Reads an option of `sunder tear`: "LeftForeArm@0.4,from=back,length=0.8w,turn=30". The fields
/// are those of docs/operation_log.md; "0.8w" is a length in widths, "0/0/1" a direction, and a
/// field without a value is true. Of a sever, `detach` and `parts` are fields too.
/// @param kind  "slash", "sever" or "puncture".
/// @param pose  "rest", "bind" or "Walk@0.5"; empty: rest.
/// @return malformed_file: what is wrong.
[[nodiscard]] Result<TearRequest::Aimed> parse_aimed_option(const std::string& kind,
                                                            const std::string& text,
                                                            const std::optional<std::string>& pose);

/// Reads a weld or suture: "all", or "0.1/1.2/0" for the wound nearest to a place; then numbers of
/// the operation's fields: "reach=0.05,spacing=0.01".
/// @param kind  "weld" or "suture". @return as above.
[[nodiscard]] Result<Operation> parse_closing_option(const std::string& kind,
                                                     const std::string& text,
                                                     const std::optional<std::string>& pose);

}  // namespace sunder::tools
