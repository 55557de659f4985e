#pragma once

#include <sunder/io/character_file.h>

#include <string>

#include "tools/messages/messages.h"

namespace sunder::tools {

/// Whether loading repaired or dropped something.
[[nodiscard]] bool is_change(const LoadNote& note);

/// Warns of everything that loading repaired or dropped, one line per kind; beyond 20 lines, of
/// their number; and as warn_of_protection().
/// @param model  its path, which begins each line.
void warn_of_repairs(const std::string& model, const LoadReport& report, const Messages& messages);

/// Warns of an import without a filter of system calls.
void warn_of_protection(const std::string& model, const LoadReport& report,
                        const Messages& messages);

/// Whether loading dropped something, so that the character lacks a part of its file.
[[nodiscard]] bool has_losses(const LoadReport& report);

}  // namespace sunder::tools
