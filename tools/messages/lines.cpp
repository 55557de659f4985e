#include "tools/messages/lines.h"

#include <cstdio>

#include "tools/messages/progress_bar.h"
#include "tools/messages/visible.h"

namespace sunder::tools {
namespace {

const char* begin_of(Colour colour) {
  switch (colour) {
    case Colour::none: return "";
    case Colour::red: return "\x1b[31m";
    case Colour::yellow: return "\x1b[33m";
    case Colour::cyan: return "\x1b[36m";
  }
  return "";
}

void put(const std::string& text) {
  erase_progress_bar();
  std::fwrite(text.data(), 1, text.size(), stdout);
}

}  // namespace

void Lines::add(Colour colour, std::string_view head, std::string_view rest) {
  if (colour == Colour::none || head.empty()) {
    text_ += visible_line(std::string(head) + std::string(rest)) + '\n';
    return;
  }
  text_ += begin_of(colour) + visible_line(head) + "\x1b[0m" + visible(rest) + '\n';
}

void print(const Lines& lines) {
  put(lines.text());
  std::fflush(stdout);  // `sunder studio` goes on, and who reads its address waits
}

void print(const Json& json) { put(dump(json)); }

void print_json_line(const Json& json) {
  put(dump_line(json) + '\n');
  std::fflush(stdout);
}

void print_text(std::string_view text) {
  std::string shown;
  while (!text.empty()) {
    const std::size_t end = text.find('\n');
    shown += visible_line(text.substr(0, end));
    if (end != std::string_view::npos) shown += '\n';
    text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
  }
  put(shown);
}

}  // namespace sunder::tools
