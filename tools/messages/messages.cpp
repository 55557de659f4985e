#include "tools/messages/messages.h"

#include <cstdio>
#include <cstdlib>
#include <unistd.h>

#include "tools/messages/progress_bar.h"
#include "tools/messages/visible.h"

namespace sunder::tools {
namespace {

constexpr const char kRed[] = "\x1b[31m";
constexpr const char kYellow[] = "\x1b[33m";

void print(const std::string& text, const char* colour) {
  erase_progress_bar();
  if (colour != nullptr && is_in_colour(STDERR_FILENO))
    std::fprintf(stderr, "%s%s\x1b[0m\n", colour, visible_line(text).c_str());
  else
    std::fprintf(stderr, "%s\n", visible_line(text).c_str());
}

}  // namespace

bool is_in_colour(int descriptor) {
  const char* const no_color = std::getenv("NO_COLOR");
  return (no_color == nullptr || *no_color == '\0') && isatty(descriptor) == 1;
}

void print_error(const std::string& text) { print(text, kRed); }

void Messages::say(const std::string& line) const {
  if (!is_quiet()) print("sunder: " + line, nullptr);
}

void Messages::warn(const std::string& line) const {
  if (!is_quiet()) print("sunder: warning: " + line, kYellow);
}

void Messages::detail(const std::string& line) const {
  if (is_verbose()) print("sunder: " + line, nullptr);
}

}  // namespace sunder::tools
