#pragma once

#include <cstddef>
#include <string_view>

#include "io/operation_log/place.h"

namespace sunder::operation_log {

constexpr std::size_t kMaximumBytes = std::size_t{64} << 20;

/// Parses the text; throws a Fault if it is too long, nested too deeply, not JSON, or repeats a
/// field.
Json parse_json(std::string_view text);

}  // namespace sunder::operation_log
