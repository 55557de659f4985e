#pragma once

#include <string>

namespace sunder::tools {

/// How much a verb says on stderr, apart from errors.
enum class Verbosity {
  quiet,    ///< Nothing.
  normal,   ///< One line per operation, and warnings.
  verbose,  ///< Also details and durations.
};

/// Whether stdout (1) or stderr (2) shows colours: a terminal, and NO_COLOR is not set
/// (https://no-color.org).
[[nodiscard]] bool is_in_colour(int descriptor);

/// Prints an error on stderr, in red where there are colours: one line, by visible_line().
void print_error(const std::string& text);

/// Prints lines on stderr, by visible_line(). Each begins with "sunder: ".
class Messages {
 public:
  explicit Messages(Verbosity verbosity) : verbosity_(verbosity) {}

  void say(const std::string& line) const;     ///< Unless quiet.
  void warn(const std::string& line) const;    ///< Unless quiet; yellow where there are colours.
  void detail(const std::string& line) const;  ///< Only if verbose.
  [[nodiscard]] bool is_quiet() const { return verbosity_ == Verbosity::quiet; }
  [[nodiscard]] bool is_verbose() const { return verbosity_ == Verbosity::verbose; }

 private:
  Verbosity verbosity_;
};

}  // namespace sunder::tools
