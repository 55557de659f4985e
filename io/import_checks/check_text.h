#pragma once

#include <sunder/core/status.h>

#include <string>
#include <string_view>

#include "io/import_checks/formats.h"

namespace sunder::assimp_import {

/// Whether check_text() examines files of this format that begin like this.
[[nodiscard]] bool has_text_check(const Format& format, std::string_view first_kilobyte);

/// Refuses texts that assimp 5.2 would read for minutes, or without end, or with a stack that
/// overflows: a header or section without end, counts larger than the file, deep nesting, very many
/// objects. Linear in the size. Other faults are left to assimp.
/// @return malformed_file, limit_exceeded.
[[nodiscard]] Status check_text(const Format& format, std::string_view content,
                                const std::string& file_name);

}  // namespace sunder::assimp_import
