#pragma once

#include <sunder/core/status.h>

#include <filesystem>

#include "tools/messages/json.h"

namespace sunder::tools {

/// Reads a file, or a pipe, that holds one JSON object.
/// @return as read_input() and parse_strict_json(); malformed_file for other content.
[[nodiscard]] Result<Json> read_json_object(const std::filesystem::path& file);

}  // namespace sunder::tools
