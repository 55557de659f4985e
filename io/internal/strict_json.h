#pragma once

#include <sunder/core/status.h>

#include <cstddef>
#include <string_view>

#include <nlohmann/json.hpp>

namespace sunder {

using StrictJson = nlohmann::ordered_json;  ///< Keeps the order of the fields in the text.

/// The most bytes of a JSON text that is read.
constexpr std::size_t kMaximumJsonBytes = std::size_t{64} << 20;

/// Parses a JSON text of a stranger. O(n log n) at most, in time, for any text; memory up to about
/// 1 GiB.
/// @return limit_exceeded for a text above kMaximumJsonBytes, for values nested deeper than 32, and
///         if the values take more than 768 MiB; malformed_file, with line and byte, for what is
///         not JSON, for numbers that no double holds, and for an object that names a field twice.
///         Out of memory: throws std::bad_alloc.
[[nodiscard]] SUNDER_API Result<StrictJson> parse_strict_json(std::string_view text);

}  // namespace sunder
