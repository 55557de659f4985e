#pragma once

#include <string>
#include <string_view>

#include "tools/messages/json.h"

namespace sunder::tools {

enum class Colour { none, red, yellow, cyan };

/// Lines of text for people, in which names of files and models may stand. visible_line() is
/// applied to each, so that a name can neither end a line nor begin a command.
class Lines {
 public:
  /// @param line  without an end of line.
  void add(std::string_view line) { add(Colour::none, {}, line); }
  /// The same, where the head has a colour.
  void add(Colour colour, std::string_view head, std::string_view rest);
  void add(const Lines& lines) { text_ += lines.text_; }

  [[nodiscard]] const std::string& text() const { return text_; }

 private:
  std::string text_;
};

/// Prints on stdout.
void print(const Lines& lines);
/// An indented JSON text.
void print(const Json& json);
/// A JSON text in one line, at once also into a pipe.
void print_json_line(const Json& json);
/// A text that the program itself contains or that dump() made: help, the manual, a report. Its
/// lines are treated like those of Lines.
void print_text(std::string_view text);

}  // namespace sunder::tools
