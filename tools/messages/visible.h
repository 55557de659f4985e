#pragma once

#include <string>
#include <string_view>

namespace sunder::tools {

/// A text from a file, as a part of one line that a terminal and a log show and do not obey:
/// "\x1b", "\n", "\u202e" for control characters, line breaks, characters that change the direction
/// of writing or cannot be seen, and "\xff" for bytes that are not UTF-8. In "##", by which some CI
/// services begin a command ("##[error]"), the second sign becomes "\x23". Everything else stays.
[[nodiscard]] std::string visible(std::string_view text);

/// visible(), and "\x3a:" where the line begins with "::", by which GitHub's commands begin, also
/// after white space of any kind.
[[nodiscard]] std::string visible_line(std::string_view line);

/// The same for a JSON text, by the escapes of JSON: its value is the same. Line breaks between
/// tokens stay. The text is valid UTF-8.
[[nodiscard]] std::string visible_json(std::string json);

}  // namespace sunder::tools
