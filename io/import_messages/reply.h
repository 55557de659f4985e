#pragma once

#include <sunder/io/character_file.h>

#include <cstdint>
#include <string>
#include <string_view>

namespace sunder::import_messages {

/// More bytes of a head than any import's report has.
inline constexpr std::uint64_t kMostHeadBytes = std::uint64_t{4} << 20;

/// The reply's head as text: the outcome of an import and its report. The GLB follows it.
[[nodiscard]] std::string encode_head(const Status& status, const LoadReport& report);

/// Reads a head. A model may have taken over the process that sent it, so it is checked like any
/// file: types, ranges, sizes; control characters in texts become spaces. Pure.
///
/// @param name  of the model, for error texts.
/// @return the import's failure; malformed_file if the head is not what encode_head() writes.
[[nodiscard]] Result<LoadReport> decode_head(std::string_view head, const std::string& name);

}  // namespace sunder::import_messages
